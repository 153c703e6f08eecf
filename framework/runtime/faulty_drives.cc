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
    : plant_(std::move(plant)), rounding_(1e-6 * period), applied_(Eigen::VectorXd::Zero(plant_->truth().qd.size())) {
  for (TorqueFault& asked : faults) {
    Fault& fault = faults_.emplace_back();
    fault.asked = std::move(asked);
    fault.record = {fault.asked.name, elementOf(fault.asked.kind)};
    fault.kept = applied_;
    if (fault.asked.kind == TorqueFaultKind::delay)
      fault.past.assign(static_cast<std::size_t>(std::lround(fault.asked.delay / period)) + 1, applied_);
  }
  noteFaults();
}

void FaultyDrives::faults(std::vector<const control::FaultRecord*>& records) const {
  for (const Fault& fault : faults_) records.push_back(&fault.record);
  plant_->faults(records);
}

void FaultyDrives::advance(const Eigen::VectorXd& torque, double duration) {
  if (faults_.empty() || torque.size() != applied_.size()) return plant_->advance(torque, duration);
  applied_ = torque;
  for (Fault& fault : faults_) strike(fault);
  plant_->advance(applied_, duration);
  noteFaults();
}

void FaultyDrives::archive(control::Archive& archive) {
  for (Fault& fault : faults_) archive.within("drives/" + fault.record.name, [&] { fault.archive(archive); });
  plant_->archive(archive);
  if (archive.restores()) noteFaults();                            // of faults that the state does not know
}

void FaultyDrives::Fault::archive(control::Archive& archive) {
  archive("record", record);
  archive.finite("kept", kept);
  archive("past", past);
  for (const Eigen::VectorXd& torque : past)
    if (!torque.allFinite()) throw control::StateError("a torque that is under way in the state is not finite");
  archive("ticks", ticks);
}

void FaultyDrives::noteFaults() {
  const double time = plant_->truth().time;
  for (Fault& fault : faults_) fault.record.note(time, fault.asked.window.holds(time, rounding_));
}

void FaultyDrives::strike(Fault& fault) {
  const bool active = fault.record.strikes;
  const std::size_t tick = fault.ticks++;
  const auto take = [&](const Eigen::VectorXd& from) {
    for (const int joint : fault.asked.joints) applied_[joint] = from[joint];
  };
  switch (fault.asked.kind) {
    case TorqueFaultKind::loss:
      if (!active) return;
      for (const int joint : fault.asked.joints) applied_[joint] *= fault.asked.factor;
      return;
    case TorqueFaultKind::stuck:
      if (active && tick > 0) return take(fault.kept);
      fault.kept = applied_;
      return;
    case TorqueFaultKind::delay: {
      const std::size_t size = fault.past.size();
      fault.past[tick % size] = applied_;
      if (active) take(fault.past[tick >= size ? (tick + 1) % size : 0]);
      return;
    }
  }
}

}  // namespace tactus::runtime
