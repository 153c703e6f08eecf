#pragma once

#include "framework/dynamics/external_forces.h"

/// The articulated-body algorithm, Featherstone (2008), table 7.1.
namespace tactus::dynamics {

/// Forward dynamics: q̈ = M⁻¹ (τ − b − g + Σ Jᵀ f), in time linear in the number of bodies.  gravity_W in m/s², world
/// axes.  Not for models where a joint drives another one (ForwardDynamics is for all): throws std::invalid_argument.
void aba(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& tau,
         const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& qdd,
         const ExternalForces* external = nullptr);

}  // namespace tactus::dynamics
