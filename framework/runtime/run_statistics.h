#pragma once

#include <vector>

#include "framework/runtime/observer.h"

namespace tactus::runtime {

/// How the controller fared over a run: ticks that went another way than the plain one, and its wall-clock times.
class RunStatistics final : public Observer {
 public:
  explicit RunStatistics(long expected_ticks) { tick_us_.reserve(static_cast<size_t>(expected_ticks)); }

  void observe(const ObservedTick& tick) override;

  long ticks() const { return static_cast<long>(tick_us_.size()); }
  const std::vector<double>& tickTimes() const { return tick_us_; }  ///< µs

  long fallbacks = 0;                                              ///< the back end failed; another torque was held
  long infeasible = 0;
  long limited = 0;                                                ///< the torque was cut to the actuators' limits
  long lost_rank = 0;                                              ///< a level's rows were dependent or faded
  bool has_kkt = false;
  control::KktResidual kkt_max;                                    ///< worst of the run, each of its own tick

 private:
  std::vector<double> tick_us_;
};

}  // namespace tactus::runtime
