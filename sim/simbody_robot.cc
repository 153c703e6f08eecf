#include "sim/simbody_robot.h"

#include <string>

#include "framework/runtime/plant.h"

namespace tactus::sim {
namespace {

using description::Joint;
using description::JointType;
using description::Link;
using description::Robot;

/// Mass, first and second moments of rigidly joined links, in the frame of the body that carries them.
struct MergedMass {
  double mass = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();                // m c
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();               // about the body's origin

  Eigen::Vector3d centreOfMass() const { return moment / mass; }
  void add(const Link& link, const Eigen::Isometry3d& X_BL) {
    const Eigen::Vector3d c = X_BL * link.centre_of_mass;
    mass += link.mass;
    moment += link.mass * c;
    inertia += X_BL.linear() * link.inertia * X_BL.linear().transpose() +
               link.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  }
};

/// The thin disk of robot.h: J about the axis, J/2 about every axis across it.
Eigen::Matrix3d rotorInertia(const Joint& joint) {
  return 0.5 * joint.reflectedInertia() * (Eigen::Matrix3d::Identity() + joint.axis * joint.axis.transpose());
}

/// A rotation that takes Simbody's joint axis (z of a Pin, x of a Slider) to the joint's.
Eigen::Isometry3d axisAlignment(const Joint& joint) {
  const Eigen::Vector3d simbody_axis =
      joint.type == JointType::revolute ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitX();
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = Eigen::Quaterniond::FromTwoVectors(simbody_axis, joint.axis).toRotationMatrix();
  return X;
}

/// Of the body that `joint` moves: its child at X_BL, all links that fixed joints hang on that, and the rotor.
MergedMass mergedMass(const Robot& robot, const Joint& joint, const Eigen::Isometry3d& X_BL) {
  MergedMass merged;
  std::vector<int> links = {joint.child};
  std::vector<Eigen::Isometry3d> poses = {X_BL};
  for (size_t i = 0; i < links.size(); ++i) {
    merged.add(robot.links[links[i]], poses[i]);
    for (const Joint& fixed : robot.joints)
      if (fixed.type == JointType::fixed && fixed.parent == links[i]) {
        links.push_back(fixed.child);
        poses.push_back(poses[i] * fixed.origin);
      }
  }
  merged.inertia += X_BL.linear() * rotorInertia(joint) * X_BL.linear().transpose();
  if (!(merged.mass > 0))
    throw runtime::PlantError("link '" + robot.links[joint.child].name + "' is moved by joint '" + joint.name +
                              "' but has no mass: the plant needs an <inertial> with a positive mass on it");
  return merged;
}

SimTK::MassProperties toSimTK(const MergedMass& merged) {
  const SimTK::Mat33 I = sim::toSimTK(merged.inertia);
  return {merged.mass, sim::toSimTK(merged.centreOfMass()),
          SimTK::Inertia(SimTK::SymMat33(I(0, 0), I(1, 0), I(1, 1), I(2, 0), I(2, 1), I(2, 2)))};
}

}  // namespace

SimbodyRobot::SimbodyRobot(const Robot& robot, const Eigen::Vector3d& gravity_W) : matter_(system_) {
  matter_.setShowDefaultGeometry(false);
  try {
    build(robot, gravity_W);
    system_.realizeTopology();
  } catch (const SimTK::Exception::Base& error) {
    throw runtime::PlantError("Simbody refuses robot '" + robot.name + "': " + error.getMessage());
  }
}

void SimbodyRobot::build(const Robot& robot, const Eigen::Vector3d& gravity_W) {
  std::vector<std::vector<int>> joints_below(robot.links.size());
  for (int j = 0; j < static_cast<int>(robot.joints.size()); ++j)
    joints_below[robot.joints[j].parent].push_back(j);

  // Depth-first with children in file order, which is the order of q.
  carriers_.resize(robot.links.size());
  carriers_[robot.root].body = matter_.getGround().getMobilizedBodyIndex();
  std::vector<int> pending(joints_below[robot.root].rbegin(), joints_below[robot.root].rend());
  while (!pending.empty()) {
    const Joint& joint = robot.joints[pending.back()];
    pending.pop_back();
    const Carrier& parent = carriers_[joint.parent];
    const Eigen::Isometry3d X_PJ = parent.pose * joint.origin;
    if (joint.mimic)
      throw runtime::PlantError("joint '" + joint.name + "' follows another joint: the plant moves every joint on its own");
    if (joint.type == JointType::fixed) {
      carriers_[joint.child] = {parent.body, X_PJ};
    } else if (joint.type != JointType::revolute && joint.type != JointType::prismatic) {
      throw runtime::PlantError("joint '" + joint.name +
                                "' has several degrees of freedom: the plant has revolute, continuous and prismatic "
                                "joints only");
    } else {
      const Eigen::Isometry3d X_JB = axisAlignment(joint);
      const MergedMass mass = mergedMass(robot, joint, X_JB.inverse());
      SimTK::MobilizedBody& carrier = matter_.updMobilizedBody(parent.body);
      const SimTK::Transform X_PF = sim::toSimTK(X_PJ * X_JB);
      const SimTK::Body::Rigid body(toSimTK(mass));
      const SimTK::MobilizedBodyIndex index =
          joint.type == JointType::revolute
              ? SimTK::MobilizedBody::Pin(carrier, X_PF, body, SimTK::Transform()).getMobilizedBodyIndex()
              : SimTK::MobilizedBody::Slider(carrier, X_PF, body, SimTK::Transform()).getMobilizedBodyIndex();
      carriers_[joint.child] = {index, X_JB.inverse()};
      bodies_.push_back(index);
      weights_.push_back({sim::toSimTK(mass.centreOfMass()), sim::toSimTK(Eigen::Vector3d(mass.mass * gravity_W))});
    }
    const std::vector<int>& below = joints_below[joint.child];
    pending.insert(pending.end(), below.rbegin(), below.rend());
  }
}

void SimbodyRobot::gravityForces(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& forces) const {
  forces.resize(matter_.getNumBodies());
  forces.setToZero();
  for (int i = 0; i < dof(); ++i) {
    const SimTK::Rotation& R_WB = matter_.getMobilizedBody(bodies_[i]).getBodyRotation(state);
    const SimTK::Vec3 arm_W = R_WB * weights_[i].centre_of_mass_B;
    forces[bodies_[i]] = SimTK::SpatialVec(arm_W % weights_[i].force_W, weights_[i].force_W);
  }
}

}  // namespace tactus::sim
