#include <algorithm>

#include "dsl/nearest_name.h"
#include "dsl/robot_file.h"
#include "dsl/typed_attributes.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ValueType;
using description::Robot;

const AttributeRow three_reals{.name = "", .type = ValueType::reals, .count = 3};
const AttributeRow three_lengths{.name = "", .type = ValueType::reals, .lower = 0, .lower_open = true, .count = 3};
const AttributeRow one_real{.name = "", .type = ValueType::real};
const AttributeRow positive{.name = "", .type = ValueType::real, .lower = 0, .lower_open = true};
const AttributeRow not_negative{.name = "", .type = ValueType::real, .lower = 0};

Eigen::Vector3d vectorOr(const std::vector<double>& numbers, const Eigen::Vector3d& otherwise) {
  return numbers.size() == 3 ? Eigen::Vector3d(numbers[0], numbers[1], numbers[2]) : otherwise;
}

class ExtrasReader {
 public:
  ExtrasReader(const RobotFile& file, Robot& robot, Findings& findings)
      : file_(file), robot_(robot), findings_(findings) {}

  void run() {
    for (std::size_t i = 0; i < file_.links.size(); ++i)
      for (const auto& child : file_.links[i]->children)
        if (child->name == "collision") addShape(*child, robot_.links[i]);
    for (std::size_t i = 0; i < file_.joints.size(); ++i)
      if (const XmlElement* rotor = file_.joints[i]->child("rotor")) addRotor(*rotor, robot_.joints[i]);
    for (const auto& child : file_.root->children)
      if (child->name == "tactus") readTactus(*child);
  }

