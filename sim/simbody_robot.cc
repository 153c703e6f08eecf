#include "sim/simbody_robot.h"

#include <string>
#include <type_traits>

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

/// A rotation that takes Simbody's joint axes (z of a Pin, x of a Slider, x, y, z of a Planar) to the joint's.
Eigen::Isometry3d axisAlignment(const Joint& joint) {
  const auto alongAxis = [&](const Eigen::Vector3d& simbody_axis) {
    return Eigen::Quaterniond::FromTwoVectors(simbody_axis, joint.axis).toRotationMatrix();
  };
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  switch (joint.type) {
    case JointType::revolute: X.linear() = alongAxis(Eigen::Vector3d::UnitZ()); break;
    case JointType::prismatic: X.linear() = alongAxis(Eigen::Vector3d::UnitX()); break;
    case JointType::planar: X.linear() = description::planeFrame(joint.axis); break;
    case JointType::spherical:
    case JointType::floating:
    case JointType::fixed: break;
  }
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

/// A body on a joint of `type`, which is not fixed; both its frames are those of the joint.
SimTK::MobilizedBodyIndex addBody(JointType type, SimTK::MobilizedBody& parent, const SimTK::Transform& X_PF,
                                  const SimTK::Body& body) {
  const auto add = [&]<class Mobilizer>(std::type_identity<Mobilizer>) {
    return Mobilizer(parent, X_PF, body, SimTK::Transform()).getMobilizedBodyIndex();
  };
  switch (type) {
    case JointType::prismatic: return add(std::type_identity<SimTK::MobilizedBody::Slider>());
    case JointType::planar: return add(std::type_identity<SimTK::MobilizedBody::Planar>());
    case JointType::spherical: return add(std::type_identity<SimTK::MobilizedBody::Ball>());
    case JointType::floating: return add(std::type_identity<SimTK::MobilizedBody::Free>());
    case JointType::revolute:
    case JointType::fixed: break;
  }
  return add(std::type_identity<SimTK::MobilizedBody::Pin>());
}

}  // namespace

SimbodyRobot::SimbodyRobot(const Robot& robot, const Eigen::Vector3d& gravity_W, const std::vector<FreeBody>& free_bodies)
    : matter_(system_) {
  matter_.setShowDefaultGeometry(false);
  try {
    build(robot, gravity_W);
    for (const FreeBody& body : free_bodies) addFreeBody(body, gravity_W);
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
    const int j = pending.back();
    pending.pop_back();
    const Joint& joint = robot.joints[j];
    const Carrier& parent = carriers_[joint.parent];
    const Eigen::Isometry3d X_PJ = parent.pose * joint.origin;
    if (joint.type == JointType::fixed) {
      carriers_[joint.child] = {parent.body, X_PJ};
    } else {
      const Eigen::Isometry3d X_JB = axisAlignment(joint);
      const MergedMass mass = mergedMass(robot, joint, X_JB.inverse());
      const SimTK::MobilizedBodyIndex index =
          addBody(joint.type, matter_.updMobilizedBody(parent.body), sim::toSimTK(X_PJ * X_JB),
                  SimTK::Body::Rigid(toSimTK(mass)));
      joints_.push_back(j);
      coordinates_.add(index, joint.type);
      carriers_[joint.child] = {index, X_JB.inverse()};
      bodies_.push_back(index);
      weights_.push_back({sim::toSimTK(mass.centreOfMass()), sim::toSimTK(Eigen::Vector3d(mass.mass * gravity_W))});
    }
    const std::vector<int>& below = joints_below[joint.child];
    pending.insert(pending.end(), below.rbegin(), below.rend());
  }
}

void SimbodyRobot::addFreeBody(const FreeBody& body, const Eigen::Vector3d& gravity_W) {
  MergedMass mass;
  mass.mass = body.mass.mass;
  mass.moment = body.mass.mass * body.mass.centre;
  const Eigen::Vector3d& c = body.mass.centre;
  mass.inertia = body.mass.inertia +
                 body.mass.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  const SimTK::MobilizedBodyIndex index = addBody(JointType::floating, matter_.updGround(), SimTK::Transform(),
                                                  SimTK::Body::Rigid(toSimTK(mass)));
  free_bodies_.push_back(index);
  bodies_.push_back(index);
  weights_.push_back({sim::toSimTK(c), sim::toSimTK(Eigen::Vector3d(mass.mass * gravity_W))});
}

void SimbodyRobot::gravityForces(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& forces) const {
  forces.resize(matter_.getNumBodies());
  forces.setToZero();
  for (size_t i = 0; i < bodies_.size(); ++i) {
    const SimTK::Rotation& R_WB = matter_.getMobilizedBody(bodies_[i]).getBodyRotation(state);
    const SimTK::Vec3 arm_W = R_WB * weights_[i].centre_of_mass_B;
    forces[bodies_[i]] = SimTK::SpatialVec(arm_W % weights_[i].force_W, weights_[i].force_W);
  }
}

}  // namespace tactus::sim
