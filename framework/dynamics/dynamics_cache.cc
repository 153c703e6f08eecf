#include "framework/dynamics/dynamics_cache.h"

#include "framework/dynamics/cholesky.h"
#include "framework/dynamics/crba.h"
#include "framework/dynamics/require_size.h"
#include "framework/dynamics/rnea.h"

namespace tactus::dynamics {

DynamicsCache::DynamicsCache(const Model& model, const Eigen::Vector3d& gravity_W)
    : model_(&model),
      gravity_W_(gravity_W),
      workspace_(model),
      bias_(model.dof()),
      gravity_torque_(model.dof()),
      mass_matrix_(Eigen::MatrixXd::Zero(model.dof(), model.dof())),
      mass_factor_(Eigen::MatrixXd::Zero(model.dof(), model.dof())) {
  q_.setZero(model.positionCount());
  qd_.setZero(model.dof());
  update(model.neutral(), Eigen::VectorXd::Zero(model.dof()));
}

void DynamicsCache::update(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
  requireSize("q", q, model_->positionCount());
  requireSize("qd", qd, model_->dof());
  q_ = q;
  qd_ = qd;
  forwardKinematics(*model_, q_, workspace_);
  forwardVelocities(*model_, qd_, workspace_);
  worldInertias(*model_, workspace_);
  biasSweep(*model_, gravity_W_, workspace_, bias_);
  compositeInertias(*model_, workspace_);
  gravitySweep(*model_, gravity_W_, workspace_, gravity_torque_);
  massMatrixSweep(*model_, workspace_, mass_matrix_);
  choleskyFactor(mass_matrix_, mass_factor_);
}

}  // namespace tactus::dynamics
