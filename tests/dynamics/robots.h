#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "framework/description/robot.h"

/// Robots built in code, for tests and benchmarks: the arm and the hand of the exploration, a humanoid, chains and
/// random trees.
namespace tactus::test_robots {

using description::Joint;
using description::JointType;
using description::Link;
using description::Robot;

inline Eigen::Isometry3d pose(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy = Eigen::Vector3d::Zero()) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  X.translation() = xyz;
  return X;
}

inline int addLink(Robot& robot, const std::string& name, double mass, const Eigen::Vector3d& centre_of_mass,
                   const Eigen::Vector3d& moments) {
  Link link;
  link.name = name;
  link.has_inertial = mass > 0;
  link.mass = mass;
  link.centre_of_mass = centre_of_mass;
  link.inertia = moments.asDiagonal();
  robot.links.push_back(link);
  return static_cast<int>(robot.links.size()) - 1;
}

inline Joint& addJoint(Robot& robot, const std::string& name, JointType type, int parent, int child,
                       const Eigen::Isometry3d& origin, const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ()) {
  Joint joint;
  joint.name = name;
  joint.type = type;
  joint.parent = parent;
  joint.child = child;
  joint.origin = origin;
  joint.axis = axis;
  robot.joints.push_back(joint);
  return robot.joints.back();
}

/// KUKA LWR 4+: seven joints, links "base", "1" … "7"; "7" is the flange.
inline Robot lwr() {
  struct Row {
    const char* joint;
    double z;
    Eigen::Vector3d axis;
    double mass;
    Eigen::Vector3d centre_of_mass, moments;
  };
  const Eigen::Vector3d upper(0.01606, 0.01394, 0.00352), x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const Row rows[] = {{"a1", 0.11, z, 2.35, 0.13 * z, upper},
                      {"a2", 0.2005, -y, 2.35, 0.07 * z, upper},
                      {"e1", 0.20, z, 2.35, 0.13 * z, upper},
                      {"a3", 0.20, y, 2.35, 0.07 * z, upper},
                      {"a4", 0.20, z, 2.35, 0.124 * z, {0.01486, 0.01275, 0.00352}},
                      {"a5", 0.19, -y, 1.1, 0.0625 * z, 0.00286 * (x + y + z)},
                      {"a6", 0.078, z, 0.25, 0 * z, 0.00042 * (x + y + z)}};
  Robot robot;
  robot.name = "lwr";
  int parent = addLink(robot, "base", 2.0, 0.055 * z, {0.00382, 0.00382, 0.0036});
  for (const Row& row : rows) {
    const int child = addLink(robot, std::to_string(robot.links.size()), row.mass, row.centre_of_mass, row.moments);
    addJoint(robot, row.joint, JointType::revolute, parent, child, pose(row.z * z), row.axis).rotor_inertia = 0.05;
    parent = child;
  }
  return robot;
}

