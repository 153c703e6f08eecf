#pragma once

#include "framework/dynamics/model.h"

/// The space of configurations: q has quaternions, q̇ has angular velocities (description::JointType), and these
/// functions stand for the sums and differences that other coordinates allow.  Vectors: q of positionCount(), v of dof().
namespace tactus::dynamics {

/// q ⊕ v: where the rates v, kept constant in their own axes for a unit of time, lead.  Exact for every joint:
/// quaternions move by the exponential map, and come out with unit length.  `to` may be q itself.
void integrate(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& to);

/// v = to ⊖ from, with from ⊕ v = to; of the two ways round, the one of at most π.
void difference(const Model& model, const Eigen::VectorXd& from, const Eigen::VectorXd& to, Eigen::VectorXd& v);

/// dq/dt of positionCount(): what an integrator of q needs.  A quaternion's is ½ q ⊗ (0, ω).
void positionRates(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& rates);

/// Brings every quaternion back to unit length; one of length zero, or not finite, becomes "not turned".
void normalise(const Model& model, Eigen::VectorXd& q);

}  // namespace tactus::dynamics
