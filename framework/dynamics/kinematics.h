#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/dynamics/model.h"

/// Kinematics of a Model, and the memory that all algorithms of this room share.
///
/// Everything is in world axes about the world origin: then no transform stands between a body and its parent, the
/// recursions of Featherstone (2008) become plain sums, and one joint axis serves all Jacobians and the mass matrix.
/// The price is rounding of the order ε (distance from the base / size of the body)² in moments of inertia.
namespace tactus::dynamics {

/// 3 × dof and 6 × dof blocks of any column-major matrix.
using PointJacobianRef = Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;
using FrameJacobianRef = Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;
using RowRef = Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>>;

/// What the sweeps leave behind for one body.  Which sweep fills what is said at the function.
struct BodyState {
  Eigen::Matrix3d R_WB;
  Eigen::Vector3d p_WB;
  MotionVector axis;                                               ///< S, times the ratio of a driven body
  MotionVector velocity;                                           ///< v
  MotionVector velocity_product;                                   ///< c = Ṡ q̇
  MotionVector bias_acceleration;                                  ///< a when q̈ = 0, without gravity: J̇ q̇
  MotionVector acceleration;                                       ///< a, gravity as an acceleration of the base
  ForceVector force;                                               ///< f, through the joint
  RigidBodyInertia inertia;                                        ///< I
  RigidBodyInertia composite;                                      ///< Iᶜ, of the subtree
};

/// What the articulated-body algorithm needs besides, Featherstone (2008), section 7.3.
struct ArticulatedState {
  Matrix6d inertia;                                                ///< Iᴬ
  ForceVector bias;                                                ///< pᴬ
  ForceVector axis_force;                                          ///< U = Iᴬ S
  double axis_inertia;                                             ///< D = Sᵀ U
  double axis_torque;                                              ///< u = τ − Sᵀ pᴬ
};

/// Memory of the algorithms for one model, taken once.
struct Workspace {
  explicit Workspace(const Model& model)
      : bodies(model.bodyCount()),
        articulated(model.bodyCount()),
        composite_forces(model.bodyCount()),
        angles(model.bodyCount() + model.bodyCount() % 2),
        sines(angles.size()),
        cosines(angles.size()) {}

  std::vector<BodyState> bodies;
  std::vector<ArticulatedState> articulated;
  std::vector<ForceVector> composite_forces;                       ///< Iᶜ S of each body
  /// Where each body stands along its axis (rad or m; of a ball, nothing), padded to an even number.
  std::vector<double> angles, sines, cosines;
};

/// Poses and joint axes: R_WB, p_WB, axis.
void forwardKinematics(const Model& model, const Eigen::VectorXd& q, Workspace& workspace);
/// Velocities and J̇ q̇: velocity, velocity_product, bias_acceleration.  After forwardKinematics.
void forwardVelocities(const Model& model, const Eigen::VectorXd& qd, Workspace& workspace);
/// Accelerations on a base that accelerates with `base`: acceleration.  After forwardVelocities.
void forwardAccelerations(const Model& model, const Eigen::VectorXd& qdd, const MotionVector& base,
                          Workspace& workspace);
/// Gravity as an acceleration of the base, −g (section 5.3), instead of a force on every body.
inline MotionVector baseAcceleration(const Eigen::Vector3d& gravity_W) {
  return {-gravity_W, Eigen::Vector3d::Zero()};
}
/// Inertias in the world: inertia.  After forwardKinematics.
void worldInertias(const Model& model, Workspace& workspace);

/// In which axes and about which point the velocity of a frame F, its Jacobian and its acceleration are given.
/// Accelerations are the rates of change of the coordinates of such velocities.
enum class Axes {
  mixed,                                                           ///< of F's origin, world axes
  world,                                                           ///< of the point now at the world origin, world axes
  local                                                            ///< of F's origin, F's axes
};

// After forwardKinematics; `frame` is an index into Model::frames().

/// X_WF.
Eigen::Isometry3d framePose(const Model& model, const Workspace& workspace, int frame);
Eigen::Vector3d framePosition(const Model& model, const Workspace& workspace, int frame);
/// J with J q̇ = velocity of the point of `frame` now at point_W.  Overwritten, zero columns included.
void pointJacobian(const Model& model, const Workspace& workspace, int frame, const Eigen::Vector3d& point_W,
                   PointJacobianRef J);
/// direction_Wᵀ J of that point, without forming J.
void directionJacobian(const Model& model, const Workspace& workspace, int frame, const Eigen::Vector3d& point_W,
                       const Eigen::Vector3d& direction_W, RowRef row);
/// Linear rows first.
void frameJacobian(const Model& model, const Workspace& workspace, int frame, FrameJacobianRef J,
                   Axes axes = Axes::mixed);

// After forwardVelocities.

Vector6d frameVelocity(const Model& model, const Workspace& workspace, int frame, Axes axes = Axes::mixed);
Eigen::Vector3d pointVelocity(const Model& model, const Workspace& workspace, int frame,
                              const Eigen::Vector3d& point_W);
/// J̇ q̇ of the Jacobians above: acceleration when q̈ = 0, gravity aside.
Eigen::Vector3d pointAccelerationBias(const Model& model, const Workspace& workspace, int frame,
                                      const Eigen::Vector3d& point_W);
Vector6d frameAccelerationBias(const Model& model, const Workspace& workspace, int frame, Axes axes = Axes::mixed);
/// J q̈ + J̇ q̇.  After forwardAccelerations with the base at rest (gravity would show as its acceleration).
Vector6d frameAcceleration(const Model& model, const Workspace& workspace, int frame, Axes axes = Axes::mixed);

}  // namespace tactus::dynamics