 private:
  Eigen::Isometry3d origin(const XmlElement& collision) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const XmlElement* origin = collision.child("origin");
    if (!origin) return pose;
    pose.translation() = vectorOr(readNumbers(*origin, "xyz", three_reals, findings_), Eigen::Vector3d::Zero());
    const Eigen::Vector3d rpy = vectorOr(readNumbers(*origin, "rpy", three_reals, findings_), Eigen::Vector3d::Zero());
    pose.linear() = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    return pose;
  }

  double number(const XmlElement& element, const char* name, const AttributeRow& row) {
    const auto numbers = readRequiredNumbers(element, name, row, findings_);
    return numbers.empty() ? 0 : numbers[0];
  }

  static description::CapsuleShape capsule(const Eigen::Isometry3d& pose, double radius, double straight) {
    return {pose * Eigen::Vector3d(0, 0, -straight / 2), pose * Eigen::Vector3d(0, 0, straight / 2), radius};
  }

  /// Capsules are Tactus's own, in either of two ways: <capsule radius length/> in the <geometry>, or, for readers
  /// that know none, a <cylinder> in the <geometry> with an empty <capsule/> beside it.
  void addShape(const XmlElement& collision, description::Link& link) {
    const XmlElement* geometry = requireChild(collision, "geometry", findings_);
    if (!geometry) return;
    if (geometry->children.empty())
      return findings_.error(code::missing_element, *geometry, "<geometry> needs a <capsule>, <box> or <sphere>");
    const XmlElement& shape = *geometry->children.front();
    const Eigen::Isometry3d pose = origin(collision);
    const XmlElement* rounded = collision.child("capsule");
    if (rounded) refuseOtherAttributes(*rounded, {}, findings_);
    if (rounded && shape.name != "cylinder")
      findings_.error(code::misplaced_element, *rounded,
                      "<capsule/> rounds the ends of a <cylinder>, not of a <" + shape.name + ">");
    if (shape.name == "capsule") {
      refuseOtherAttributes(shape, {"radius", "length"}, findings_);
      const double radius = number(shape, "radius", positive);
      link.shapes.push_back(capsule(pose, radius, number(shape, "length", not_negative)));
    } else if (shape.name == "box") {
      const auto size = readRequiredNumbers(shape, "size", three_lengths, findings_);
      link.shapes.push_back(description::BoxShape{pose, vectorOr(size, Eigen::Vector3d::Zero())});
    } else if (shape.name == "sphere") {
      link.shapes.push_back(capsule(pose, number(shape, "radius", positive), 0));
    } else if (shape.name == "cylinder") {
      const double radius = number(shape, "radius", positive);
      const double length = number(shape, "length", positive);
      if (rounded) return link.shapes.push_back(capsule(pose, radius, length));
      link.shapes.push_back(capsule(pose, std::min(radius, length / 2), std::max(0.0, length - 2 * radius)));
      findings_.warning(code::shape_not_felt, shape,
                        "link '" + link.name + "' touches with the capsule inside this cylinder: say <capsule/> in the "
                        "<collision> to round its ends");
    } else if (shape.name == "mesh") {
      findings_.warning(code::shape_not_felt, shape,
                        "link '" + link.name + "' cannot touch with a mesh: give a <capsule>, <box> or <sphere>");
    } else {
      findings_.error(code::unknown_element, shape, "<geometry> has no <" + shape.name + ">",
                      nearestName(shape.name, {"capsule", "box", "sphere", "cylinder", "mesh"}));
    }
  }

  void addRotor(const XmlElement& rotor, description::Joint& joint) {
    refuseOtherAttributes(rotor, {"inertia", "gear-ratio"}, findings_);
    joint.rotor_inertia = number(rotor, "inertia", not_negative);
    if (joint.type == description::JointType::fixed)
      findings_.error(code::misplaced_element, rotor, "joint '" + joint.name + "' is fixed: it has no rotor");
    if (description::velocityCount(joint.type) > 1)
      findings_.error(code::misplaced_element, rotor,
                      "joint '" + joint.name + "' has several degrees of freedom: which one its rotor turns with is "
                      "not said, leave it out");
    const auto ratio = readNumbers(rotor, "gear-ratio", one_real, findings_);
    if (ratio.empty()) return;
    joint.gear_ratio = ratio[0];
    if (ratio[0] == 0)
      findings_.errorAtValue(code::bad_value, rotor, *rotor.attribute("gear-ratio"), "a gear ratio must not be zero");
  }

  void readTactus(const XmlElement& tactus) {
    refuseOtherAttributes(tactus, {}, findings_);
    for (const auto& child : tactus.children) {
      if (child->name == "skin") {
        refuseOtherAttributes(*child, {"links"}, findings_);
        for (std::string& link : members(*child, "links", linkNames(), code::unknown_link, "link"))
          if (std::find(robot_.skin.begin(), robot_.skin.end(), link) == robot_.skin.end())
            robot_.skin.push_back(std::move(link));
      } else if (child->name == "links") {
        addGroup(*child, linkNames(), robot_.link_groups, code::unknown_link, "link");
      } else if (child->name == "joints") {
        addGroup(*child, movingJointNames(), robot_.joint_groups, code::unknown_joint, "moving joint");
      } else {
        findings_.error(code::unknown_element, *child, "<tactus> has no <" + child->name + ">",
                        nearestName(child->name, {"skin", "links", "joints"}));
      }
    }
  }

  void addGroup(const XmlElement& element, const std::vector<std::string>& names,
                std::vector<description::Group>& groups, const Code& unknown, const char* what) {
    refuseOtherAttributes(element, {"name", "members"}, findings_);
    const XmlAttribute* name = requireAttribute(element, "name", findings_);
    auto found = members(element, "members", names, unknown, what);
    if (!name) return;
    const bool taken = std::find(names.begin(), names.end(), name->value) != names.end() ||
                       std::any_of(groups.begin(), groups.end(), [&](const auto& g) { return g.name == name->value; });
    if (taken)
      findings_.errorAtValue(code::duplicate_name, element, *name,
                             "the name '" + name->value + "' is that of a " + what + " or of a group already");
    groups.push_back({name->value, std::move(found), element.place()});
  }

  std::vector<std::string> members(const XmlElement& element, const char* attribute,
                                   const std::vector<std::string>& names, const Code& unknown, const char* what) {
    const XmlAttribute* given = requireAttribute(element, attribute, findings_);
    if (!given) return {};
    auto words = splitWords(given->value);
    for (std::size_t i = 0; i < words.size(); ++i)
      if (std::find(names.begin(), names.end(), words[i]) == names.end())
        findings_.errorAtWord(unknown, element, *given, i,
                              "the robot has no " + std::string(what) + " '" + words[i] + "'",
                              nearestName(words[i], names));
    return words;
  }

  std::vector<std::string> linkNames() const {
    std::vector<std::string> names;
    for (const auto& link : robot_.links) names.push_back(link.name);
    return names;
  }

  std::vector<std::string> movingJointNames() const {
    std::vector<std::string> names;
    for (int i : robot_.movingJoints()) names.push_back(robot_.joints[static_cast<std::size_t>(i)].name);
    return names;
  }

  const RobotFile& file_;
  Robot& robot_;
  Findings& findings_;
};

}  // namespace

void addTactusElements(const RobotFile& file, Robot& robot, Findings& findings) {
  ExtrasReader(file, robot, findings).run();
}

}  // namespace tactus::dsl
