#include "framework/runtime/faulty_drives.h"

#include <cmath>

namespace tactus::runtime {
namespace {

using description::TorqueFault;
using description::TorqueFaultKind;

const char* elementOf(TorqueFaultKind kind) {
  switch (kind) {
    case TorqueFaultKind::loss: return "torque-loss";
    case TorqueFaultKind::stuck: return "torque-stuck";
    case TorqueFaultKind::delay: return "torque-delay";
  }
  return "";
}

}  // namespace

FaultyDrives::FaultyDrives(std::unique_ptr<Plant> plant, std::vector<TorqueFault> faults, double period)
    : plant_(std::move(plant)), faults_(std::move(faults)), rounding_(1e-6 * period) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(plant_->truth().qd.size());
  state_.applied = none;
  for (const TorqueFault& fault : faults_) {
    const bool late = fault.kind == TorqueFaultKind::delay;
    state_.records.push_back({fault.name, elementOf(fault.kind)});
    state_.kept.push_back(none);
    state_.past.emplace_back(late ? static_cast<std::size_t>(std::lround(fault.delay / period)) + 1 : 0, none);
  }
  noteFaults();
}

void FaultyDrives::faults(std::vector<const control::FaultRecord*>& records) const {
  for (const control::FaultRecord& record : state_.records) records.push_back(&record);
  plant_->faults(records);
}

void FaultyDrives::advance(const Eigen::VectorXd& torque, double duration) {
  if (faults_.empty() || torque.size() != state_.applied.size()) return plant_->advance(torque, duration);
  state_.applied = torque;
  for (std::size_t i = 0; i < faults_.size(); ++i) strike(i, state_.records[i].strikes);
  ++state_.ticks;
  plant_->advance(state_.applied, duration);
  noteFaults();
}

void FaultyDrives::noteFaults() {
  const double time = plant_->truth().time;
  for (std::size_t i = 0; i < faults_.size(); ++i)
    state_.records[i].note(time, faults_[i].window.holds(time, rounding_));
}

void FaultyDrives::strike(std::size_t fault, bool active) {
  const TorqueFault& asked = faults_[fault];
  Eigen::VectorXd& torque = state_.applied;
  const auto take = [&](const Eigen::VectorXd& from) {
    for (const int joint : asked.joints) torque[joint] = from[joint];
  };
  switch (asked.kind) {
    case TorqueFaultKind::loss:
      if (!active) return;
      for (const int joint : asked.joints) torque[joint] *= asked.factor;
      return;
    case TorqueFaultKind::stuck:
      if (active && state_.ticks > 0) return take(state_.kept[fault]);
      state_.kept[fault] = torque;
      return;
    case TorqueFaultKind::delay: {
      std::vector<Eigen::VectorXd>& past = state_.past[fault];
      const std::size_t tick = static_cast<std::size_t>(state_.ticks), size = past.size();
      past[tick % size] = torque;
      if (active) take(past[tick >= size ? (tick + 1) % size : 0]);
      return;
    }
  }
}

}  // namespace tactus::runtime
