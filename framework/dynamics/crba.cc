#include "framework/dynamics/crba.h"

namespace tactus::dynamics {
namespace {

/// M = Gᵀ M_tree G: several bodies add to one coordinate.
void coupledMassMatrixSweep(const Model& model, const Workspace& workspace, Eigen::MatrixXd& M) {
  M.setZero();
  for (int j = 0; j < model.bodyCount(); ++j) {
    const int column = model.bodies()[j].coordinate;
    for (int i = j; i < model.subtreeEnd(j); ++i) {
      const int row = model.bodies()[i].coordinate;
      const double entry = workspace.bodies[j].axis.dot(workspace.composite_forces[i]);
      M(row, column) += entry;
      if (i != j) M(column, row) += entry;
    }
  }
}

}  // namespace

void compositeInertias(const Model& model, Workspace& workspace) {
  for (BodyState& state : workspace.bodies) state.composite = state.inertia;
  for (int i = model.bodyCount() - 1; i >= 0; --i) {
    const int parent = model.parent(i);
    if (parent >= 0) workspace.bodies[parent].composite += workspace.bodies[i].composite;
  }
}

void massMatrixSweep(const Model& model, Workspace& workspace, Eigen::MatrixXd& M) {
  for (int i = 0; i < model.bodyCount(); ++i) {
    workspace.composite_forces[i] = workspace.bodies[i].composite * workspace.bodies[i].axis;
  }
  if (model.coupled()) return coupledMassMatrixSweep(model, workspace, M);
  // M_ij = S_jᵀ Iᶜ_i S_i for all i in the subtree of j, which is one stretch of column j.
  for (int j = 0; j < model.dof(); ++j) {
    const MotionVector S = workspace.bodies[j].axis;
    for (int i = j; i < model.subtreeEnd(j); ++i) M(i, j) = M(j, i) = S.dot(workspace.composite_forces[i]);
  }
}

void crba(const Model& model, const Eigen::VectorXd& q, Workspace& workspace, Eigen::MatrixXd& M) {
  forwardKinematics(model, q, workspace);
  worldInertias(model, workspace);
  compositeInertias(model, workspace);
  M.setZero();
  massMatrixSweep(model, workspace, M);
}

}  // namespace tactus::dynamics
