#include "framework/dynamics/forward_dynamics.h"

#include "framework/dynamics/aba.h"
#include "framework/dynamics/crba.h"
#include "framework/dynamics/require_size.h"
#include "framework/dynamics/rnea.h"

namespace tactus::dynamics {

ForwardDynamics::ForwardDynamics(const Model& model)
    : model_(&model),
      factor_(model),
      mass_matrix_(Eigen::MatrixXd::Zero(model.coupled() ? model.dof() : 0, model.coupled() ? model.dof() : 0)) {}

void ForwardDynamics::compute(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& tau,
                              const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& qdd,
                              const ExternalForces* external) {
  requireSize("q", q, model_->positionCount());
  requireSize("qd", qd, model_->dof());
  requireSize("tau", tau, model_->dof());
  qdd.resize(model_->dof());
  if (!model_->coupled()) return aba(*model_, q, qd, tau, gravity_W, workspace, qdd, external);
  nonlinearEffects(*model_, q, qd, gravity_W, workspace, qdd, external);
  qdd = tau - qdd;
  worldInertias(*model_, workspace);
  compositeInertias(*model_, workspace);
  massMatrixSweep(*model_, workspace, mass_matrix_);
  factor_.compute(mass_matrix_);
  factor_.solveInPlace(qdd);
}

ConstrainedDynamics::ConstrainedDynamics(int max_rows, int dof)
    : space_(max_rows, dof), acceleration_(dof), forces_(max_rows), missing_(max_rows), push_(dof) {}

void ConstrainedDynamics::compute(const Eigen::MatrixXd& mass_factor, const Eigen::VectorXd& drive,
                                  const Eigen::Ref<const Eigen::MatrixXd>& J,
                                  const Eigen::Ref<const Eigen::VectorXd>& a) {
  const auto L = mass_factor.triangularView<Eigen::Lower>();
  const auto applyInverse = [&](Eigen::VectorXd& x) {
    L.solveInPlace(x);
    L.transpose().solveInPlace(x);
  };
  rows_ = static_cast<int>(J.rows());
  acceleration_ = drive;
  applyInverse(acceleration_);
  if (rows_ == 0) return;
  space_.compute(J, mass_factor);
  missing_.head(rows_) = a;
  missing_.head(rows_).noalias() -= J * acceleration_;
  forces_.head(rows_).noalias() = space_.inertia() * missing_.head(rows_);
  push_.noalias() = J.transpose() * forces_.head(rows_);
  applyInverse(push_);
  acceleration_ += push_;
}

}  // namespace tactus::dynamics
