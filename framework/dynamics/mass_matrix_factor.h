#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/dynamics/model.h"

namespace tactus::dynamics {

/// M = Lᵀ D L along the tree, Featherstone (2008), table 6.3: L is unit lower triangular and, unlike the factor of
/// Cholesky, has no entries where M has none, so that fingers of one hand do not see each other.  M⁻¹ is applied to
/// vectors and matrices without being formed.  Takes no memory after construction.
///
/// Driven joints couple branches: with them every coordinate counts as the ancestor of all later ones.
class MassMatrixFactor {
 public:
  explicit MassMatrixFactor(const Model& model);

  /// Of the lower triangle of M, dof × dof.  False when M is not positive definite.
  bool compute(const Eigen::MatrixXd& M);

  /// x ← M⁻¹ x, a vector or a matrix of dof rows.
  void solveInPlace(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> x) const;
  void solveInPlace(Eigen::VectorXd& x) const;

 private:
  std::vector<int> parents_;                                       // λ, of coordinates
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> factor_;  // L below the diagonal
  Eigen::VectorXd inverse_diagonal_;                               // 1 / D
};

}  // namespace tactus::dynamics
