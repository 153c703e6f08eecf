#pragma once

#include "framework/dynamics/forward_dynamics.h"
#include "tests/dynamics/random_state.h"

namespace tactus::dynamics {

/// Lets a robot swing freely, no torque at its joints, by the classical Runge–Kutta method on q and q̇.
class FreeSwing {
 public:
  explicit FreeSwing(RandomState& state)
      : state_(state), forward_(state.model), none_(Eigen::VectorXd::Zero(state.model.dof())) {}

  void step(double h) {
    Eigen::VectorXd &q = state_.q, &qd = state_.qd;
    const Rate a = rate(q, qd), b = rate(q + h / 2 * a.q, qd + h / 2 * a.qd), c = rate(q + h / 2 * b.q, qd + h / 2 * b.qd),
               d = rate(q + h * c.q, qd + h * c.qd);
    q += h / 6 * (a.q + 2 * b.q + 2 * c.q + d.q);
    qd += h / 6 * (a.qd + 2 * b.qd + 2 * c.qd + d.qd);
    normalise(state_.model, q);
  }

 private:
  struct Rate {
    Eigen::VectorXd q, qd;
  };
  Rate rate(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    Rate r{Eigen::VectorXd(q.size()), Eigen::VectorXd(qd.size())};
    positionRates(state_.model, q, qd, r.q);
    forward_.compute(q, qd, none_, state_.gravity_W, state_.workspace, r.qd);
    return r;
  }

  RandomState& state_;
  ForwardDynamics forward_;
  Eigen::VectorXd none_;
};

}  // namespace tactus::dynamics
