#pragma once

#include <Eigen/Geometry>

#include "framework/dynamics/dynamics_cache.h"

/// How far things fixed to a link move from one state of the robot to another: what Task::displacement is made of.
namespace tactus::control {

/// Of the point of `frame` that was at `point_W` in the state `from`; m, world axes.
/// To first order pointJacobian · Δq.
inline Eigen::Vector3d pointDisplacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                                         int frame, const Eigen::Vector3d& point_W) {
  return to.framePose(frame) * (from.framePose(frame).inverse() * point_W) - point_W;
}

/// Of the frame: its origin (m), then its turn as angle-axis (rad), world axes.  To first order frameJacobian · Δq.
inline dynamics::Vector6d frameDisplacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                                            int frame) {
  const Eigen::Isometry3d X_from = from.framePose(frame), X_to = to.framePose(frame);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(X_to.linear() * X_from.linear().transpose()));
  dynamics::Vector6d moved;
  moved << X_to.translation() - X_from.translation(), turn.angle() * turn.axis();
  return moved;
}

}  // namespace tactus::control
