#pragma once

#include <Eigen/Core>

#include "framework/control/tick_problem.h"

namespace tactus::control {

struct TorqueScaling {
  double scale = 1;                                                ///< applied factor, 0 to 1
  bool possible = true;                                            ///< false: not even 0 lies within the limits
};

/// Scales a torque uniformly by the largest factor in [0, 1] that brings it within the limits.  Where no factor
/// does, because the limits leave out 0, each joint is cut to its own limits and `possible` is false.
TorqueScaling scaleIntoLimits(const TorqueLimits& limits, Eigen::VectorXd& torque);

}  // namespace tactus::control
