#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/control/archive.h"
#include "framework/control/random.h"
#include "plugins/senses/drift.h"

namespace tactus::plugins {

/// What taxels make of the forces on them, one sample after the other:
///
///   y = g (1 + γ w) f + d + σ n,   w drawn once for each taxel, n ~ N(0, 1) for each sample, d a bounded Drift;
///   y ← min(max(y, 0), range);   y ← round(y levels/range) range/levels;   y ← 0 where y < threshold, and of the dead.
///
/// A taxel cannot pull: noise around nothing is cut at 0 and leaves σ/√(2π) in the mean, unless the threshold is above
/// it.  γ w is kept within ±1.
class TaxelResponse {
 public:
  struct Options {
    double gain = 1;                                               ///< g
    double gain_spread = 0;                                        ///< γ
    double noise = 0;                                              ///< σ, N
    double drift = 0;                                              ///< N/√s
    double drift_limit = 0;                                        ///< N
    double range = 0;                                              ///< N; 0 = none
    int levels = 0;                                                ///< steps of the range; 0 = none
    double threshold = 0;                                          ///< N
    double dead = 0;                                               ///< share of taxels, rounded to whole ones
  };
  /// Draws gains and dead taxels from the seed; `dead` are dead besides.
  TaxelResponse(int taxels, const Options& options, const std::vector<int>& dead, std::uint64_t seed);

  /// `interval` in s since the last sample.
  void respond(Eigen::Ref<const Eigen::VectorXd> forces_N, double interval, Eigen::Ref<Eigen::VectorXd> values_N);
  /// Gains and dead taxels follow from the seed, and are kept all the same: a state may be restored under another.
  void archive(control::Archive& archive);
  bool isDead(int taxel) const { return dead_[static_cast<std::size_t>(taxel)]; }

 private:
  Options options_;
  control::SplitMix64 random_;
  Drift drift_;
  Eigen::VectorXd gains_, drifts_;
  std::vector<bool> dead_;
};

}  // namespace tactus::plugins
