#pragma once

#include "framework/control/registry.h"

/// `<@NAME@.reach>`: a spring with a bounded force pulls a link to a target, and a damper brakes it.
///
/// Three equality rows.  With x the origin of the link (m, world axes), x_t the target and ẋ = J q̇ its velocity,
///
///   J = ∂x/∂q                          3 × dof, m/rad
///   F = sat(k (x_t − x)) − d ẋ         N, world axes; Tactus makes τ = JᵀF of it
///
/// where sat shortens the spring's force to `max-force` and keeps its direction.  Near the target this is a spring and
/// damper, far away a steady pull; with d > 0 it only ever takes energy out, so the arm comes to rest.
class Reach final : public tactus::control::Task {
 public:
  explicit Reach(const tactus::control::BuildContext& context);
  static void registerIn(tactus::control::Registry& registry);

  bool displacement(const tactus::dynamics::DynamicsCache& from, const tactus::dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;
  void columns(std::vector<tactus::control::LogColumn>& columns) const override;

 private:
  void doUpdate(const tactus::control::Tick& tick, tactus::control::TickTask& rows) override;

  int frame_;                                                      // of the robot, from the link's name
  Eigen::Vector3d target_W_;                                       // m
  double stiffness_, damping_, max_force_;
  double pull_N_ = 0;                                              // of the spring, for the log
};
