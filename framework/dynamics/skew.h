#pragma once

#include <Eigen/Core>

namespace tactus::dynamics {

/// The matrix of a ×.
inline Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

}  // namespace tactus::dynamics
