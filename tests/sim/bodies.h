#pragma once

#include <Eigen/Geometry>
#include <string>

#include "framework/description/robot.h"
#include "framework/description/scene.h"
#include "framework/geometry/primitives.h"

/// Robots and scenes for tests: a free body as a chain of six joints, single joints, and objects in one line.
namespace tactus::sim_tests {

inline constexpr double mass = 0.1;                                // kg, of the free body
inline constexpr double carrier_mass = 1e-7;                       // kg, of each link of the chain that carries it

inline Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

inline int addLink(description::Robot& robot, const std::string& name, double link_mass, double inertia) {
  description::Link link;
  link.name = name;
  link.has_inertial = true;
  link.mass = link_mass;
  link.inertia = inertia * Eigen::Matrix3d::Identity();
  robot.links.push_back(link);
  return static_cast<int>(robot.links.size()) - 1;
}

/// A new link `name` on a new joint `name` of the last link.
inline description::Joint& addJoint(description::Robot& robot, const std::string& name, description::JointType type,
                                    const Eigen::Vector3d& axis, double link_mass = carrier_mass,
                                    double inertia = 1e-3 * carrier_mass) {
  description::Joint joint;
  joint.name = name;
  joint.type = type;
  joint.axis = axis;
  joint.parent = static_cast<int>(robot.links.size()) - 1;
  joint.child = addLink(robot, name, link_mass, inertia);
  robot.joints.push_back(joint);
  return robot.joints.back();
}

inline description::Robot world() {
  description::Robot robot;
  robot.name = "free body";
  addLink(robot, "world", 0, 0);
  return robot;
}

inline void addSlides(description::Robot& robot) {
  addJoint(robot, "x", description::JointType::prismatic, Eigen::Vector3d::UnitX());
  addJoint(robot, "y", description::JointType::prismatic, Eigen::Vector3d::UnitY());
  addJoint(robot, "z", description::JointType::prismatic, Eigen::Vector3d::UnitZ());
}

/// q = (x, y, z): moves without turning.
inline description::Robot slidingBody(const description::LinkShape& shape) {
  description::Robot robot = world();
  addSlides(robot);
  robot.links.back().mass = mass;
  robot.links.back().inertia = 1e-4 * Eigen::Matrix3d::Identity();
  robot.links.back().shapes = {shape};
  return robot;
}

/// q = (x, y, z, yaw, pitch, roll): a free body; singular at pitch = ±90°.
inline description::Robot freeBody(const description::LinkShape& shape, double inertia = 4e-5) {
  description::Robot robot = world();
  addSlides(robot);
  addJoint(robot, "yaw", description::JointType::revolute, Eigen::Vector3d::UnitZ());
  addJoint(robot, "pitch", description::JointType::revolute, Eigen::Vector3d::UnitY());
  addJoint(robot, "roll", description::JointType::revolute, Eigen::Vector3d::UnitX(), mass, inertia);
  robot.links.back().shapes = {shape};
  return robot;
}

inline description::CapsuleShape sphere(double radius) {
  return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), radius};
}
/// Along x, centred.
inline description::CapsuleShape capsule(double radius, double length) {
  return {{-0.5 * length, 0, 0}, {0.5 * length, 0, 0}, radius};
}

inline description::Object object(const std::string& name, const Eigen::Isometry3d& pose,
                                  std::shared_ptr<const geometry::Shape> shape) {
  description::Object made;
  made.name = name;
  made.pose = pose;
  made.primitives.push_back({shape, Eigen::Isometry3d::Identity()});
  return made;
}

}  // namespace tactus::sim_tests
