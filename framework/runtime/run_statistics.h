#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "framework/runtime/observer.h"

namespace tactus::runtime {

/// A task whose numbers made ticks fall back.
struct UnusableTask {
  std::string name;
  double first_time = 0;                                           ///< s
  long ticks = 0;
};

/// How the controller fared over a run: ticks that went another way than the plain one, and its wall-clock times.
class RunStatistics final : public Observer {
 public:
  /// Wall-clock times that are kept at most, whatever the length of the run.
  static constexpr long most_times = 1 << 21;

  explicit RunStatistics(long expected_ticks) {
    tick_us_.reserve(static_cast<size_t>(std::clamp(expected_ticks, 0L, most_times)));
  }

  void observe(const ObservedTick& tick) override;

  long ticks() const { return ticks_; }
  /// µs, of every tick; of every 2nd, 4th, … in a run that is longer than `most_times`.
  const std::vector<double>& tickTimes() const { return tick_us_; }
  const std::vector<UnusableTask>& unusableTasks() const { return unusable_; }

  long fallbacks = 0;                                              ///< the back end failed; another torque was held
  long infeasible = 0;
  long limited = 0;                                                ///< the torque was scaled or cut into its limits
  long lost_rank = 0;                                              ///< a level's rows were dependent or faded
  bool has_kkt = false;
  control::KktResidual kkt_max;                                    ///< worst of the run, each of its own tick

 private:
  void keepTime(double tick_us);
  void noteUnusable(const std::string& task, double time);

  long ticks_ = 0;
  long stride_ = 1;                                                ///< every how many-th time is kept
  std::vector<double> tick_us_;
  std::vector<UnusableTask> unusable_;
};

}  // namespace tactus::runtime
