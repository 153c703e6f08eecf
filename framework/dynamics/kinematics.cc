#include "framework/dynamics/kinematics.h"

#include "framework/dynamics/sine_cosine.h"

namespace tactus::dynamics {

namespace {

/// The motion of turning about a line through a point.
MotionVector turningAbout(const Eigen::Vector3d& axis, const Eigen::Vector3d& point) {
  return {point.cross(axis), axis};
}

/// Rotation of a quaternion w x y z of any length; zero turns nothing.
Eigen::Matrix3d rotationOf(double w, double x, double y, double z) {
  const double square = w * w + x * x + y * y + z * z;
  const double s = square > 0 ? 2 / square : 0;
  Eigen::Matrix3d R;
  R << 1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y);
  return R;
}

}  // namespace

void forwardKinematics(const Model& model, const Eigen::VectorXd& q, Workspace& workspace) {
  const int bodies = model.bodyCount();
  for (int i = 0; i < bodies; ++i) {
    const Model::Body& body = model.bodies()[i];
    workspace.angles[i] = body.ratio * q[body.position] + body.offset;
  }
  sinesAndCosines(workspace.angles.data(), static_cast<int>(workspace.angles.size()), workspace.sines.data(),
                  workspace.cosines.data());
  const Eigen::Matrix3d R_W = Eigen::Matrix3d::Identity();
  const Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  for (int i = 0; i < model.bodyCount(); ++i) {
    const Model::Body& body = model.bodies()[i];
    BodyState& state = workspace.bodies[i];
    const BodyState* parent = body.parent < 0 ? nullptr : &workspace.bodies[body.parent];
    const Eigen::Matrix3d& R_WP = parent ? parent->R_WB : R_W;
    const Eigen::Vector3d& p_WP = parent ? parent->p_WB : p_W;
    const Eigen::Matrix3d R = body.unturned ? R_WP : Eigen::Matrix3d(R_WP * body.origin.linear());  // R_WB at q = 0
    state.p_WB = p_WP + R_WP * body.origin.translation();
    switch (body.motion) {
      case Motion::rotation: {
        const double c = workspace.cosines[i], s = workspace.sines[i];
        state.R_WB.col(0) = c * R.col(0) + s * R.col(1);
        state.R_WB.col(1) = c * R.col(1) - s * R.col(0);
        state.R_WB.col(2) = R.col(2);
        state.axis = turningAbout(R.col(2), state.p_WB);
        break;
      }
      case Motion::translation:
        state.R_WB = R;
        state.p_WB += workspace.angles[i] * R.col(2);
        state.axis = MotionVector(R.col(2), Eigen::Vector3d::Zero());
        break;
      case Motion::ball_x: {
        const auto quaternion = q.segment<4>(body.position);
        state.R_WB.noalias() = R * rotationOf(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
        state.axis = turningAbout(state.R_WB.col(0), state.p_WB);
        break;
      }
      case Motion::ball_y:
      case Motion::ball_z:
        state.R_WB = R;
        state.axis = turningAbout(R.col(body.motion == Motion::ball_y ? 1 : 2), state.p_WB);
        break;
    }
    if (body.ratio != 1) state.axis = state.axis * body.ratio;
  }
}

void forwardVelocities(const Model& model, const Eigen::VectorXd& qd, Workspace& workspace) {
  for (int i = 0; i < model.bodyCount(); ++i) {
    const Model::Body& body = model.bodies()[i];
    BodyState& state = workspace.bodies[i];
    const MotionVector joint_velocity = state.axis * qd[body.coordinate];
    // Ṡ = v × S with v of the body that carries the axis; those of the base stand still.
    state.velocity_product = body.carrier < 0 ? MotionVector::Zero()
                                              : workspace.bodies[body.carrier].velocity.cross(joint_velocity);
    state.velocity = joint_velocity;
    state.bias_acceleration = state.velocity_product;
    if (body.parent < 0) continue;
    state.velocity += workspace.bodies[body.parent].velocity;
    state.bias_acceleration += workspace.bodies[body.parent].bias_acceleration;
  }
}

void forwardAccelerations(const Model& model, const Eigen::VectorXd& qdd, const MotionVector& base,
                          Workspace& workspace) {
  for (int i = 0; i < model.bodyCount(); ++i) {
    BodyState& state = workspace.bodies[i];
    const int parent = model.parent(i);
    state.acceleration = (parent < 0 ? base : workspace.bodies[parent].acceleration) + state.velocity_product +
                         state.axis * qdd[model.bodies()[i].coordinate];
  }
}

void worldInertias(const Model& model, Workspace& workspace) {
  for (int i = 0; i < model.bodyCount(); ++i) {
    BodyState& state = workspace.bodies[i];
    const Model::Body& body = model.bodies()[i];
    state.inertia = body.massless ? RigidBodyInertia() : body.inertia.transformed(state.R_WB, state.p_WB);
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
  J.setZero();
  for (int i = model.frames()[frame].body; i >= 0; i = model.parent(i)) {
    J.col(model.bodies()[i].coordinate) += workspace.bodies[i].axis.at(point_W);
  }
}

void directionJacobian(const Model& model, const Workspace& workspace, int frame, const Eigen::Vector3d& point_W,
                       const Eigen::Vector3d& direction_W, RowRef row) {
  const ForceVector unit_force(direction_W, point_W.cross(direction_W));
  row.setZero();
  for (int i = model.frames()[frame].body; i >= 0; i = model.parent(i)) {
    row[model.bodies()[i].coordinate] += workspace.bodies[i].axis.dot(unit_force);
  }
}

namespace {

/// Coordinates of a motion of the body that carries `frame`, given about the world origin.
Vector6d seenFrom(const Model& model, const Workspace& workspace, int frame, const MotionVector& motion, Axes axes) {
  Vector6d coordinates;
  if (axes == Axes::world) return motion.coordinates();
  coordinates << motion.at(framePosition(model, workspace, frame)), motion.angular();
  if (axes == Axes::mixed) return coordinates;
  const Eigen::Matrix3d R_FW = framePose(model, workspace, frame).linear().transpose();
  coordinates << R_FW * coordinates.head<3>(), R_FW * coordinates.tail<3>();
  return coordinates;
}

/// The same of a spatial acceleration.  In `mixed` the velocity is that of a point that moves on: (2.49).
Vector6d accelerationSeenFrom(const Model& model, const Workspace& workspace, int frame, const MotionVector& a,
                              Axes axes) {
  Vector6d coordinates = seenFrom(model, workspace, frame, a, axes);
  if (axes != Axes::mixed) return coordinates;
  const Vector6d v = frameVelocity(model, workspace, frame);
  coordinates.head<3>() += v.tail<3>().cross(v.head<3>());
  return coordinates;
}

}  // namespace

void frameJacobian(const Model& model, const Workspace& workspace, int frame, FrameJacobianRef J, Axes axes) {
  J.setZero();
  for (int i = model.frames()[frame].body; i >= 0; i = model.parent(i))
    J.col(model.bodies()[i].coordinate) += seenFrom(model, workspace, frame, workspace.bodies[i].axis, axes);
}

Vector6d frameVelocity(const Model& model, const Workspace& workspace, int frame, Axes axes) {
  const int body = model.frames()[frame].body;
  if (body < 0) return Vector6d::Zero();
  return seenFrom(model, workspace, frame, workspace.bodies[body].velocity, axes);
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

Vector6d frameAccelerationBias(const Model& model, const Workspace& workspace, int frame, Axes axes) {
  const int body = model.frames()[frame].body;
  if (body < 0) return Vector6d::Zero();
  return accelerationSeenFrom(model, workspace, frame, workspace.bodies[body].bias_acceleration, axes);
}

Vector6d frameAcceleration(const Model& model, const Workspace& workspace, int frame, Axes axes) {
  const int body = model.frames()[frame].body;
  if (body < 0) return Vector6d::Zero();
  return accelerationSeenFrom(model, workspace, frame, workspace.bodies[body].acceleration, axes);
}

}  // namespace tactus::dynamics
