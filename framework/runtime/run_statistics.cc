#include "framework/runtime/run_statistics.h"

#include <cmath>

namespace tactus::runtime {
namespace {

/// The larger one; not-a-number is the worst of all.
double worse(double a, double b) { return std::isnan(b) || b > a ? b : a; }

}  // namespace

void RunStatistics::observe(const ObservedTick& tick) {
  const control::TickRecord& record = tick.controller.record();
  const control::TickSolution& solution = tick.controller.solution();
  keepTime(tick.tick_us);
  if (record.unusable_task) noteUnusable(*record.unusable_task, tick.sensed.time);
  fallbacks += record.fallback;
  infeasible += record.status == control::Status::infeasible;
  limited += record.limited;
  lost_rank += solution.rank_deficient_levels > 0;
  if (!solution.has_kkt) return;
  has_kkt = true;
  kkt_max.stationarity = worse(kkt_max.stationarity, solution.kkt.stationarity);
  kkt_max.primal = worse(kkt_max.primal, solution.kkt.primal);
  kkt_max.complementarity = worse(kkt_max.complementarity, solution.kkt.complementarity);
}

void RunStatistics::keepTime(double tick_us) {
  if (ticks_++ % stride_ != 0) return;
  if (static_cast<long>(tick_us_.size()) == most_times) {
    for (size_t i = 0; 2 * i < tick_us_.size(); ++i) tick_us_[i] = tick_us_[2 * i];
    tick_us_.resize(tick_us_.size() / 2);
    stride_ *= 2;
  }
  tick_us_.push_back(tick_us);
}

void RunStatistics::noteUnusable(const std::string& task, double time) {
  for (UnusableTask& known : unusable_) {
    if (known.name != task) continue;
    ++known.ticks;
    return;
  }
  unusable_.push_back({task, time, 1});
}

}  // namespace tactus::runtime
