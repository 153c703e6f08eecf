#include "framework/dynamics/aba.h"

#include <stdexcept>

namespace tactus::dynamics {

void aba(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& tau,
         const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& qdd,
         const ExternalForces* external) {
  if (model.coupled()) throw std::invalid_argument("aba: a joint drives another one; use ForwardDynamics");
  forwardKinematics(model, q, workspace);
  forwardVelocities(model, qd, workspace);
  worldInertias(model, workspace);
  for (int i = 0; i < model.dof(); ++i) {
    const BodyState& body = workspace.bodies[i];
    ArticulatedState& state = workspace.articulated[i];
    state.inertia = body.inertia.matrix();
    state.bias = body.velocity.cross(body.inertia * body.velocity);
    if (external) state.bias -= external->of(i);
  }

  for (int i = model.dof() - 1; i >= 0; --i) {
    const MotionVector& S = workspace.bodies[i].axis;
    ArticulatedState& state = workspace.articulated[i];
    const Vector6d U = state.inertia * S.coordinates();
    state.axis_force = ForceVector(U);
    state.axis_inertia = S.dot(state.axis_force);
    state.axis_torque = tau[i] - S.dot(state.bias);
    const int parent = model.parent(i);
    if (parent < 0) continue;
    // Iᵃ = Iᴬ − U D⁻¹ Uᵀ and pᵃ = pᴬ + Iᵃ c + U D⁻¹ u go to the parent.
    ArticulatedState& before = workspace.articulated[parent];
    const Vector6d U_by_D = U / state.axis_inertia;
    before.inertia += state.inertia - U.lazyProduct(U_by_D.transpose());
    const MotionVector& c = workspace.bodies[i].velocity_product;
    const Vector6d force = state.inertia * c.coordinates() + U_by_D * (state.axis_torque - c.dot(state.axis_force));
    before.bias += state.bias + ForceVector(force);
  }

  const MotionVector base = baseAcceleration(gravity_W);
  for (int i = 0; i < model.dof(); ++i) {
    BodyState& body = workspace.bodies[i];
    const ArticulatedState& state = workspace.articulated[i];
    const int parent = model.parent(i);
    const MotionVector a = (parent < 0 ? base : workspace.bodies[parent].acceleration) + body.velocity_product;
    qdd[i] = (state.axis_torque - a.dot(state.axis_force)) / state.axis_inertia;
    body.acceleration = a + body.axis * qdd[i];
  }
}

}  // namespace tactus::dynamics
