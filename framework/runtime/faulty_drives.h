#pragma once

#include <memory>
#include <vector>

#include "framework/description/faults.h"
#include "framework/runtime/plant.h"

namespace tactus::runtime {

/// A plant whose drives go wrong: the torque τ that the controller wants goes through the faults in their order, each
/// from its `from` on and before its `until`, for its joints j:
///
/// | kind  | τ_j becomes                                                                                    |
/// |-------|------------------------------------------------------------------------------------------------|
/// | loss  | factor · τ_j                                                                                   |
/// | stuck | what it was in the tick before `from`; in the first tick, what it is then                      |
/// | delay | what it was `delay` before; at the start of a run, what it was in the first tick               |
///
/// What reaches the joints was wanted once, or is less: it stays finite and within the actuators' limits.
class FaultyDrives final : public Plant {
 public:
  /// `period` is that of the ticks, s.
  FaultyDrives(std::unique_ptr<Plant> plant, std::vector<description::TorqueFault> faults, double period);

  const control::Sensed& sense() const override { return plant_->sense(); }
  const control::Sensed& truth() const override { return plant_->truth(); }
  std::span<const control::ObjectMotion> objects() const override { return plant_->objects(); }
  /// Those of the drives, then those of the plant.
  void faults(std::vector<const control::FaultRecord*>& records) const override;
  void advance(const Eigen::VectorXd& torque, double duration) override;
  void archive(control::Archive& archive) override;

 private:
  struct Fault {
    description::TorqueFault asked;
    control::FaultRecord record;
    Eigen::VectorXd kept;                                          // of what sticks: the torque of its last good tick
    std::vector<Eigen::VectorXd> past;                             // of a delay: a ring, one entry a tick
    std::size_t ticks = 0;
    void archive(control::Archive& archive);
  };

  void noteFaults();
  void strike(Fault& fault);

  std::unique_ptr<Plant> plant_;
  std::vector<Fault> faults_;
  double rounding_;                                                // s
  Eigen::VectorXd applied_;
};

}  // namespace tactus::runtime
