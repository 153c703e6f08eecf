#include "framework/dynamics/kinematics.h"

#include <cmath>

namespace tactus::dynamics {

using description::JointType;

void forwardKinematics(const Model& model, const Eigen::VectorXd& q, Workspace& workspace) {
  const Eigen::Matrix3d R_W = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  for (int i = 0; i < model.dof(); ++i) {
    const Model::Body& body = model.bodies()[i];
    BodyState& state = workspace.bodies[i];
    const BodyState* parent = body.parent < 0 ? nullptr : &workspace.bodies[body.parent];
    const Eigen::Matrix3d& R_WP = parent ? parent->R_WB : R_W;
    const Eigen::Vector3d& p_WP = parent ? parent->p_WB : p_W;
    const Eigen::Matrix3d R = R_WP * body.origin.linear();         // R_WB at q = 0
    const Eigen::Vector3d z = R.col(2);
    state.p_WB = p_WP + R_WP * body.origin.translation();
    if (body.type == JointType::revolute) {
      const double c = std::cos(q[i]), s = std::sin(q[i]);
      state.R_WB.col(0) = c * R.col(0) + s * R.col(1);
      state.R_WB.col(1) = c * R.col(1) - s * R.col(0);
      state.R_WB.col(2) = z;
      state.axis = MotionVector(state.p_WB.cross(z), z);
    } else {
      state.R_WB = R;
      state.p_WB += q[i] * z;
      state.axis = MotionVector(z, Eigen::Vector3d::Zero());
    }
  }
}

void forwardVelocities(const Model& model, const Eigen::VectorXd& qd, Workspace& workspace) {
  for (int i = 0; i < model.dof(); ++i) {
    BodyState& state = workspace.bodies[i];
    const MotionVector joint_velocity = state.axis * qd[i];
    if (const int parent = model.parent(i); parent < 0) {
      state.velocity = joint_velocity;
      state.bias_acceleration = MotionVector::Zero();              // a fixed axis: Ṡ = 0
    } else {
      const BodyState& before = workspace.bodies[parent];
      state.velocity = before.velocity + joint_velocity;
      state.bias_acceleration = before.bias_acceleration + before.velocity.cross(joint_velocity);  // Ṡ = v × S
    }
  }
}

void worldInertias(const Model& model, Workspace& workspace) {
  for (int i = 0; i < model.dof(); ++i) {
    BodyState& state = workspace.bodies[i];
    state.inertia = model.bodies()[i].inertia.transformed(state.R_WB, state.p_WB);
  }
}

Eigen::Isometry3d framePose(const Model& model, const Workspace& workspace, int frame) {
  const Model::Frame& F = model.frames()[frame];
  if (F.body < 0) return F.pose;
  const BodyState& state = workspace.bodies[F.body];
  Eigen::Isometry3d X_WF = Eigen::Isometry3d::Identity();
  X_WF.linear().noalias() = state.R_WB * F.pose.linear();
  X_WF.translation() = state.p_WB + state.R_WB * F.pose.translation();
  return X_WF;
}

Eigen::Vector3d framePosition(const Model& model, const Workspace& workspace, int frame) {
  const Model::Frame& F = model.frames()[frame];
  if (F.body < 0) return F.pose.translation();
  const BodyState& state = workspace.bodies[F.body];
  return state.p_WB + state.R_WB * F.pose.translation();
}

void pointJacobian(const Model& model, const Workspace& workspace, int frame, const Eigen::Vector3d& point_W,
                   PointJacobianRef J) {
  int supporting = model.frames()[frame].body;
  for (int i = model.dof() - 1; i >= 0; --i) {
    if (i == supporting) {
      J.col(i) = workspace.bodies[i].axis.at(point_W);
      supporting = model.parent(i);
    } else {
      J.col(i).setZero();
    }
  }
}

void directionJacobian(const Model& model, const Workspace& workspace, int frame, const Eigen::Vector3d& point_W,
                       const Eigen::Vector3d& direction_W, RowRef row) {
  const ForceVector unit_force(direction_W, point_W.cross(direction_W));
  row.setZero();
  for (int i = model.frames()[frame].body; i >= 0; i = model.parent(i)) {
    row[i] = workspace.bodies[i].axis.dot(unit_force);
  }
}

void frameJacobian(const Model& model, const Workspace& workspace, int frame, FrameJacobianRef J) {
  const Eigen::Vector3d p_WF = framePosition(model, workspace, frame);
  J.setZero();
  for (int i = model.frames()[frame].body; i >= 0; i = model.parent(i)) {
    const MotionVector& axis = workspace.bodies[i].axis;
    J.col(i).head<3>() = axis.at(p_WF);
    J.col(i).tail<3>() = axis.angular();
  }
}

Vector6d frameVelocity(const Model& model, const Workspace& workspace, int frame) {
  const int body = model.frames()[frame].body;
  if (body < 0) return Vector6d::Zero();
  const MotionVector& v = workspace.bodies[body].velocity;
  Vector6d velocity;
  velocity << v.at(framePosition(model, workspace, frame)), v.angular();
  return velocity;
}

Eigen::Vector3d pointVelocity(const Model& model, const Workspace& workspace, int frame,
                              const Eigen::Vector3d& point_W) {
  const int body = model.frames()[frame].body;
  if (body < 0) return Eigen::Vector3d::Zero();
  return workspace.bodies[body].velocity.at(point_W);
}

Eigen::Vector3d pointAccelerationBias(const Model& model, const Workspace& workspace, int frame,
                                      const Eigen::Vector3d& point_W) {
  const int body = model.frames()[frame].body;
  if (body < 0) return Eigen::Vector3d::Zero();
  const BodyState& state = workspace.bodies[body];
  // A spatial acceleration tells how the velocity field changes at a place; the point moves on in it: (2.49).
  return state.bias_acceleration.at(point_W) +
         Eigen::Vector3d(state.velocity.angular()).cross(state.velocity.at(point_W));
}

Vector6d frameAccelerationBias(const Model& model, const Workspace& workspace, int frame) {
  const int body = model.frames()[frame].body;
  if (body < 0) return Vector6d::Zero();
  Vector6d bias;
  bias << pointAccelerationBias(model, workspace, frame, framePosition(model, workspace, frame)),
      workspace.bodies[body].bias_acceleration.angular();
  return bias;
}

}  // namespace tactus::dynamics
