#include "dsl/urdf_tree.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <mutex>

namespace tactus::dsl {
namespace {

/// Keeps what liburdfdom would print.  Its output handler is one for the whole process, hence the lock.
class CaughtMessages final : public console_bridge::OutputHandler {
 public:
  CaughtMessages() : lock_(mutex()), level_(console_bridge::getLogLevel()) {
    console_bridge::useOutputHandler(this);
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  }
  ~CaughtMessages() override {
    console_bridge::restorePreviousOutputHandler();
    console_bridge::setLogLevel(level_);
  }
  void log(const std::string& text, console_bridge::LogLevel, const char*, int) override { texts.push_back(text); }

  std::vector<std::string> texts;

 private:
  static std::mutex& mutex() {
    static std::mutex only;
    return only;
  }
  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_;
};

/// A type of joint that only Tactus knows.
constexpr const char* spherical = "spherical";

/// The text as liburdfdom can take it, nothing moved: every <collision>, <visual> and <tactus> turned into blanks,
/// since shapes are read by Tactus and liburdfdom stumbles over capsules; what means nothing to a joint likewise; and
/// spherical joints, which it does not know, called floating.
std::string textForUrdfdom(const XmlElement& root) {
  std::string text = root.source->text.text().substr(root.source->text.begin());
  const std::size_t shift = root.source->text.begin();
  const auto blank = [&](const XmlElement& element) {
    for (std::size_t i = element.at - shift; i < element.end - shift; ++i)
      if (text[i] != '\n') text[i] = ' ';
  };
  const auto callFloating = [&](const XmlAttribute& type) {
    const char quote = text[type.value_at - 1 - shift];
    std::string word = std::string("floating") + quote;
    word.resize(type.value_size + 1, ' ');                         // "spherical" and its quote are longer by one
    text.replace(type.value_at - shift, word.size(), word);
  };
  for (const auto& child : root.children) {
    if (child->name == "tactus") blank(*child);
    const bool is_joint = child->name == "joint";
    if (!is_joint && child->name != "link") continue;
    const XmlAttribute* type = is_joint ? child->attribute("type") : nullptr;
    for (const auto& part : child->children)
      if (part->name == "collision" || part->name == "visual" || (type && isMeaningless(type->value, part->name)))
        blank(*part);
    if (type && type->value == spherical) callFloating(*type);
  }
  return text;
}

Eigen::Vector3d vectorOf(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d poseOf(const urdf::Pose& pose) {
  const auto& r = pose.rotation;
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  result.translation() = vectorOf(pose.position);
  return result;
}

description::Link linkOf(const urdf::Link& from, const XmlElement& element) {
  description::Link link;
  link.name = from.name;
  link.place = element.place();
  if (!from.inertial) return link;
  const urdf::Inertial& given = *from.inertial;
  const Eigen::Isometry3d pose = poseOf(given.origin);
  Eigen::Matrix3d inertia;
  inertia << given.ixx, given.ixy, given.ixz, given.ixy, given.iyy, given.iyz, given.ixz, given.iyz, given.izz;
  link.has_inertial = true;
  link.mass = given.mass;
  link.centre_of_mass = pose.translation();
  link.inertia = pose.linear() * inertia * pose.linear().transpose();
  return link;
}

description::JointType typeOf(const urdf::Joint& from, const XmlElement& element) {
  using description::JointType;
  if (element.attribute("type")->value == spherical) return JointType::spherical;
  switch (from.type) {
    case urdf::Joint::FIXED: return JointType::fixed;
    case urdf::Joint::PRISMATIC: return JointType::prismatic;
    case urdf::Joint::PLANAR: return JointType::planar;
    case urdf::Joint::FLOATING: return JointType::floating;
    default: return JointType::revolute;
  }
}

description::Joint jointOf(const urdf::Joint& from, const description::Robot& robot, const XmlElement& element) {
  description::Joint joint;
  joint.name = from.name;
  joint.place = element.place();
  joint.type = typeOf(from, element);
  joint.parent = robot.linkIndex(from.parent_link_name);
  joint.child = robot.linkIndex(from.child_link_name);
  joint.origin = poseOf(from.parent_to_joint_origin_transform);
  if (joint.type == description::JointType::fixed) return joint;
  if (joint.type == description::JointType::spherical || joint.type == description::JointType::floating) return joint;
  joint.axis = vectorOf(from.axis).stableNormalized();
  if (from.limits) {
    joint.effort = from.limits->effort;
    joint.velocity = from.limits->velocity;
    if (from.type != urdf::Joint::CONTINUOUS) {
      joint.lower = from.limits->lower;
      joint.upper = from.limits->upper;
    }
  }
  if (from.dynamics) {
    joint.damping = from.dynamics->damping;
    joint.friction = from.dynamics->friction;
  }
  return joint;
}

}  // namespace

description::Robot buildUrdfTree(const RobotFile& file, Findings& findings) {
  description::Robot robot;
  urdf::ModelInterfaceSharedPtr model;
  {
    CaughtMessages caught;
    model = urdf::parseURDF(textForUrdfdom(*file.root));
    std::string said;
    for (const std::string& text : caught.texts) said += (said.empty() ? "" : "; ") + text;
    if (!model) {
      findings.error(code::refused_by_urdf, *file.root, "liburdfdom refuses the robot: " + said);
      return robot;
    }
    if (!said.empty()) findings.warning(code::urdf_remark, *file.root, "liburdfdom says: " + said);
  }
  robot.name = model->getName();
  robot.place = file.root->place();
  for (const XmlElement* element : file.links)
    robot.links.push_back(linkOf(*model->getLink(element->attribute("name")->value), *element));
  for (const XmlElement* element : file.joints)
    robot.joints.push_back(jointOf(*model->getJoint(element->attribute("name")->value), robot, *element));
  for (description::Joint& joint : robot.joints) {
    const auto& mimic = model->getJoint(joint.name)->mimic;
    if (mimic)
      joint.mimic = description::Mimic{robot.jointIndex(mimic->joint_name), mimic->multiplier, mimic->offset};
  }
  robot.root = robot.linkIndex(model->getRoot()->name);
  return robot;
}

}  // namespace tactus::dsl
