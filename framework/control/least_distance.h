#pragma once

#include <Eigen/Core>

#include "framework/control/whitened_problem.h"

namespace tactus::control {

/// The point of {x : B x ≤ d} nearest to c: least-distance programming, whose dual is nonnegative least squares
/// (Lawson and Hanson 1974, ch. 23).  Solved by the dual active-set method of Goldfarb and Idnani (1983) with
/// identity Hessian: the most violated row is added, and a held row is released when its multiplier would turn
/// negative.  The dual objective rises at every full step, so the number of steps is finite; it is bounded too.
/// Takes no memory after construction.
class LeastDistance {
 public:
  LeastDistance(int dimension, int row_capacity);

  enum class Outcome {
    solved,
    infeasible,                                                    ///< the rows contradict each other
    exhausted                                                      ///< the bound on the steps was reached
  };

  /// `rows`: n × m, column j is row j of B, of unit norm.  `d`: m.
  /// With `release` off rows are only ever added, which over-constrains: it is there so that tests can show it.
  Outcome solve(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d,
                const Eigen::Ref<const Eigen::VectorXd>& c, bool release = true);

  auto x() const { return x_.head(n_); }
  /// Multipliers λ ≥ 0 of all rows: x = c − Bᵀ λ.
  auto multipliers() const { return multipliers_.head(m_); }
  int activeCount() const { return active_count_; }
  int active(int i) const { return active_[i]; }                   ///< row index
  int releasedCount() const { return released_; }
  int steps() const { return steps_; }

 private:
  Outcome attempt(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d,
                  const Eigen::Ref<const Eigen::VectorXd>& c, bool release);
  void updateViolations(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d);
  int mostViolated(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d);
  Outcome addRow(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d, int row, bool release);
  void decompose(const ConstColumnsRef& rows, int row);            // b = Q (Qᵀ b) + z
  void append(int row);
  void remove(const ConstColumnsRef& rows, int position);
  void restoreAccuracy(const Eigen::Ref<const Eigen::VectorXd>& d, const Eigen::Ref<const Eigen::VectorXd>& c);

  int n_ = 0;
  int m_ = 0;
  double size_ = 0;                                                // of c and of the largest violation
  double dependence_tolerance_ = 0;
  int active_count_ = 0;
  int released_ = 0;
  int steps_ = 0;
  int step_limit_ = 0;
  Eigen::VectorXi active_;
  Eigen::VectorXi state_;                                          // of each row: free, active, or set aside
  Eigen::VectorXd x_;
  Eigen::VectorXd multipliers_;
  Eigen::VectorXd violations_;
  Eigen::MatrixXd Q_;                                              // orthonormal basis of the active rows: B_aᵀ = Q R
  Eigen::MatrixXd R_;
  Eigen::VectorXd z_;                                              // part of the entering row outside of them
  Eigen::VectorXd projection_;                                     // Qᵀ b
  Eigen::VectorXd r_;                                              // R⁻¹ Qᵀ b, change of the multipliers
};

}  // namespace tactus::control
