#include "tests/witness/mujoco/mjcf.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cstdio>
#include <initializer_list>

namespace tactus::witness {
namespace {

using description::Joint;
using description::JointType;
using description::Link;
using description::Robot;

std::string print(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    char number[40];
    std::snprintf(number, sizeof number, text.empty() ? "%.17g" : " %.17g", value);
    text += number;
  }
  return text;
}
std::string print(const Eigen::Vector3d& v) { return print({v.x(), v.y(), v.z()}); }
std::string print(const Eigen::Quaterniond& q) { return print({q.w(), q.x(), q.y(), q.z()}); }

std::string attribute(const std::string& name, const std::string& value) { return " " + name + "=\"" + value + "\""; }

std::string jointElement(const std::string& type, const std::string& name, const Eigen::Vector3d& axis) {
  return "<joint" + attribute("type", type) + attribute("name", name) + attribute("axis", print(axis)) + "/>\n";
}
std::string ballElement(const std::string& name) {
  return "<joint" + attribute("type", "ball") + attribute("name", name) + "/>\n";
}

std::string jointElements(const Robot& robot, const Joint& joint) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  switch (joint.type) {
    case JointType::fixed: return "";
    case JointType::revolute: return jointElement("hinge", joint.name, joint.axis);
    case JointType::prismatic: return jointElement("slide", joint.name, joint.axis);
    case JointType::planar: {
      const Eigen::Matrix3d plane = description::planeFrame(joint.axis);
      return jointElement("slide", joint.name + ".x", plane.col(0)) +
             jointElement("slide", joint.name + ".y", plane.col(1)) +
             jointElement("hinge", joint.name + ".angle", plane.col(2));
    }
    case JointType::spherical: return ballElement(joint.name + ".w");
    case JointType::floating:
      if (isFreeJoint(robot, joint)) return "<freejoint" + attribute("name", joint.name) + "/>\n";
      return jointElement("slide", joint.name + ".x", x) + jointElement("slide", joint.name + ".y", y) +
             jointElement("slide", joint.name + ".z", z) + ballElement(joint.name + ".w");
  }
  return "";
}

std::string inertialElement(const Link& link, const Joint& joint) {
  if (!link.has_inertial) return "";
  Eigen::Matrix3d inertia = link.inertia;
  if (joint.type != JointType::fixed)
    inertia += 0.5 * joint.reflectedInertia() * (Eigen::Matrix3d::Identity() + joint.axis * joint.axis.transpose());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(inertia);
  Eigen::Matrix3d axes = principal.eigenvectors();
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  return "<inertial" + attribute("mass", print({link.mass})) + attribute("pos", print(link.centre_of_mass)) +
         attribute("quat", print(Eigen::Quaterniond(axes))) +
         attribute("diaginertia", print(Eigen::Vector3d(principal.eigenvalues()))) + "/>\n";
}

std::string bodyElements(const Robot& robot, int parent) {
  std::string text;
  for (const Joint& joint : robot.joints) {
    if (joint.parent != parent) continue;
    const Link& link = robot.links[joint.child];
    const Eigen::Vector3d position = joint.origin.translation();
    text += "<body" + attribute("name", link.name) + attribute("pos", print(position)) +
            attribute("quat", print(Eigen::Quaterniond(joint.origin.linear()))) + ">\n" +
            inertialElement(link, joint) + jointElements(robot, joint) + bodyElements(robot, joint.child) +
            "</body>\n";
  }
  return text;
}

}  // namespace

bool isFreeJoint(const Robot& robot, const Joint& joint) {
  return joint.type == JointType::floating && joint.parent == robot.root;
}

std::string writeMjcf(const Robot& robot, const Eigen::Vector3d& gravity_W) {
  return "<mujoco" + attribute("model", robot.name) + ">\n" +
         "<compiler angle=\"radian\" coordinate=\"local\" balanceinertia=\"false\" boundmass=\"0\" "
         "boundinertia=\"0\"/>\n"
         "<option" + attribute("gravity", print(gravity_W)) +
         ">\n"
         "<flag constraint=\"disable\" contact=\"disable\" limit=\"disable\" passive=\"disable\" "
         "energy=\"enable\"/>\n"
         "</option>\n"
         "<worldbody>\n" + bodyElements(robot, robot.root) + "</worldbody>\n</mujoco>\n";
}

}  // namespace tactus::witness
