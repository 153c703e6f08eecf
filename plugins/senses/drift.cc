#include "plugins/senses/drift.h"

#include <algorithm>
#include <cmath>

namespace tactus::plugins {

double Drift::next(double d, double dt, control::SplitMix64& random) const {
  if (isOff()) return 0;
  d += rate_ * std::sqrt(dt) * random.normal();
  if (d > limit_) d = 2 * limit_ - d;
  if (d < -limit_) d = -2 * limit_ - d;
  return std::clamp(d, -limit_, limit_);                           // of a step that is longer than the range
}

}  // namespace tactus::plugins
