#pragma once

#include "framework/dynamics/external_forces.h"

/// The recursive Newton–Euler algorithm, Featherstone (2008), table 5.1, and what follows from it.
/// gravity_W is the free-fall acceleration in world axes, m/s².
namespace tactus::dynamics {

/// Inverse dynamics: τ = M q̈ + b(q, q̇) + g(q) − Σ Jᵀ f over the external forces.
void rnea(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
          const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& tau,
          const ExternalForces* external = nullptr);

/// b + g: inverse dynamics with q̈ = 0.
void nonlinearEffects(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                      const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& bias,
                      const ExternalForces* external = nullptr);

/// g: the torque that holds the robot still.
void gravityTorque(const Model& model, const Eigen::VectorXd& q, const Eigen::Vector3d& gravity_W,
                   Workspace& workspace, Eigen::VectorXd& torque);

// The same as sweeps, for those who share the kinematics.

/// b + g.  After forwardVelocities and worldInertias.
void biasSweep(const Model& model, const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& bias);
/// g.  After compositeInertias.
void gravitySweep(const Model& model, const Eigen::Vector3d& gravity_W, const Workspace& workspace,
                  Eigen::VectorXd& torque);

}  // namespace tactus::dynamics
