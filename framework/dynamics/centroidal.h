#pragma once

#include "framework/dynamics/kinematics.h"

/// The robot as one body: mass, centre of mass C, momentum about C (Orin, Goswami & Lee 2013), energy.  Links fixed to
/// the base do not count: they never move.  World axes, linear rows first.
namespace tactus::dynamics {

double mass(const Model& model);                                   ///< kg

// After compositeInertias.

Eigen::Vector3d centreOfMass(const Model& model, const Workspace& workspace);
/// v_C = J q̇.  3 × dof, overwritten.
void centreOfMassJacobian(const Model& model, const Workspace& workspace, PointJacobianRef J);
/// A_G with momentum about C = A_G q̇.  6 × dof, overwritten.
void momentumMatrix(const Model& model, const Workspace& workspace, FrameJacobianRef A);

// After forwardVelocities, and compositeInertias for those about C.

Eigen::Vector3d centreOfMassVelocity(const Model& model, const Workspace& workspace);
/// J̇ q̇.
Eigen::Vector3d centreOfMassAccelerationBias(const Model& model, const Workspace& workspace);
/// Momentum about C: linear, angular.
Vector6d momentum(const Model& model, const Workspace& workspace);
/// Ȧ_G q̇: its rate when q̈ = 0.
Vector6d momentumRateBias(const Model& model, const Workspace& workspace);
/// ½ q̇ᵀ M q̇, J.  After worldInertias.
double kineticEnergy(const Model& model, const Workspace& workspace);
/// −Σ m g·c, J: zero with all masses at the world origin.
double potentialEnergy(const Model& model, const Workspace& workspace, const Eigen::Vector3d& gravity_W);

}  // namespace tactus::dynamics
