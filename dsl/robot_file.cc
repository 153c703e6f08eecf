#include "dsl/robot_file.h"

#include <algorithm>
#include <map>
#include <set>

#include "dsl/nearest_name.h"
#include "dsl/typed_attributes.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ValueType;

const AttributeRow three_reals{.name = "", .type = ValueType::reals, .count = 3};
const AttributeRow one_real{.name = "", .type = ValueType::real};
const AttributeRow not_negative{.name = "", .type = ValueType::real, .lower = 0};

/// What only Tactus's own pass over a robot file has to know.
class RobotChecker {
 public:
  RobotChecker(RobotFile& file, Findings& findings) : file_(file), findings_(findings) {}

  void run() {
    checkParts(*file_.root, findings_);
    for (const auto& child : file_.root->children) {
      if (child->name == "link" && hasNewName(*child, links_)) file_.links.push_back(child.get());
      if (child->name == "joint" && hasNewName(*child, joints_)) file_.joints.push_back(child.get());
    }
    for (const XmlElement* link : file_.links) checkLink(*link);
    for (const XmlElement* joint : file_.joints) checkJoint(*joint);
    checkMimics(file_, findings_);
    if (!findings_.hasErrors()) checkTree();
  }

 private:
  bool hasNewName(const XmlElement& element, std::map<std::string, const XmlElement*>& known) {
    const XmlAttribute* name = requireAttribute(element, "name", findings_);
    if (!name) return false;
    if (name->value.empty()) {
      findings_.errorAtValue(code::bad_value, element, *name, "the name of a " + element.name + " must not be empty");
      return false;
    }
    if (known.emplace(name->value, &element).second) return true;
    findings_.errorAtValue(code::duplicate_name, element, *name,
                           "the robot has a " + element.name + " '" + name->value + "' already");
    return false;
  }

  void checkOrigin(const XmlElement& element) {
    if (const XmlElement* origin = element.child("origin"))
      for (const char* name : {"xyz", "rpy"}) readNumbers(*origin, name, three_reals, findings_);
  }

