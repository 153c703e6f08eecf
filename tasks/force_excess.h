#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "framework/control/archive.h"
#include "framework/control/contact_set.h"

namespace tactus::tasks {

/// LP(f − f_t)₊ of each contact of a set: by how much the measured force exceeds a threshold, through a first-order
/// filter.  A contact that is not measured in a tick starts from zero again.
class ForceExcess {
 public:
  ForceExcess(double threshold_N, double time_constant_s, std::size_t frames, const control::ContactSet& contacts)
      : threshold_(threshold_N),
        time_constant_(time_constant_s),
        per_link_(contacts.per_link),
        excess_(frames * static_cast<std::size_t>(per_link_), 0.0),
        measured_(excess_.size(), 0) {}

  void beginTick() { std::fill(measured_.begin(), measured_.end(), 0); }
  /// The filtered excess (N) after this tick's measured force.
  double measure(const control::Contact& contact, double dt) {
    const auto i = static_cast<std::size_t>(contact.frame * per_link_ + contact.number);
    measured_[i] = 1;
    const double blend = dt / (time_constant_ + dt);
    excess_[i] += blend * (std::max(contact.force_N - threshold_, 0.0) - excess_[i]);
    return excess_[i];
  }
  void endTick() {
    for (std::size_t i = 0; i < excess_.size(); ++i) {
      if (!measured_[i]) excess_[i] = 0;
    }
  }
  void archive(control::Archive& archive) { archive("excess", excess_); }

 private:
  double threshold_, time_constant_;
  int per_link_;
  std::vector<double> excess_;                                     ///< by frame and number, N
  std::vector<char> measured_;                                     ///< likewise, this tick
};

}  // namespace tactus::tasks
