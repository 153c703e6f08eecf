#pragma once

#include "framework/dynamics/external_forces.h"
#include "framework/dynamics/mass_matrix_factor.h"
#include "framework/dynamics/operational_space.h"

namespace tactus::dynamics {

/// q̈ from τ, of any model.  Takes no memory after construction.
class ForwardDynamics {
 public:
  explicit ForwardDynamics(const Model& model);                    ///< the model must outlive it
  explicit ForwardDynamics(const Model&&) = delete;

  /// q̈ = M⁻¹ (τ − b − g + Σ Jᵀ f): by the articulated-body algorithm where no joint drives another one, else by the
  /// factor of M.  Gives q̈ its size; throws std::invalid_argument for wrong sizes of what comes in.
  void compute(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& tau,
               const Eigen::Vector3d& gravity_W, Workspace& workspace, Eigen::VectorXd& qdd,
               const ExternalForces* external = nullptr);

 private:
  const Model* model_;
  MassMatrixFactor factor_;
  Eigen::MatrixXd mass_matrix_;
};

/// Forward dynamics under constraints J q̈ = a (Featherstone 2008, section 8.2), e.g. feet that stand:
///
///   M q̈ = τ − b − g + Jᵀ λ,   λ = Λ (a − J M⁻¹ (τ − b − g)),
///
/// with Λ a generalised inverse of J M⁻¹ Jᵀ: rows may depend on each other, λ is then one of many forces that give
/// the same q̈.  Rows that contradict each other are met in the least-squares sense of that inverse.
class ConstrainedDynamics {
 public:
  ConstrainedDynamics(int max_rows, int dof);

  /// `mass_factor`: L with M = L Lᵀ (DynamicsCache::massFactor).  `drive`: τ − b − g.  J has rows × dof, a rows.
  void compute(const Eigen::MatrixXd& mass_factor, const Eigen::VectorXd& drive,
               const Eigen::Ref<const Eigen::MatrixXd>& J, const Eigen::Ref<const Eigen::VectorXd>& a);

  const Eigen::VectorXd& acceleration() const { return acceleration_; }      ///< q̈
  auto forces() const { return forces_.head(rows_); }                        ///< λ, what the world exerts
  int rank() const { return space_.rank(); }

 private:
  OperationalSpace space_;
  int rows_ = 0;
  Eigen::VectorXd acceleration_, forces_, missing_, push_;
};

}  // namespace tactus::dynamics