/// Allegro right hand: sixteen joints; links "palm", "index_0" … "index_tip", …, "thumb_tip".  Joined to `parent` by
/// a fixed joint, or the root when that is -1.
inline void addAllegro(Robot& robot, int parent, const Eigen::Isometry3d& mount = Eigen::Isometry3d::Identity()) {
  struct Row {
    Eigen::Vector3d xyz, rpy, axis;
    double mass;
    Eigen::Vector3d centre_of_mass, moments;
  };
  const Eigen::Vector3d o = Eigen::Vector3d::Zero(), x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  const int palm = addLink(robot, "palm", 0.4154, {-0.0093, 0, -0.0475}, {7.544e-4, 3.700e-4, 4.996e-4});
  if (parent >= 0) addJoint(robot, "mount", JointType::fixed, parent, palm, mount);

  const auto addFinger = [&](const std::string& finger, const Row (&rows)[4], double tip_z) {
    int link = palm;
    for (int k = 0; k < 4; ++k) {
      const Row& row = rows[k];
      const std::string name = finger + "_" + std::to_string(k);
      const int child = addLink(robot, name, row.mass, row.centre_of_mass, row.moments);
      addJoint(robot, name + "_joint", JointType::revolute, link, child, pose(row.xyz, row.rpy), row.axis)
          .rotor_inertia = 1e-4;
      link = child;
    }
    const int tip = addLink(robot, finger + "_tip", 0.0168, o, 9.68e-7 * (x + y + z));
    addJoint(robot, finger + "_tip_joint", JointType::fixed, link, tip, pose(tip_z * z));
  };
  const auto finger = [&](const std::string& name, const Eigen::Vector3d& xyz, double roll) {
    const Row rows[] = {{xyz, roll * x, z, 0.0119, 0.0082 * z, {1.017e-6, 6.48e-7, 1.131e-6}},
                        {0.0164 * z, o, y, 0.0650, 0.0270 * z, {1.989e-5, 1.788e-5, 6.177e-6}},
                        {0.0540 * z, o, y, 0.0355, 0.0192 * z, {6.599e-6, 5.499e-6, 3.374e-6}},
                        {0.0384 * z, o, y, 0.0096, 0.01335 * z, {1.175e-6, 8.78e-7, 9.12e-7}}};
    addFinger(name, rows, 0.0267);
  };
  finger("index", {0, 0.0435, -0.001542}, -0.0872665);
  finger("middle", {0, 0, 0.0007}, 0);
  finger("ring", {0, -0.0435, -0.001542}, 0.0872665);
  const Row thumb[] = {
      {{-0.0182, 0.019333, -0.045987}, {0, -1.658063, -1.570796}, -x, 0.0176, {-0.0179, 0.009, 0.0145},
       {4.732e-6, 4.916e-6, 3.575e-6}},
      {{-0.027, 0.005, 0.0399}, o, z, 0.0119, 0.00885 * z, {1.061e-6, 6.92e-7, 1.131e-6}},
      {0.0177 * z, o, y, 0.0380, 0.0257 * z, {1.076e-5, 9.583e-6, 3.611e-6}},
      {0.0514 * z, o, y, 0.0388, 0.02115 * z, {8.231e-6, 7.027e-6, 3.687e-6}}};
  addFinger("thumb", thumb, 0.0423);
}

inline Robot allegro() {
  Robot robot;
  robot.name = "allegro";
  addAllegro(robot, -1);
  return robot;
}

/// 23 degrees of freedom.
inline Robot lwrAllegro() {
  Robot robot = lwr();
  robot.name = "lwr_allegro";
  addAllegro(robot, robot.linkIndex("7"), pose({-0.0823, 0, 0.0475}, {0, -std::numbers::pi / 3, 0}));
  return robot;
}

/// A serial chain of revolute joints about z, y, z, y, …: links of 0.1 m and 0.5 kg, with rotors.
inline Robot chain(int joints) {
  Robot robot;
  robot.name = "chain";
  const double mass = 0.5, length = 0.1, width = 0.06;
  const double across = mass / 12 * (length * length + width * width);
  int parent = addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  for (int i = 0; i < joints; ++i) {
    const std::string number = std::to_string(i + 1);
    const int child = addLink(robot, "link" + number, mass, {0, 0, length / 2},
                              {across, across, mass / 6 * width * width});
    const Eigen::Vector3d axis = i % 2 == 0 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
    Joint& joint = addJoint(robot, "joint" + number, JointType::revolute, parent, child,
                            pose({0, 0, i == 0 ? 0 : length}), axis);
    joint.rotor_inertia = 1e-6;
    joint.gear_ratio = 100;
    parent = child;
  }
  return robot;
}

