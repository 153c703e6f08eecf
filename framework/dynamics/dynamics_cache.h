#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/dynamics/model.h"

namespace tactus::dynamics {

using Vector6d = Eigen::Matrix<double, 6, 1>;
/// 3 × dof and 6 × dof blocks of any column-major matrix.
using PointJacobianRef = Eigen::Ref<Eigen::Matrix<double, 3, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;
using FrameJacobianRef = Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;

/// Everything about the robot that one tick needs, computed once from (q, q̇) with one sweep of kinematics and
/// shared by all signals and tasks.  World frame W is the frame of the robot's base.  Takes no memory after
/// construction.  Frames are indices into Model::frames().  Linear rows come first in every 6-vector.
class DynamicsCache {
 public:
  explicit DynamicsCache(const Model& model, const Eigen::Vector3d& gravity_W = {0, 0, -9.81});

  /// Poses, velocities, M, its Cholesky factor, b + g and g.
  void update(const Eigen::VectorXd& q, const Eigen::VectorXd& qd);

  const Model& model() const { return *model_; }
  int dof() const { return model_->dof(); }
  const Eigen::VectorXd& q() const;
  const Eigen::VectorXd& qd() const;
  const Eigen::MatrixXd& massMatrix() const;                       ///< M, full symmetric
  const Eigen::MatrixXd& massFactor() const;                       ///< L, lower triangular, M = L Lᵀ
  const Eigen::VectorXd& bias() const;                             ///< b + g
  const Eigen::VectorXd& gravityTorque() const;                    ///< g

  Eigen::Isometry3d framePose(int frame) const;                    ///< X_WF
  Vector6d frameVelocity(int frame) const;                         ///< at the frame origin, world axes
  Eigen::Vector3d pointVelocity(int frame, const Eigen::Vector3d& point_W) const;
  /// Velocity of the point of `frame` now at point_W: J q̇.  J is overwritten, zero columns included.
  void pointJacobian(int frame, const Eigen::Vector3d& point_W, PointJacobianRef J) const;
  /// n_W ᵀ J of a point as one row (dof), without forming J.
  void directionJacobian(int frame, const Eigen::Vector3d& point_W, const Eigen::Vector3d& direction_W,
                         Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> row) const;
  void frameJacobian(int frame, FrameJacobianRef J) const;
  Eigen::Vector3d pointAccelerationBias(int frame, const Eigen::Vector3d& point_W) const;  ///< J̇ q̇
  Vector6d frameAccelerationBias(int frame) const;                 ///< J̇ q̇

  // (members are the implementation's)
};

}  // namespace tactus::dynamics
