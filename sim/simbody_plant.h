#pragma once

#include <memory>
#include <string>

#include "framework/description/robot.h"
#include "framework/description/scene.h"
#include "framework/runtime/plant.h"

namespace tactus::sim {

struct PlantOptions {
  double step = 0.25e-3;                                           ///< s, semi-explicit Euler
  double velocity_limit = 100;                                     ///< rad/s or m/s; beyond it the state is a runaway
};

/// The robot in its scene, simulated by Simbody with Tactus's own contact force (see contact_force.h).
/// Built from the description alone: nothing of framework/dynamics is used.
class SimbodyPlant final : public runtime::Plant {
 public:
  /// Throws runtime::PlantError when the robot has moving links without mass or Simbody refuses it.
  SimbodyPlant(const description::Robot& robot, const description::Scene& scene, const Eigen::VectorXd& start_q,
               const PlantOptions& options = {});
  ~SimbodyPlant() override;

  const control::Sensed& sense() const override;
  void advance(const Eigen::VectorXd& torque, double duration) override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tactus::sim
