#pragma once

#include <Eigen/Geometry>

#include "framework/dynamics/kinematics.h"

namespace tactus::dynamics {

/// Everything about the robot that one tick needs, computed once from (q, q̇) with one sweep of kinematics and
/// shared by all signals and tasks.  World frame W is the frame of the robot's base.  Takes no memory after
/// construction.  Frames are indices into Model::frames().  Linear rows come first in every 6-vector.  The model
/// must outlive the cache.  Of a model without masses (MassPolicy::kinematics_only) only the kinematics mean anything.
class DynamicsCache {
 public:
  explicit DynamicsCache(const Model& model, const Eigen::Vector3d& gravity_W = {0, 0, -9.81});
  explicit DynamicsCache(const Model&&, const Eigen::Vector3d& = {0, 0, -9.81}) = delete;  ///< would outlive it

  /// Poses, velocities, M, its Cholesky factor, b + g and g.  Throws std::invalid_argument for wrong sizes.
  void update(const Eigen::VectorXd& q, const Eigen::VectorXd& qd);

  const Model& model() const { return *model_; }
  int dof() const { return model_->dof(); }
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& qd() const { return qd_; }
  const Eigen::MatrixXd& massMatrix() const { return mass_matrix_; }         ///< M, full symmetric
  const Eigen::MatrixXd& massFactor() const { return mass_factor_; }         ///< L, lower triangular, M = L Lᵀ
  const Eigen::VectorXd& bias() const { return bias_; }                      ///< b + g
  const Eigen::VectorXd& gravityTorque() const { return gravity_torque_; }   ///< g

  /// X_WF.
  Eigen::Isometry3d framePose(int frame) const { return dynamics::framePose(*model_, workspace_, frame); }
  /// At the frame origin, world axes.
  Vector6d frameVelocity(int frame) const { return dynamics::frameVelocity(*model_, workspace_, frame); }
  Eigen::Vector3d pointVelocity(int frame, const Eigen::Vector3d& point_W) const {
    return dynamics::pointVelocity(*model_, workspace_, frame, point_W);
  }
  /// Velocity of the point of `frame` now at point_W: J q̇.  J is overwritten, zero columns included.
  void pointJacobian(int frame, const Eigen::Vector3d& point_W, PointJacobianRef J) const {
    dynamics::pointJacobian(*model_, workspace_, frame, point_W, J);
  }
  /// n_W ᵀ J of a point as one row (dof), without forming J.
  void directionJacobian(int frame, const Eigen::Vector3d& point_W, const Eigen::Vector3d& direction_W,
                         RowRef row) const {
    dynamics::directionJacobian(*model_, workspace_, frame, point_W, direction_W, row);
  }
  void frameJacobian(int frame, FrameJacobianRef J) const { dynamics::frameJacobian(*model_, workspace_, frame, J); }
  /// J̇ q̇.
  Eigen::Vector3d pointAccelerationBias(int frame, const Eigen::Vector3d& point_W) const {
    return dynamics::pointAccelerationBias(*model_, workspace_, frame, point_W);
  }
  /// J̇ q̇.
  Vector6d frameAccelerationBias(int frame) const {
    return dynamics::frameAccelerationBias(*model_, workspace_, frame);
  }

 private:
  const Model* model_;
  Eigen::Vector3d gravity_W_;
  Workspace workspace_;
  Eigen::VectorXd q_, qd_, bias_, gravity_torque_;
  Eigen::MatrixXd mass_matrix_, mass_factor_;
};

}  // namespace tactus::dynamics
