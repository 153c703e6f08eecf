#include "framework/control/torque_scaling.h"

#include <algorithm>

namespace tactus::control {

TorqueScaling scaleIntoLimits(const TorqueLimits& limits, Eigen::VectorXd& torque) {
  double least = 0;
  double most = 1;
  for (int i = 0; i < torque.size(); ++i) {
    const double t = torque[i];
    const double lower = limits.lower[i];
    const double upper = limits.upper[i];
    // lower ≤ s t ≤ upper
    if (t > 0) {
      if (t > upper) most = std::min(most, upper / t);
      if (lower > 0) least = std::max(least, lower / t);
    } else if (t < 0) {
      if (t < lower) most = std::min(most, lower / t);
      if (upper < 0) least = std::max(least, upper / t);
    } else if (lower > 0 || upper < 0) {
      most = -1;
    }
  }
  TorqueScaling scaling;
  if (least <= most) {
    scaling.scale = most;
    torque *= most;
    // Rounding must not carry a torque past a limit that it was scaled onto.
    if (most < 1) torque = torque.cwiseMax(limits.lower).cwiseMin(limits.upper);
  } else {
    scaling.possible = false;
    torque = torque.cwiseMax(limits.lower).cwiseMin(limits.upper);
  }
  return scaling;
}

}  // namespace tactus::control
