#include "framework/dynamics/check_robot.h"

#include <Eigen/Eigenvalues>
#include <charconv>
#include <cmath>
#include <map>
#include <string>

#include "framework/dynamics/model.h"

namespace tactus::dynamics {
namespace {

using description::Joint;
using description::JointType;
using description::Link;
using description::Robot;

/// Principal moments may miss the triangle inequality by this share: they are often written with six digits.
constexpr double triangle_tolerance = 1e-6;
/// A smallest moment below this share of the greatest is rounding, not inertia.
constexpr double definite_tolerance = 1e-12;
constexpr double unit_tolerance = 1e-6;

std::string quoted(const std::string& name) { return "'" + name + "'"; }

std::string text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

/// Three digits, for numbers that were computed and not written.
std::string rounded(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 3);
  return std::string(buffer, result.ptr);
}

std::string where(const description::Place& place) {
  return place.line > 0 ? " (line " + std::to_string(place.line) + ")" : "";
}

template <class Named>
void checkUnique(const std::vector<Named>& all, const std::string& kind) {
  std::map<std::string, const Named*> seen;
  for (const Named& one : all) {
    const auto [first, fresh] = seen.emplace(one.name, &one);
    if (!fresh) {
      throw ModelError("two " + kind + "s are named " + quoted(one.name) + where(first->second->place) +
                           ": give one of them another name",
                       one.place);
    }
  }
}

bool isRotation(const Eigen::Matrix3d& R) {
  return (R.transpose() * R).isIdentity(unit_tolerance) && R.determinant() > 0;
}

void checkLink(const Link& link) {
  const std::string subject = "link " + quoted(link.name);
  if (!link.has_inertial) return;
  if (!std::isfinite(link.mass)) throw ModelError(subject + ": its mass is not a finite number", link.place);
  if (link.mass < 0) {
    throw ModelError(subject + ": its mass is " + text(link.mass) + " kg; a mass cannot be negative", link.place);
  }
  if (!link.centre_of_mass.allFinite()) {
    throw ModelError(subject + ": its centre of mass is not made of finite numbers", link.place);
  }
  if (!link.inertia.allFinite()) {
    throw ModelError(subject + ": its inertia is not made of finite numbers", link.place);
  }
  if (!link.inertia.isApprox(link.inertia.transpose(), unit_tolerance)) {
    throw ModelError(subject + ": its inertia matrix is not symmetric", link.place);
  }
}

void checkJoint(const Joint& joint) {
  const std::string subject = "joint " + quoted(joint.name);
  if (!joint.origin.matrix().allFinite()) {
    throw ModelError(subject + ": its origin is not made of finite numbers", joint.place);
  }
  if (!isRotation(joint.origin.linear())) {
    throw ModelError(subject + ": the orientation of its origin is not a rotation", joint.place);
  }
  if (joint.type == JointType::fixed) return;
  const bool has_axis = joint.type != JointType::spherical && joint.type != JointType::floating;
  if (has_axis && (!joint.axis.allFinite() || std::abs(joint.axis.norm() - 1) > unit_tolerance)) {
    throw ModelError(subject + ": its axis must have length 1, not " + text(joint.axis.norm()), joint.place);
  }
  if (std::isnan(joint.lower) || std::isnan(joint.upper)) {
    throw ModelError(subject + ": its limits are not numbers", joint.place);
  }
  if (joint.lower > joint.upper) {
    throw ModelError(subject + ": its lower limit " + text(joint.lower) + " lies above its upper limit " +
                         text(joint.upper),
                     joint.place);
  }
  const auto notNegative = [&](double value, const char* what, bool may_be_infinite) {
    if (std::isnan(value) || value < 0 || (!may_be_infinite && std::isinf(value))) {
      throw ModelError(subject + ": its " + what + " is " + text(value) + "; it must be a number of at least 0",
                       joint.place);
    }
  };
  notNegative(joint.effort, "effort limit", true);
  notNegative(joint.velocity, "velocity limit", true);
  notNegative(joint.damping, "damping", false);
  notNegative(joint.friction, "friction", false);
  notNegative(joint.rotor_inertia, "rotor inertia", false);
  if (!std::isfinite(joint.gear_ratio) || joint.gear_ratio == 0)
    throw ModelError(subject + ": its gear ratio is " + text(joint.gear_ratio) + "; it must be a number other than 0",
                     joint.place);
  if (joint.rotor_inertia > 0 && description::velocityCount(joint.type) > 1)
    throw ModelError(subject + " has several degrees of freedom: which one its rotor turns with is not said, leave it out",
                     joint.place);
}

}  // namespace

