#pragma once

#include <Eigen/Core>

#include "framework/control/archive.h"

namespace tactus::control {

/// The last stage of a tick: from the torque τ* that is wanted to the one that is applied,
///
///   τ = clip(τ* + s Δ),   |τ| ≤ effort,   |τ − τ_before| ≤ rate · effort · dt,  joint by joint.
///
/// The actuators' limits always win; the rate comes next, and both win over the laws of the levels: where they cut, a
/// lower level may disturb a higher one.
///
/// Δ is a *transfer*.  When tasks, weights or back ends are switched, τ* steps; Δ is what it stepped by, τ_before − τ*,
/// so that τ goes on from where it was, and s falls from 1 to 0 over a ramp.  A transfer that begins while another one
/// runs takes over what is left of it.  The first torque of all is free: there is none before it.
class TorqueShaper {
 public:
  /// `effort` N m, ≥ 0, may be infinite; `rate` 1/s, of the effort, infinity for none; `period` s.
  TorqueShaper(const Eigen::VectorXd& effort, double rate, double period);

  /// From the next `apply` on, over `ramp` seconds; 0: at once, as far as the rate lets it.
  void startTransfer(double ramp);
  /// `wanted`: N m, dof, finite.
  void apply(const Eigen::VectorXd& wanted);

  const Eigen::VectorXd& torque() const { return torque_; }        ///< as last applied; 0 before
  bool limited() const { return limited_; }                        ///< cut into the actuators' limits
  bool rateLimited() const { return rate_limited_; }
  bool transfers() const { return left_ > 0; }
  void archive(Archive& archive);

 private:
  Eigen::VectorXd effort_;
  Eigen::VectorXd step_;                                           // N m, the most that a tick may change
  double period_;
  Eigen::VectorXd torque_;
  Eigen::VectorXd difference_;                                     // Δ
  double ramp_ = 0;                                                // s, of the running transfer
  double left_ = 0;                                                // s, of it
  bool begins_ = false;
  bool has_torque_ = false;
  bool limited_ = false;
  bool rate_limited_ = false;
};

}  // namespace tactus::control
