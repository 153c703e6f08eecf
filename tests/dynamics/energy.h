#pragma once

#include "framework/dynamics/kinematics.h"

/// Energies summed over the links and rotors of the description, with nothing of the model but frames: an oracle for
/// the merging of links and for the algorithms.
namespace tactus::dynamics {

/// After forwardVelocities.  A rotor is a disk that turns with the link it is fixed to.
inline double kineticEnergy(const description::Robot& robot, const Model& model, const Workspace& workspace) {
  double energy = 0;
  for (size_t i = 0; i < robot.links.size(); ++i) {
    const description::Link& link = robot.links[i];
    if (!link.has_inertial) continue;
    const int frame = static_cast<int>(i);
    const Eigen::Isometry3d X_WF = framePose(model, workspace, frame);
    const Eigen::Vector3d v = pointVelocity(model, workspace, frame, X_WF * link.centre_of_mass);
    const Eigen::Vector3d w_F = X_WF.linear().transpose() * frameVelocity(model, workspace, frame).tail<3>();
    energy += 0.5 * link.mass * v.squaredNorm() + 0.5 * w_F.dot(link.inertia * w_F);
  }
  for (const description::Joint& joint : robot.joints) {
    if (joint.type == description::JointType::fixed) continue;
    const Eigen::Isometry3d X_WF = framePose(model, workspace, joint.child);
    const Eigen::Vector3d w_F = X_WF.linear().transpose() * frameVelocity(model, workspace, joint.child).tail<3>();
    const double along = joint.axis.dot(w_F);
    energy += 0.5 * joint.reflectedInertia() * (along * along + 0.5 * (w_F.squaredNorm() - along * along));
  }
  return energy;
}

/// After forwardKinematics.
inline double potentialEnergy(const description::Robot& robot, const Model& model, const Workspace& workspace,
                              const Eigen::Vector3d& gravity_W) {
  double energy = 0;
  for (size_t i = 0; i < robot.links.size(); ++i) {
    const description::Link& link = robot.links[i];
    if (!link.has_inertial) continue;
    energy -= link.mass * gravity_W.dot(framePose(model, workspace, static_cast<int>(i)) * link.centre_of_mass);
  }
  return energy;
}

}  // namespace tactus::dynamics
