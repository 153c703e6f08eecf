#include "framework/dynamics/rnea.h"

#include "framework/dynamics/crba.h"

namespace tactus::dynamics {
namespace {

/// Force on a body, moment about the world origin, by Newton's law for the centre of mass and Euler's about it: the
/// inertia stays in body axes.
ForceVector bodyForce(const Model::Body& body, const BodyState& state) {
  const Eigen::Vector3d c_W = state.p_WB + state.R_WB * body.centre_of_mass;
  const Eigen::Vector3d& w_W = state.velocity.angular();
  const Eigen::Vector3d acceleration = state.acceleration.at(c_W) + w_W.cross(state.velocity.at(c_W));
  const Eigen::Vector3d w_B = state.R_WB.transpose() * w_W;
  const Eigen::Vector3d angular_acceleration_B = state.R_WB.transpose() * state.acceleration.angular();
  const Eigen::Vector3d angular_momentum_B = body.central_inertia * w_B;
  const Eigen::Vector3d moment_B = body.central_inertia * angular_acceleration_B + w_B.cross(angular_momentum_B);
  const Eigen::Vector3d force = body.inertia.mass * acceleration;
  return {force, c_W.cross(force) + state.R_WB * moment_B};
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

/// `accelerate(i, a)` adds S_i q̈_i.
template <class Accelerate>
void recursiveNewtonEuler(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                          const Eigen::Vector3d& gravity_W, Accelerate accelerate, Workspace& workspace,
                          Eigen::VectorXd& tau) {
  forwardKinematics(model, q, workspace);
  const MotionVector base = baseAcceleration(gravity_W);
  for (int i = 0; i < model.dof(); ++i) {
    BodyState& state = workspace.bodies[i];
    const MotionVector joint_velocity = state.axis * qd[i];
    if (const int parent = model.parent(i); parent < 0) {
      state.velocity = joint_velocity;
      state.acceleration = base;
    } else {
      const BodyState& before = workspace.bodies[parent];
      state.velocity = before.velocity + joint_velocity;
      state.acceleration = before.acceleration + before.velocity.cross(joint_velocity);
    }
    accelerate(i, state.acceleration);
    state.force = bodyForce(model.bodies()[i], state);
  }
  projectForces(model, workspace, tau);
}

}  // namespace

void rnea(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& qdd,
          const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& tau) {
  const auto accelerate = [&](int i, MotionVector& a) { a += workspace.bodies[i].axis * qdd[i]; };
  recursiveNewtonEuler(model, q, qd, gravity_W, accelerate, workspace, tau);
}

void nonlinearEffects(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                      const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& bias) {
  recursiveNewtonEuler(model, q, qd, gravity_W, [](int, MotionVector&) {}, workspace, bias);
}

void biasSweep(const Model& model, const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& bias) {
  const MotionVector base = baseAcceleration(gravity_W);
  for (BodyState& state : workspace.bodies) {
    const MotionVector a = base + state.bias_acceleration;
    state.force = state.inertia * a + state.velocity.cross(state.inertia * state.velocity);  // table 5.1
  }
  projectForces(model, workspace, bias);
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
