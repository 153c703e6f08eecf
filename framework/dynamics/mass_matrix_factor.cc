#include "framework/dynamics/mass_matrix_factor.h"

namespace tactus::dynamics {

MassMatrixFactor::MassMatrixFactor(const Model& model)
    : parents_(model.dof()), factor_(model.dof(), model.dof()), inverse_diagonal_(model.dof()) {
  factor_.setZero();
  for (int i = 0; i < model.dof(); ++i) parents_[i] = model.coupled() ? i - 1 : model.parent(i);
}

bool MassMatrixFactor::compute(const Eigen::MatrixXd& M) {
  const int dof = static_cast<int>(parents_.size());
  for (int k = 0; k < dof; ++k)
    for (int i = k; i >= 0; i = parents_[i]) factor_(k, i) = M(k, i);
  for (int k = dof - 1; k >= 0; --k) {
    double* row = &factor_(k, 0);
    if (!(row[k] > 0)) return false;
    inverse_diagonal_[k] = 1 / row[k];
    for (int i = parents_[k]; i >= 0; i = parents_[i]) {
      const double a = row[i] * inverse_diagonal_[k];
      double* above = &factor_(i, 0);
      for (int j = i; j >= 0; j = parents_[j]) above[j] -= a * row[j];
      row[i] = a;
    }
  }
  return true;
}

void MassMatrixFactor::solveInPlace(Eigen::Ref<Eigen::MatrixXd, 0, Eigen::OuterStride<>> x) const {
  for (Eigen::Index c = 0; c < x.cols(); ++c) {
    double* b = &x(0, c);
    const int dof = static_cast<int>(parents_.size());
    for (int i = dof - 1; i >= 0; --i)                             // L⁻ᵀ
      for (int j = parents_[i]; j >= 0; j = parents_[j]) b[j] -= factor_(i, j) * b[i];
    for (int i = 0; i < dof; ++i) {                                // D⁻¹, L⁻¹
      b[i] *= inverse_diagonal_[i];
      for (int j = parents_[i]; j >= 0; j = parents_[j]) b[i] -= factor_(i, j) * b[j];
    }
  }
}

void MassMatrixFactor::solveInPlace(Eigen::VectorXd& x) const {
  solveInPlace(Eigen::Map<Eigen::MatrixXd>(x.data(), x.size(), 1));
}

}  // namespace tactus::dynamics
