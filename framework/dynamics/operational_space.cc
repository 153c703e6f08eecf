#include "framework/dynamics/operational_space.h"

#include <Eigen/Householder>
#include <algorithm>
#include <numeric>

namespace tactus::dynamics {

OperationalSpace::OperationalSpace(int max_rows, int dof)
    : dof_(dof),
      transposed_(dof, max_rows),
      trapezoid_(max_rows, max_rows),
      inverse_(max_rows, max_rows),
      inertia_(max_rows, max_rows),
      lengths_(max_rows),
      reflection_(max_rows),
      scratch_(std::max(dof, max_rows)),
      order_(max_rows) {}

void OperationalSpace::compute(const Eigen::Ref<const Eigen::MatrixXd>& J, const Eigen::MatrixXd& mass_factor,
                               const OperationalSpaceOptions& options) {
  rows_ = static_cast<int>(J.rows());
  rank_ = 0;
  if (rows_ == 0) return;
  auto A_T = transposed_.leftCols(rows_);
  A_T = J.transpose();
  mass_factor.triangularView<Eigen::Lower>().solveInPlace(A_T);    // Aᵀ = L⁻¹ Jᵀ

  double longest = 0;
  for (int i = 0; i < rows_; ++i) {
    lengths_[i] = A_T.col(i).norm();
    longest = std::max(longest, lengths_[i]);
  }
  for (int i = 0; i < rows_; ++i) {
    if (lengths_[i] > options.rank_tolerance * longest) {
      A_T.col(i) /= lengths_[i];
    } else {
      A_T.col(i).setZero();
      lengths_[i] = 1;
    }
  }

  // Âᵀ P = Q R: of the columns left, the one with the longest rest comes next.
  std::iota(order_.begin(), order_.begin() + rows_, 0);
  for (int k = 0; k < std::min(rows_, dof_); ++k) {
    int pivot = k;
    double pivot_rest = 0;
    for (int i = k; i < rows_; ++i) {
      const double rest = A_T.col(i).tail(dof_ - k).norm();
      if (rest > pivot_rest) {
        pivot = i;
        pivot_rest = rest;
      }
    }
    if (pivot_rest <= options.rank_tolerance) break;
    A_T.col(k).swap(A_T.col(pivot));
    std::swap(order_[k], order_[pivot]);
    double tau, diagonal;
    A_T.col(k).tail(dof_ - k).makeHouseholderInPlace(tau, diagonal);
    A_T.block(k, k + 1, dof_ - k, rows_ - k - 1)
        .applyHouseholderOnTheLeft(A_T.col(k).tail(dof_ - k - 1), tau, scratch_.data());
    A_T(k, k) = diagonal;
    ++rank_;
  }

  // Rᵀ = Q₂ T, so that Â Âᵀ = P Q₂ T Tᵀ Q₂ᵀ Pᵀ.
  auto R_T = trapezoid_.topLeftCorner(rows_, rank_);
  R_T.setZero();
  for (int k = 0; k < rank_; ++k) R_T.col(k).tail(rows_ - k) = A_T.row(k).tail(rows_ - k).transpose();
  for (int k = 0; k < rank_; ++k) {
    double diagonal;
    R_T.col(k).tail(rows_ - k).makeHouseholderInPlace(reflection_[k], diagonal);
    R_T.block(k, k + 1, rows_ - k, rank_ - k - 1)
        .applyHouseholderOnTheLeft(R_T.col(k).tail(rows_ - k - 1), reflection_[k], scratch_.data());
    R_T(k, k) = diagonal;
  }

  // W = P Q₂ T⁻ᵀ, Λ = D⁻¹ W Wᵀ D⁻¹.
  auto W = inverse_.topLeftCorner(rows_, rank_);
  W.setIdentity();
  auto W_top = W.topRows(rank_);
  R_T.topRows(rank_).triangularView<Eigen::Upper>().transpose().solveInPlace(W_top);
  for (int k = rank_ - 1; k >= 0; --k) {
    W.bottomRows(rows_ - k).applyHouseholderOnTheLeft(R_T.col(k).tail(rows_ - k - 1), reflection_[k],
                                                      scratch_.data());
  }
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double entry = W.row(i).dot(W.row(j)) / (lengths_[order_[i]] * lengths_[order_[j]]);
      inertia_(order_[i], order_[j]) = inertia_(order_[j], order_[i]) = entry;
    }
  }
}

}  // namespace tactus::dynamics