/// A humanoid of 1.7 m and about 75 kg, all links solid boxes: a pelvis on a floating base, a waist of three joints,
/// legs of six, arms of seven, one in the neck: 30 joints and 36 degrees of freedom.  x ahead, y to the left, z up.
inline Robot humanoid() {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  Robot robot;
  robot.name = "humanoid";
  const int world = addLink(robot, "world", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const auto addBox = [&](const std::string& name, double mass, const Eigen::Vector3d& centre,
                          const Eigen::Vector3d& size) {
    const Eigen::Vector3d square = size.cwiseAbs2();
    return addLink(robot, name, mass, centre, mass / 12 * (Eigen::Vector3d::Constant(square.sum()) - square));
  };
  // A box that `joint` moves against `parent`, and the inertia of the joint's rotor behind its gear.
  const auto addPart = [&](const std::string& joint, int parent, const Eigen::Vector3d& at,
                           const Eigen::Vector3d& axis, double mass, const Eigen::Vector3d& centre,
                           const Eigen::Vector3d& size, double reflected) {
    const int child = addBox(joint + "_link", mass, centre, size);
    Joint& added = addJoint(robot, joint, JointType::revolute, parent, child, pose(at), axis);
    added.gear_ratio = 100;
    added.rotor_inertia = reflected / (added.gear_ratio * added.gear_ratio);
    return child;
  };
  const Eigen::Vector3d o = Eigen::Vector3d::Zero(), coupling(0.08, 0.08, 0.08);

  const int pelvis = addBox("pelvis", 9, {0, 0, 0.02}, {0.18, 0.28, 0.16});
  addJoint(robot, "floating_base", JointType::floating, world, pelvis, pose(o));

  for (const auto& [side, s] : {std::pair{"left_", 1.0}, std::pair{"right_", -1.0}}) {
    const std::string name = side;
    int leg = addPart(name + "hip_yaw", pelvis, {0, 0.09 * s, -0.08}, z, 1.2, o, coupling, 0.1);
    leg = addPart(name + "hip_roll", leg, o, x, 1.5, o, coupling, 0.1);
    leg = addPart(name + "hip_pitch", leg, o, y, 6.5, {0, 0.01 * s, -0.18}, {0.14, 0.13, 0.36}, 0.15);
    leg = addPart(name + "knee", leg, {0, 0, -0.40}, y, 3.4, {0.01, 0, -0.18}, {0.11, 0.10, 0.36}, 0.15);
    leg = addPart(name + "ankle_pitch", leg, {0, 0, -0.40}, y, 0.5, o, 0.6 * coupling, 0.05);
    addPart(name + "ankle_roll", leg, o, x, 1.3, {0.04, 0, -0.05}, {0.24, 0.10, 0.06}, 0.05);
  }

  int trunk = addPart("waist_yaw", pelvis, {0, 0, 0.12}, z, 1.0, o, coupling, 0.1);
  trunk = addPart("waist_roll", trunk, o, x, 1.0, o, coupling, 0.1);
  const int chest = addPart("waist_pitch", trunk, o, y, 19, {0.01, 0, 0.22}, {0.20, 0.32, 0.40}, 0.15);

  for (const auto& [side, s] : {std::pair{"left_", 1.0}, std::pair{"right_", -1.0}}) {
    const std::string name = side;
    int arm = addPart(name + "shoulder_pitch", chest, {0, 0.19 * s, 0.36}, y, 0.8, o, coupling, 0.05);
    arm = addPart(name + "shoulder_roll", arm, o, x, 0.8, o, coupling, 0.05);
    arm = addPart(name + "shoulder_yaw", arm, o, z, 2.2, {0, 0, -0.14}, {0.09, 0.09, 0.28}, 0.03);
    arm = addPart(name + "elbow", arm, {0, 0, -0.30}, y, 0.7, {0, 0, -0.05}, {0.08, 0.07, 0.10}, 0.03);
    arm = addPart(name + "forearm_yaw", arm, {0, 0, -0.10}, z, 0.9, {0, 0, -0.07}, {0.07, 0.07, 0.14}, 0.01);
    arm = addPart(name + "wrist_roll", arm, {0, 0, -0.16}, x, 0.2, o, 0.5 * coupling, 0.005);
    addPart(name + "wrist_pitch", arm, o, y, 0.5, {0, 0, -0.08}, {0.09, 0.03, 0.16}, 0.005);
  }
  addPart("neck", chest, {0, 0, 0.45}, z, 4.3, {0.02, 0, 0.10}, {0.19, 0.15, 0.22}, 0.01);
  return robot;
}

using Random = std::mt19937_64;

inline double uniform(Random& random, double low, double high) {
  return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

inline Eigen::VectorXd uniformVector(Random& random, int size, double bound) {
  return Eigen::VectorXd::NullaryExpr(size, [&] { return uniform(random, -bound, bound); });
}

inline Eigen::Vector3d uniformVector3(Random& random, double bound) { return uniformVector(random, 3, bound); }

inline Eigen::Vector3d direction(Random& random) {
  while (true) {
    const Eigen::Vector3d v = uniformVector3(random, 1);
    if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
  }
}

inline Eigen::Matrix3d rotation(Random& random) {
  const double angle = uniform(random, -3, 3);
  return Eigen::AngleAxisd(angle, direction(random)).toRotationMatrix();
}

/// The inertia of a solid box with random edges, turned at random.
inline void giveRandomInertia(Random& random, Link& link) {
  const Eigen::Vector3d square = Eigen::Vector3d::NullaryExpr([&] { return std::pow(uniform(random, 0.03, 0.4), 2); });
  const Eigen::Matrix3d R = rotation(random);
  link.has_inertial = true;
  link.mass = uniform(random, 0.1, 4);
  link.centre_of_mass = uniformVector3(random, 0.2);
  link.inertia = R * (link.mass / 12 * (Eigen::Vector3d::Constant(square.sum()) - square)).asDiagonal() *
                 R.transpose();
  link.inertia = 0.5 * (link.inertia + link.inertia.transpose()).eval();
}

inline JointType randomMotion(Random& random, bool every_kind) {
  const double kind = uniform(random, 0, 1);
  if (every_kind && kind < 0.1) return JointType::planar;
  if (every_kind && kind < 0.2) return JointType::spherical;
  if (every_kind && kind < 0.3) return JointType::floating;
  return kind < 0.5 ? JointType::prismatic : JointType::revolute;
}

/// A tree with `moving` moving joints, and fixed joints between and after them, some to massless links.  Links hang at
/// any link made before: chains, stars and everything between.  Joints are revolute and prismatic, or of every kind.
inline Robot randomTree(Random& random, int moving, bool every_kind = false) {
  Robot robot;
  robot.name = "random";
  addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const double chain_share = uniform(random, 0, 1);                // how often a link hangs at the one made last
  for (int made = 0; made < moving;) {
    const int last = static_cast<int>(robot.links.size()) - 1;
    const int parent = uniform(random, 0, 1) < chain_share ? last : static_cast<int>(random() % (last + 1));
    const JointType type = uniform(random, 0, 1) < 0.25 ? JointType::fixed : randomMotion(random, every_kind);
    const std::string name = std::to_string(last + 1);
    const int child = addLink(robot, "link" + name, 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
    if (type != JointType::fixed || uniform(random, 0, 1) < 0.5) giveRandomInertia(random, robot.links[child]);
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();
    origin.linear() = rotation(random);
    origin.translation() = uniformVector3(random, 0.4);
    Joint& joint = addJoint(robot, "joint" + name, type, parent, child, origin, direction(random));
    if (type == JointType::fixed) continue;
    ++made;
    if (description::velocityCount(type) > 1 || uniform(random, 0, 1) < 0.5) continue;
    joint.rotor_inertia = uniform(random, 0, 0.0005);
    joint.gear_ratio = uniform(random, 1, 10);
  }
  return robot;
}

/// A tree of exactly `dof` degrees of freedom, with joints of every kind.
inline Robot randomTreeOf(Random& random, int dof) {
  while (true) {
    const int joints = dof - static_cast<int>(random() % (2 * dof / 3 + 1));
    Robot robot = randomTree(random, joints, true);
    int made = 0;
    for (const Joint& joint : robot.joints) made += description::velocityCount(joint.type);
    if (made == dof) return robot;
  }
}

/// Lets about a third of the joints of one degree of freedom follow others, some of them through a third one.
inline void coupleJoints(Random& random, Robot& robot) {
  std::vector<int> single;
  for (int j = 0; j < static_cast<int>(robot.joints.size()); ++j)
    if (description::velocityCount(robot.joints[j].type) == 1) single.push_back(j);
  // Each follows one that stands before it in a shuffled order: no circles.
  for (size_t k = single.size(); k > 1; --k) std::swap(single[k - 1], single[random() % k]);
  for (size_t k = 1; k < single.size(); ++k) {
    if (uniform(random, 0, 1) < 0.65) continue;
    description::Mimic mimic;
    mimic.driver = single[random() % k];
    mimic.multiplier = uniform(random, -2, 2);
    mimic.offset = uniform(random, -1, 1);
    robot.joints[single[k]].mimic = mimic;
  }
}

}  // namespace tactus::test_robots
