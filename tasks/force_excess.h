#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "framework/control/archive.h"

namespace tactus::tasks {

/// LP(f − f_t)₊ of the contacts of each frame: by how much the measured force exceeds a threshold, through a first-order
/// filter.  A frame that is not measured in a tick starts from zero again.
class ForceExcess {
 public:
  ForceExcess(double threshold_N, double time_constant_s, std::size_t frames)
      : threshold_(threshold_N), time_constant_(time_constant_s), excess_(frames, 0.0), measured_(frames, 0) {}

  void beginTick() { std::fill(measured_.begin(), measured_.end(), 0); }
  /// The filtered excess (N) after this tick's measured force.
  double measure(int frame, double force_N, double dt) {
    measured_[frame] = 1;
    const double blend = dt / (time_constant_ + dt);
    excess_[frame] += blend * (std::max(force_N - threshold_, 0.0) - excess_[frame]);
    return excess_[frame];
  }
  void endTick() {
    for (std::size_t frame = 0; frame < excess_.size(); ++frame) {
      if (!measured_[frame]) excess_[frame] = 0;
    }
  }
  void archive(control::Archive& archive) { archive("excess", excess_); }

 private:
  double threshold_, time_constant_;
  std::vector<double> excess_;                                     ///< by frame, N
  std::vector<char> measured_;                                     ///< by frame, this tick
};

}  // namespace tactus::tasks
