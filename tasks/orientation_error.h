#pragma once

#include <Eigen/Geometry>

namespace tactus::tasks {

/// Rotation that takes R_WE to the reference R_WR as an angle-axis vector (rad) in world axes.  A.1.7 takes it from
/// R_WEᵀ R_WR, which is in the end effector's frame; it must be turned into the frame of J before it meets Jᵀ.
inline Eigen::Vector3d orientationError(const Eigen::Matrix3d& R_WE, const Eigen::Matrix3d& R_WR) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(R_WE.transpose() * R_WR));
  return R_WE * (turn.angle() * turn.axis());
}

}  // namespace tactus::tasks
