#include "framework/dynamics/crba.h"

namespace tactus::dynamics {

void compositeInertias(const Model& model, Workspace& workspace) {
  for (BodyState& state : workspace.bodies) state.composite = state.inertia;
  for (int i = model.dof() - 1; i >= 0; --i) {
    const int parent = model.parent(i);
    if (parent >= 0) workspace.bodies[parent].composite += workspace.bodies[i].composite;
  }
}

void massMatrixSweep(const Model& model, const Workspace& workspace, Eigen::MatrixXd& M) {
  for (int i = 0; i < model.dof(); ++i) {
    const BodyState& state = workspace.bodies[i];
    const ForceVector F = state.composite * state.axis;
    M(i, i) = state.axis.dot(F);
    for (int j = model.parent(i); j >= 0; j = model.parent(j)) {
      M(i, j) = M(j, i) = workspace.bodies[j].axis.dot(F);
    }
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
