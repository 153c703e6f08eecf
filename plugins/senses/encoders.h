#pragma once

#include <vector>

#include "framework/control/random.h"
#include "framework/control/registry.h"
#include "plugins/senses/sampler.h"

namespace tactus::plugins {

/// The sensor `<encoders>`: joint positions as encoders tell them, and velocities from their differences.  Of each joint,
/// sample k being h seconds after the one before,
///
///   q̂_k = round((q + σ n)/r)·r,   n ~ N(0, 1),
///   v_k = v_{k−1} + (1 − exp(−2π f_c h)) ((q̂_k − q̂_{k−1})/h − v_{k−1}),   v_0 = 0,
///
/// r the resolution, f_c the cut-off of the velocity's first-order filter (0 = plain differences).  Both take the place
/// of q and q̇ in `felt`.  A step of one resolution shows in plain differences as r/h: 1e-5 rad at 1 kHz are 0.01 rad/s.
///
/// Port: `positions`, q̂ of its joints in the order of q.
class Encoders final : public control::Sensor {
 public:
  explicit Encoders(const control::SensorContext& context);
  static void registerIn(control::Registry& registry);

  int count(const control::PortRow&) const override { return static_cast<int>(joints_.size()); }

 private:
  void doSense(const control::Sensed& truth, control::Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) override;
  void doArchive(control::Archive& archive) override;

  std::vector<int> joints_;                                        // indices into q
  double resolution_, noise_, cutoff_;
  Sampler sampler_;                                                // positions, then velocities
  control::SplitMix64 random_;
  Eigen::VectorXd last_, velocity_;
  bool started_ = false;
};

}  // namespace tactus::plugins