std::vector<int> checkStructure(const Robot& robot) {
  const int link_count = static_cast<int>(robot.links.size());
  const int joint_count = static_cast<int>(robot.joints.size());
  if (link_count == 0) throw ModelError("the robot " + quoted(robot.name) + " has no links", robot.place);
  checkUnique(robot.links, "link");
  checkUnique(robot.joints, "joint");

  std::vector<int> carrier(link_count, -1);                        // the joint that carries each link
  std::vector<std::vector<int>> joints_below(link_count);
  for (int j = 0; j < joint_count; ++j) {
    const Joint& joint = robot.joints[j];
    const std::string subject = "joint " + quoted(joint.name);
    if (joint.parent < 0 || joint.parent >= link_count) {
      throw ModelError(subject + " has no parent link: name one of the robot's links", joint.place);
    }
    if (joint.child < 0 || joint.child >= link_count) {
      throw ModelError(subject + " has no child link: name one of the robot's links", joint.place);
    }
    const std::string child = quoted(robot.links[joint.child].name);
    if (joint.child == joint.parent) {
      throw ModelError(subject + " joins link " + child + " to itself: its parent and child must differ", joint.place);
    }
    if (carrier[joint.child] >= 0) {
      throw ModelError("link " + child + " is the child of two joints, " +
                           quoted(robot.joints[carrier[joint.child]].name) + " and " + quoted(joint.name) +
                           ": a robot is a tree, remove one of them",
                       joint.place);
    }
    carrier[joint.child] = j;
    joints_below[joint.parent].push_back(j);
  }

  int root = -1;
  for (int i = 0; i < link_count; ++i) {
    if (carrier[i] >= 0) continue;
    if (root >= 0) {
      throw ModelError("the robot has two roots, " + quoted(robot.links[root].name) + " and " +
                           quoted(robot.links[i].name) + ": join the second one to the tree",
                       robot.links[i].place);
    }
    root = i;
  }
  if (root < 0) {
    throw ModelError("every link is the child of a joint, so the joints form a loop: one link must be the base",
                     robot.joints.front().place);
  }
  if (robot.root != root) {
    throw ModelError("the root of the robot is link " + quoted(robot.links[root].name) + ", which no joint carries",
                     robot.links[root].place);
  }

  std::vector<int> order;
  std::vector<bool> reached(link_count, false);
  std::vector<int> pending(joints_below[root].rbegin(), joints_below[root].rend());
  reached[root] = true;
  while (!pending.empty()) {
    const int j = pending.back();
    pending.pop_back();
    const int child = robot.joints[j].child;
    order.push_back(j);
    reached[child] = true;
    pending.insert(pending.end(), joints_below[child].rbegin(), joints_below[child].rend());
  }
  for (int i = 0; i < link_count; ++i) {
    if (reached[i]) continue;
    throw ModelError("link " + quoted(robot.links[i].name) + " hangs in a loop of joints that never reaches the base " +
                         quoted(robot.links[root].name) + ": open the loop",
                     robot.links[i].place);
  }
  return order;
}

std::vector<Drive> resolveMimics(const Robot& robot) {
  const int joint_count = static_cast<int>(robot.joints.size());
  const auto hasOneCoordinate = [](const Joint& joint) { return description::velocityCount(joint.type) == 1; };
  std::vector<Drive> drives(robot.joints.size());
  for (int j = 0; j < joint_count; ++j) {
    const Joint& driven = robot.joints[j];
    const std::string subject = "joint " + quoted(driven.name);
    Drive& drive = drives[j];
    drive.driver = j;
    int links = 0;
    while (robot.joints[drive.driver].mimic) {
      const description::Mimic& mimic = *robot.joints[drive.driver].mimic;
      if (mimic.driver < 0 || mimic.driver >= joint_count)
        throw ModelError(subject + " mimics a joint that the robot does not have: name one of its joints",
                         driven.place);
      if (!std::isfinite(mimic.multiplier) || !std::isfinite(mimic.offset))
        throw ModelError(subject + ": the multiplier and offset of its mimic must be finite numbers", driven.place);
      if (++links > joint_count)
        throw ModelError(subject + " mimics itself, directly or through others: one of them must move freely",
                         driven.place);
      drive.offset += drive.ratio * mimic.offset;
      drive.ratio *= mimic.multiplier;
      drive.driver = mimic.driver;
    }
    if (drive.driver == j) continue;
    const Joint& driver = robot.joints[drive.driver];
    if (!hasOneCoordinate(driven) || !hasOneCoordinate(driver))
      throw ModelError(subject + " mimics joint " + quoted(driver.name) +
                           ": both must be revolute, continuous or prismatic",
                       driven.place);
  }
  return drives;
}

void checkNumbers(const Robot& robot) {
  for (const Link& link : robot.links) checkLink(link);
  for (const Joint& joint : robot.joints) checkJoint(joint);
}

void checkBodyInertia(const RigidBodyInertia& inertia, const Link& carrier) {
  const std::string subject = "link " + quoted(carrier.name);
  if (!(inertia.mass > 0)) {
    throw ModelError(subject + " moves but has no mass: give it an <inertial> with mass and inertia, or join it by a "
                               "fixed joint to a link that has them",
                     carrier.place);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia.inertiaAboutCentreOfMass(),
                                                             Eigen::EigenvaluesOnly);
  const Eigen::Vector3d& moments = solver.eigenvalues();           // ascending
  const std::string listed = "(principal moments about its centre of mass, with all that is fixed to it and its "
                             "rotor: " +
                             rounded(moments[0]) + ", " + rounded(moments[1]) + ", " + rounded(moments[2]) + " kg m²)";
  if (moments[0] <= definite_tolerance * moments[2]) {
    throw ModelError(subject + ": its inertia is not positive definite " + listed +
                         ": all three principal moments must be greater than 0",
                     carrier.place);
  }
  if (moments[2] > (moments[0] + moments[1]) * (1 + triangle_tolerance)) {
    throw ModelError(subject + ": no body can have its inertia " + listed +
                         ": the greatest moment must not exceed the sum of the two others",
                     carrier.place);
  }
}

}  // namespace tactus::dynamics
