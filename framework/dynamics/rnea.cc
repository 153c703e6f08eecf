#include "framework/dynamics/rnea.h"

#include "framework/dynamics/crba.h"

namespace tactus::dynamics {
namespace {

/// f = I a + v ×* I v, table 5.1.
ForceVector bodyForce(const RigidBodyInertia& I, const MotionVector& v, const MotionVector& a) {
  return I * a + v.cross(I * v);
}

/// Gravity as an acceleration of the base, −g: section 5.3.
MotionVector baseAcceleration(const Eigen::Vector3d& gravity_W) { return {-gravity_W, Eigen::Vector3d::Zero()}; }

/// τ = Sᵀ f, tip to base, each body handing its force to its parent.
void projectForces(const Model& model, Workspace& workspace, Eigen::VectorXd& tau) {
  for (int i = model.dof() - 1; i >= 0; --i) {
    const BodyState& state = workspace.bodies[i];
    tau[i] = state.axis.dot(state.force);
    if (const int parent = model.parent(i); parent >= 0) workspace.bodies[parent].force += state.force;
  }
}

}  // namespace

void rnea(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
          const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& tau) {
  forwardKinematics(model, q, workspace);
  forwardVelocities(model, qd, workspace);
  worldInertias(model, workspace);
  const MotionVector base = baseAcceleration(gravity_W);
  for (int i = 0; i < model.dof(); ++i) {
    BodyState& state = workspace.bodies[i];
    const int parent = model.parent(i);
    state.acceleration = (parent < 0 ? base : workspace.bodies[parent].acceleration) + state.axis * qdd[i];
    if (parent >= 0) state.acceleration += workspace.bodies[parent].velocity.cross(state.axis * qd[i]);
    state.force = bodyForce(state.inertia, state.velocity, state.acceleration);
  }
  projectForces(model, workspace, tau);
}

void biasSweep(const Model& model, const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& bias) {
  const MotionVector base = baseAcceleration(gravity_W);
  for (int i = 0; i < model.dof(); ++i) {
    BodyState& state = workspace.bodies[i];
    state.force = bodyForce(state.inertia, state.velocity, base + state.bias_acceleration);
  }
  projectForces(model, workspace, bias);
}

void nonlinearEffects(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                      const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& bias) {
  forwardKinematics(model, q, workspace);
  forwardVelocities(model, qd, workspace);
  worldInertias(model, workspace);
  biasSweep(model, gravity_W, workspace, bias);
}

void gravitySweep(const Model& model, const Eigen::Vector3d& gravity_W, const Workspace& workspace,
                  Eigen::VectorXd& torque) {
  for (int i = 0; i < model.dof(); ++i) {
    const BodyState& state = workspace.bodies[i];
    const Eigen::Vector3d weight = state.composite.mass * gravity_W;
    torque[i] = -state.axis.dot(ForceVector(weight, state.composite.first_moment.cross(gravity_W)));
  }
}

void gravityTorque(const Model& model, const Eigen::VectorXd& q, const Eigen::Vector3d& gravity_W,
                   Workspace& workspace, Eigen::VectorXd& torque) {
  forwardKinematics(model, q, workspace);
  worldInertias(model, workspace);
  compositeInertias(model, workspace);
  gravitySweep(model, gravity_W, workspace, torque);
}

}  // namespace tactus::dynamics
