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
  tick_us_.push_back(tick.tick_us);
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

}  // namespace tactus::runtime
