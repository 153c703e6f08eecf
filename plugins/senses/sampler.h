#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/control/archive.h"

namespace tactus::plugins {

/// Numbers that are sampled at a rate and told late.
///
/// Sample k is taken in the first tick whose time is at least k/rate (k = 0, 1, …); without a rate in every tick.  At
/// time t the newest sample taken at t − delay or before is told, and held until the next one.  The first sample stands
/// for the time before it.  Times are compared to a millionth of the control period.  Takes no memory after
/// construction.
class Sampler {
 public:
  /// `rate` in Hz, 0 = every tick; `delay` and `period` of the control in s.
  Sampler(int numbers, double rate, double delay, double period);

  /// Whether a sample is to be taken now: then `take` comes before `tell`.
  bool isDue(double time) const;
  /// Where the sample of this time is written.
  Eigen::Ref<Eigen::VectorXd> take(double time);
  /// Moves on to what is told at this time; true when that is another sample than before.
  bool tell(double time);
  Eigen::Ref<const Eigen::VectorXd> told() const { return samples_.col(told_); }
  /// s, between the last sample and the one before it; 0 for the first.
  double interval() const { return interval_; }
  void archive(control::Archive& archive);

 private:
  double rate_, delay_, tolerance_;
  Eigen::MatrixXd samples_;                                        // a ring, one column a sample
  std::vector<double> times_;
  int last_ = -1;                                                  // column taken last
  int told_ = -1;
  double next_ = 0;                                                // s, when the next is due
  double interval_ = 0;
};

}  // namespace tactus::plugins
