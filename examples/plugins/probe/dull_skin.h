#pragma once

#include "framework/control/random.h"
#include "framework/control/registry.h"

namespace probe {

/// `<probe.skin>`: a skin that feels forces in steps.  Of each contact of its links the force becomes
///
///   round((F + σ w)/r)·r,   w ~ N(0, 1),
///
/// and a contact of less than the threshold is not felt.  Ports: `force`, the sum over all its links, and `forces`, the
/// sum of each, in the order of the robot.
class DullSkin final : public tactus::control::Sensor {
 public:
  explicit DullSkin(const tactus::control::SensorContext& context);
  static void registerIn(tactus::control::Registry& registry);

  int count(const tactus::control::PortRow& port) const override;

 private:
  void doSense(const tactus::control::Sensed& truth, tactus::control::Sensed& felt,
               Eigen::Ref<Eigen::VectorXd> readings) override;
  void doArchive(tactus::control::Archive& archive) override { archive("random", random_); }

  std::vector<int> place_;                                         // by link: among `forces`, −1 for one without skin
  int links_;
  double step_;                                                    // r, N
  double noise_;                                                   // σ, N
  double threshold_;                                               // N
  tactus::control::SplitMix64 random_;
};

}  // namespace probe
