#include "framework/runtime/run_statistics.h"

#include <cmath>

#include "framework/control/element_values.h"

namespace tactus::runtime {
namespace {

/// The larger one; not-a-number is the worst of all.
double worse(double a, double b) { return std::isnan(b) || b > a ? b : a; }

void note(std::vector<Fault>& faults, const std::string& name, double time) {
  for (Fault& known : faults) {
    if (known.name != name) continue;
    ++known.ticks;
    return;
  }
  faults.push_back({name, time, 1});
}

}  // namespace

void RunStatistics::observe(const control::ObservedTick& tick) {
  const control::TickRecord& record = tick.controller.record();
  const control::TickSolution& solution = tick.controller.solution();
  keepTime(tick.tick_us);
  if (record.unusable_task) note(unusable_, *record.unusable_task, tick.sensed.time);
  noteSensing(tick);
  noteSpeeds(tick);
  fallbacks += record.fallback;
  infeasible += record.status == control::Status::infeasible;
  limited += record.limited;
  late += record.late;
  rate_limited += record.rate_limited;
  partial += record.source == control::TorqueSource::partial;
  held += record.source == control::TorqueSource::held;
  gravity += record.source == control::TorqueSource::gravity;
  blind += record.sensing.blind;
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

void RunStatistics::noteSensing(const control::ObservedTick& tick) {
  const control::SensingGuard& sensing = tick.controller.sensing();
  const dynamics::Model& model = tick.controller.model();
  if (sensing.record().joints_held > 0) {
    for (int i = 0; i < model.dof(); ++i)
      if (sensing.isLost(i)) note(lost_joints_, model.jointNames()[static_cast<size_t>(i)], tick.sensed.time);
  }
  for (const int link : sensing.ignoredLinks())
    note(ignored_contacts_, link < 0 ? "" : model.frames()[static_cast<size_t>(link)].name, tick.sensed.time);
}

void RunStatistics::noteSpeeds(const control::ObservedTick& tick) {
  const dynamics::Model& model = tick.controller.model();
  const Eigen::VectorXd& limits = model.velocityLimit();
  if (tick.truth.qd.size() != limits.size()) return;
  for (Eigen::Index i = 0; i < limits.size(); ++i)
    if (limits[i] > 0 && std::abs(tick.truth.qd[i]) > limits[i])
      note(fast_joints_, model.jointNames()[static_cast<size_t>(i)], tick.truth.time);
}

std::vector<std::string> RunStatistics::warnings() const {
  std::vector<std::string> warnings;
  const auto first = [](const Fault& fault) {
    return ", first at t = " + control::formatNumber(fault.first_time) + " s: ";
  };
  long named = late + blind;
  for (const Fault& task : unusable_) {
    named += task.ticks;
    warnings.push_back("task '" + task.name + "' gave numbers that are not finite, or too large to work with" +
                       first(task) + std::to_string(task.ticks) + " ticks fell back");
  }
  for (const Fault& joint : lost_joints_) {
    warnings.push_back("joint '" + joint.name + "' was not sensed" + first(joint) + std::to_string(joint.ticks) +
                       " ticks took its last good values, or bore the weight alone");
  }
  for (const Fault& link : ignored_contacts_) {
    warnings.push_back((link.name.empty() ? "contacts of no link" : "contacts of link '" + link.name + "'") +
                       " were no numbers" + first(link) + std::to_string(link.ticks) + " were ignored");
  }
  if (!fast_joints_.empty()) {
    const Fault& joint = fast_joints_.front();
    const std::string others = std::to_string(fast_joints_.size() - 1);
    warnings.push_back("joint '" + joint.name + "' was faster than its velocity limit" + first(joint) +
                       std::to_string(joint.ticks) + " ticks" +
                       (fast_joints_.size() > 1 ? "; and so were " + others + " more" : ""));
  }
  const std::string of_all = " of " + std::to_string(ticks_) + " ticks";
  if (late > 0) warnings.push_back("the back end missed its deadline in " + std::to_string(late) + of_all);
  if (const long others = fallbacks - named; others > 0) {
    warnings.push_back(std::to_string(others) + of_all +
                       " fell back: their problem was infeasible, or the back end failed");
  }
  return warnings;
}

}  // namespace tactus::runtime