  void checkLink(const XmlElement& link) {
    const XmlElement* inertial = link.child("inertial");
    if (!inertial) return;
    checkOrigin(*inertial);
    if (const XmlElement* mass = requireChild(*inertial, "mass", findings_))
      readRequiredNumbers(*mass, "value", one_real, findings_);
    if (const XmlElement* inertia = requireChild(*inertial, "inertia", findings_))
      for (const char* name : {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"})
        readRequiredNumbers(*inertia, name, one_real, findings_);
  }

  void checkJoint(const XmlElement& joint) {
    checkOrigin(joint);
    checkEnd(joint, "parent");
    checkEnd(joint, "child");
    const XmlAttribute* type = requireAttribute(joint, "type", findings_);
    if (!type) return;
    static const std::vector<std::string> supported{"revolute", "continuous", "prismatic", "fixed",
                                                    "planar",   "spherical",  "floating"};
    if (std::find(supported.begin(), supported.end(), type->value) == supported.end())
      return findings_.errorAtValue(code::unsupported_joint, joint, *type,
                                    "joints of type '" + type->value +
                                        "' are not supported: expected revolute, continuous, prismatic, fixed, "
                                        "planar, spherical or floating",
                                    nearestName(type->value, supported));
    for (const auto& part : joint.children)
      if (isMeaningless(type->value, part->name))
        findings_.warning(code::meaningless_part, *part,
                          "joint '" + nameOf(joint) + "' is " + type->value + ": its <" + part->name +
                              "> is passed over");
    if (type->value == "planar" && joint.child("axis")) checkAxis(*joint.child("axis"));
    if (type->value == "fixed" || hasSeveralFreedoms(type->value)) return;
    if (const XmlElement* axis = joint.child("axis")) checkAxis(*axis);
    if (const XmlElement* dynamics = joint.child("dynamics"))
      for (const char* name : {"damping", "friction"}) readNumbers(*dynamics, name, not_negative, findings_);
    const XmlElement* limit = type->value == "continuous" ? joint.child("limit")
                                                          : requireChild(joint, "limit", findings_);
    if (limit) checkLimit(*limit, type->value != "continuous");
  }

  void checkAxis(const XmlElement& axis) {
    const auto numbers = readRequiredNumbers(axis, "xyz", three_reals, findings_);
    if (!numbers.empty() && numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0)
      findings_.errorAtValue(code::bad_value, axis, *axis.attribute("xyz"), "an axis must not be zero");
  }

  /// A limit that a bounded joint does not give is 0.
  void checkLimit(const XmlElement& limit, bool bounded) {
    for (const char* name : {"effort", "velocity"}) readRequiredNumbers(limit, name, not_negative, findings_);
    const auto lower = readNumbers(limit, "lower", one_real, findings_);
    const auto upper = readNumbers(limit, "upper", one_real, findings_);
    const XmlAttribute *lower_given = limit.attribute("lower"), *upper_given = limit.attribute("upper");
    const bool lower_wrong = lower_given && lower.empty(), upper_wrong = upper_given && upper.empty();
    if (lower_wrong || upper_wrong || (!bounded && (!lower_given || !upper_given))) return;
    const double from = lower.empty() ? 0 : lower[0], to = upper.empty() ? 0 : upper[0];
    if (from <= to) return;
    const auto said = [](const XmlAttribute* given, double value) {
      return given ? " " + control::formatNumber(value) : ", which is not given and therefore 0";
    };
    findings_.errorAtValue(code::reversed_limits, limit, lower_given ? *lower_given : *upper_given,
                           lower_given ? "the lower limit" + said(lower_given, from) + " lies above the upper limit" +
                                             said(upper_given, to)
                                       : "the upper limit" + said(upper_given, to) + " lies below the lower limit" +
                                             said(lower_given, from));
  }

  void checkEnd(const XmlElement& joint, const char* which) {
    const XmlElement* end = requireChild(joint, which, findings_);
    const XmlAttribute* link = end ? requireAttribute(*end, "link", findings_) : nullptr;
    if (!link || links_.count(link->value)) return;
    std::vector<std::string> names;
    for (const auto& [name, element] : links_) names.push_back(name);
    findings_.errorAtValue(code::unknown_link, *end, *link, "the robot has no link '" + link->value + "'",
                           nearestName(link->value, names));
  }

  /// One root, and a way from it to every link.
  void checkTree() {
    std::map<std::string, const XmlElement*> mover;
    std::map<std::string, std::vector<std::string>> children;
    if (file_.links.empty()) return findings_.error(code::no_root_link, *file_.root, "the robot has no link");
    for (const XmlElement* joint : file_.joints) {
      const XmlElement& end = *joint->child("child");
      const XmlAttribute& child = *end.attribute("link");
      const std::string& parent = joint->child("parent")->attribute("link")->value;
      const auto [first, fresh] = mover.emplace(child.value, joint);
      children[parent].push_back(child.value);
      if (parent == child.value)
        findings_.errorAtValue(code::kinematic_loop, end, child,
                               "joint '" + nameOf(*joint) + "' joins link '" + parent + "' to itself");
      else if (!fresh)
        findings_.errorAtValue(code::kinematic_loop, end, child,
                               "link '" + child.value + "' is the child of joint '" + nameOf(*first->second) +
                                   "' already");
    }
    std::vector<const XmlElement*> roots;
    for (const XmlElement* link : file_.links)
      if (!mover.count(nameOf(*link))) roots.push_back(link);
    if (roots.empty())
      return findings_.error(code::no_root_link, *file_.root, "no link is the root: every one is the child of a joint");
    for (std::size_t i = 1; i < roots.size(); ++i)
      findings_.error(
          code::several_root_links, *roots[i],
          "link '" + nameOf(*roots[i]) + "' has no parent, but '" + nameOf(*roots[0]) + "' is the root already");
    if (findings_.hasErrors()) return;

    std::set<std::string> reached;
    std::vector<std::string> front{nameOf(*roots[0])};
    while (!front.empty()) {
      const std::string link = front.back();
      front.pop_back();
      reached.insert(link);
      for (const std::string& child : children[link]) front.push_back(child);
    }
    for (const XmlElement* link : file_.links)
      if (!reached.count(nameOf(*link)))
        return findings_.error(code::kinematic_loop, *link,
                               "link '" + nameOf(*link) + "' hangs in a closed loop of joints: " +
                                   loopAbove(nameOf(*link), mover));
  }

  /// The joints of the loop that the way up from a link runs into: "'a', 'b', 'c'".
  static std::string loopAbove(std::string link, const std::map<std::string, const XmlElement*>& mover) {
    const auto above = [&](const std::string& name) {
      return mover.at(name)->child("parent")->attribute("link")->value;
    };
    std::set<std::string> passed;
    while (passed.insert(link).second) link = above(link);
    std::string joints;
    for (const std::string first = link; joints.empty() || link != first; link = above(link))
      joints = "'" + nameOf(*mover.at(link)) + "'" + (joints.empty() ? "" : ", ") + joints;
    return joints;
  }

  static std::string nameOf(const XmlElement& element) { return element.attribute("name")->value; }

  RobotFile& file_;
  Findings& findings_;
  std::map<std::string, const XmlElement*> links_;
  std::map<std::string, const XmlElement*> joints_;
};

}  // namespace

bool hasSeveralFreedoms(std::string_view joint_type) {
  return joint_type == "planar" || joint_type == "spherical" || joint_type == "floating";
}

bool isMeaningless(std::string_view joint_type, std::string_view part) {
  if (!hasSeveralFreedoms(joint_type)) return false;
  if (part == "axis") return joint_type != "planar";
  return part == "limit" || part == "dynamics" || part == "safety_controller" || part == "calibration";
}

RobotFile checkRobotFile(const std::string& name, Findings& findings) {
  RobotFile file;
  const auto text = readFile(name);
  auto source = std::make_shared<XmlSource>();
  source->text = SourceText(name, text.value_or(""));
  if (!text) {
    findings.error(code::unreadable_file, *source, 0, 1, "the robot file '" + name + "' cannot be read");
    return file;
  }
  file.root = parseXml(source, findings);
  if (!file.root) return file;
  if (file.root->name != "robot") {
    findings.error(code::wrong_root, *file.root, "a robot file has <robot> outermost, not <" + file.root->name + ">");
    return file;
  }
  requireAttribute(*file.root, "name", findings);
  RobotChecker(file, findings).run();
  return file;
}

}  // namespace tactus::dsl
