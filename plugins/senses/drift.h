#pragma once

#include "framework/control/random.h"

namespace tactus::plugins {

/// A slow error that stays bounded: a random walk between −limit and +limit, thrown back at both ends.
///
///   d ← reflect(d + rate √dt w),   w ~ N(0, 1),   d = 0 at first.
///
/// In the long run it is uniform in its range.
class Drift {
 public:
  /// `rate` in units per √s, `limit` in units.
  Drift(double rate, double limit) : rate_(rate), limit_(limit) {}

  bool isOff() const { return rate_ <= 0 || limit_ <= 0; }
  /// One step of dt seconds from d.
  double next(double d, double dt, control::SplitMix64& random) const;

 private:
  double rate_, limit_;
};

}  // namespace tactus::plugins
