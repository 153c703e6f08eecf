#pragma once

#include <Eigen/Core>

#include "framework/control/random.h"
#include "framework/control/registry.h"
#include "plugins/senses/drift.h"
#include "plugins/senses/sampler.h"

namespace tactus::plugins {

/// The sensor `<force-torque>`: the wrench through the joint above a link, fixed or moving.
///
/// w (6: force, moment) is what the rest of the robot does to the link and all that hangs on it, in the link's axes
/// about its origin (control::LinkWrench): a hanging mass reads m g upwards.  Each tick
///
///   x ← x + (1 − exp(−2π f_c dt)) (w − x)           a first-order filter of the cut-off f_c; x = w at first,
///
/// and each sample, component by component,
///
///
///   y = min(max(x + b + d + σ n, −range), range),   b a constant bias, n ~ N(0, 1), d a bounded Drift.
/// While the plant tells no wrench, at its very start, there is no reading.
///
/// Ports: `wrench`, and `force` and `moment`, the lengths of its halves.
class ForceTorque final : public control::Sensor {
 public:
  explicit ForceTorque(const control::SensorContext& context);
  static void registerIn(control::Registry& registry);

  std::vector<int> wrenchLinks() const override { return {link_}; }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;

  struct Half {                                                    // of the wrench
    Eigen::Vector3d bias;
    double noise;
    Drift drift;
    double range;
  };
  static Half half(const control::ElementValues& values, const std::string& which);
  void doSense(const control::Sensed& truth, control::Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) override;
  void doArchive(control::Archive& archive) override;

  int link_;
  Half halves_[2];
  double cutoff_;                                                  // Hz, 0 = no filter
  Sampler sampler_;
  control::SplitMix64 random_;
  Vector6 filtered_ = Vector6::Zero(), drift_ = Vector6::Zero();
  double last_time_ = 0;
  bool started_ = false;
};

}  // namespace tactus::plugins
