#pragma once

#include "framework/dynamics/kinematics.h"

/// The composite-rigid-body algorithm, Featherstone (2008), table 6.2.
namespace tactus::dynamics {

/// Mass matrix M, dof × dof, full symmetric.
void crba(const Model& model, const Eigen::VectorXd& q, Workspace& workspace, Eigen::MatrixXd& M);

// The same as sweeps, for those who share the kinematics.

/// Inertia of every subtree: composite.  After worldInertias.
void compositeInertias(const Model& model, Workspace& workspace);
/// Writes the entries of M that can be other than zero: joints on one path from the base.  After compositeInertias.
void massMatrixSweep(const Model& model, Workspace& workspace, Eigen::MatrixXd& M);

}  // namespace tactus::dynamics
