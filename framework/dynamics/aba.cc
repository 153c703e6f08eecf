#include "framework/dynamics/aba.h"

namespace tactus::dynamics {

void aba(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& tau,
         const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& qdd) {
  forwardKinematics(model, q, workspace);
  forwardVelocities(model, qd, workspace);
  worldInertias(model, workspace);
  for (BodyState& state : workspace.bodies) {
    state.articulated = state.inertia.matrix();
    state.articulated_bias = state.velocity.cross(state.inertia * state.velocity);
  }

  // The velocity-product acceleration c_i = v_i × S_i q̇_i is what bias_acceleration gained from parent to child.
  const auto velocityProduct = [&](int i) {
    const int parent = model.parent(i);
    return parent < 0 ? MotionVector::Zero()
                      : workspace.bodies[parent].velocity.cross(workspace.bodies[i].axis * qd[i]);
  };

  for (int i = model.dof() - 1; i >= 0; --i) {
    BodyState& state = workspace.bodies[i];
    state.axis_force.coordinates.noalias() = state.articulated * state.axis.coordinates;
    state.axis_inertia = state.axis.dot(state.axis_force);
    state.axis_torque = tau[i] - state.axis.dot(state.articulated_bias);
    const int parent = model.parent(i);
    if (parent < 0) continue;
    BodyState& before = workspace.bodies[parent];
    const Vector6d& U = state.axis_force.coordinates;
    const Vector6d U_by_D = U / state.axis_inertia;
    state.articulated.noalias() -= U * U_by_D.transpose();         // Iᵃ, (7.45)
    before.articulated += state.articulated;
    before.articulated_bias.coordinates += state.articulated_bias.coordinates +
                                           state.articulated * velocityProduct(i).coordinates +
                                           U_by_D * state.axis_torque;
  }

  const MotionVector base(-gravity_W, Eigen::Vector3d::Zero());
  for (int i = 0; i < model.dof(); ++i) {
    BodyState& state = workspace.bodies[i];
    const int parent = model.parent(i);
    const MotionVector a = (parent < 0 ? base : workspace.bodies[parent].acceleration) + velocityProduct(i);
    qdd[i] = (state.axis_torque - a.dot(state.axis_force)) / state.axis_inertia;
    state.acceleration = a + state.axis * qdd[i];
  }
}

}  // namespace tactus::dynamics
