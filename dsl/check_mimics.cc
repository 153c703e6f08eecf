#include <map>

#include "dsl/nearest_name.h"
#include "dsl/robot_file.h"
#include "dsl/typed_attributes.h"

namespace tactus::dsl {
namespace {

const control::AttributeRow one_real{.name = "", .type = control::ValueType::real};

/// Looks joints up by name, since one may follow another that stands below it in the file.
class MimicChecker {
 public:
  MimicChecker(const RobotFile& file, Findings& findings) : findings_(findings) {
    for (const XmlElement* joint : file.joints) joints_.emplace(joint->attribute("name")->value, joint);
  }

  void check(const std::string& name, const XmlElement& joint) {
    const XmlElement* mimic = joint.child("mimic");
    if (!mimic) return;
    refuseOtherAttributes(*mimic, {"joint", "multiplier", "offset"}, findings_);
    for (const char* number : {"multiplier", "offset"}) readNumbers(*mimic, number, one_real, findings_);
    const std::string freedoms = freedomsOf(joint);
    if (!freedoms.empty())
      findings_.error(code::bad_mimic, *mimic,
                      "joint '" + name + "' " + freedoms + ": only one that is revolute, continuous or prismatic "
                      "follows another");
    const XmlAttribute* driver = requireAttribute(*mimic, "joint", findings_);
    if (driver) checkDriver(name, *mimic, *driver);
  }

 private:
  void checkDriver(const std::string& name, const XmlElement& mimic, const XmlAttribute& driver) {
    const auto found = joints_.find(driver.value);
    if (found == joints_.end()) {
      std::vector<std::string> names;
      for (const auto& [known, element] : joints_)
        if (known != name) names.push_back(known);
      return findings_.errorAtValue(code::unknown_joint, mimic, driver,
                                    "the robot has no joint '" + driver.value + "'", nearestName(driver.value, names));
    }
    const std::string freedoms = freedomsOf(*found->second);
    if (!freedoms.empty())
      return findings_.errorAtValue(code::bad_mimic, mimic, driver,
                                    "joint '" + driver.value + "' " + freedoms + ": only one that is revolute, "
                                    "continuous or prismatic can be followed");
    if (reaches(driver.value, name))
      findings_.errorAtValue(code::bad_mimic, mimic, driver,
                             "joint '" + name + "' follows itself, directly or through others: one of them must move "
                             "freely");
  }

  /// What keeps a joint from having one degree of freedom; "" when it has one.  A wrong type is told elsewhere.
  static std::string freedomsOf(const XmlElement& joint) {
    const XmlAttribute* type = joint.attribute("type");
    if (!type) return "";
    if (type->value == "fixed") return "is fixed";
    return hasSeveralFreedoms(type->value) ? "is " + type->value : "";
  }

  /// Does the chain of mimics from `joint` come to `wanted`?
  bool reaches(std::string joint, const std::string& wanted) const {
    for (std::size_t steps = 0; steps <= joints_.size(); ++steps) {
      if (joint == wanted) return true;
      const auto found = joints_.find(joint);
      const XmlElement* mimic = found == joints_.end() ? nullptr : found->second->child("mimic");
      const XmlAttribute* driver = mimic ? mimic->attribute("joint") : nullptr;
      if (!driver) return false;
      joint = driver->value;
    }
    return false;                                                  // a circle further on: told at its own joints
  }

  std::map<std::string, const XmlElement*> joints_;
  Findings& findings_;
};

}  // namespace

void checkMimics(const RobotFile& file, Findings& findings) {
  MimicChecker checker(file, findings);
  for (const XmlElement* joint : file.joints) checker.check(joint->attribute("name")->value, *joint);
}

}  // namespace tactus::dsl
