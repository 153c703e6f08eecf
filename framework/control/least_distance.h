#pragma once

#include <Eigen/Core>
#include <chrono>

#include "framework/control/whitened_problem.h"

namespace tactus::control {

/// The point of {x : l ≤ B x ≤ u} nearest to c: least-distance programming, whose dual is nonnegative least squares
/// (Lawson and Hanson 1974, ch. 23).  Solved by the dual active-set method of Goldfarb and Idnani (1983) with
/// identity Hessian: the most violated row is added, and a held row is released when its multiplier would turn
/// to the wrong side.  The dual objective rises at every full step, so the number of steps is finite; it is bounded
/// too.  A row whose bounds are equal is held from the start and never released.
///
/// A guess of the rows at their bounds, such as those of the last tick, saves the steps that lead there: rows of the
/// guess are held at once, and those whose multiplier has the wrong sign are let go before the first step, so that a
/// wrong guess costs time and never the answer.  Takes no memory after construction.
class LeastDistance {
 public:
  /// `independence`: sine of a row's angle to those at their bounds below which it counts as one of their span.
  LeastDistance(int dimension, int row_capacity, double independence = 1e-10);

  using TimePoint = std::chrono::steady_clock::time_point;

  enum class Outcome {
    solved,
    infeasible,                                                    ///< the rows contradict each other
    exhausted                                                      ///< the bound on the steps was reached
  };

  using Rows = ConstColumnsRef;
  using Vector = Eigen::Ref<const Eigen::VectorXd>;

  /// `rows`: n × m, column j is row j of B, of unit norm or zero.  `lower`, `upper`: m, infinite where there is none.
  Outcome solve(const Rows& rows, const Vector& lower, const Vector& upper, const Vector& c);
  /// Upper bounds alone.  With `release` off rows are only ever added, which over-constrains: it is there so that
  /// tests can show it.
  Outcome solve(const Rows& rows, const Vector& upper, const Vector& c, bool release = true);

  /// The next call of `solve`, and only that, begins with this row at its upper (+1) or lower (−1) bound.
  void guess(int row, int side);
  void forgetGuess() { guess_count_ = 0; }
  /// Most steps of a call, and the moment at which it gives up; beyond them the outcome is `exhausted` and the call late.
  void limit(int steps, TimePoint end = TimePoint::max()) {
    step_limit_ = steps;
    end_ = end;
  }
  bool late() const { return late_; }

  auto x() const { return x_.head(n_); }
  /// Multipliers λ of all rows, x = c − Bᵀ λ: λ ≥ 0 at an upper bound, ≤ 0 at a lower one.
  auto multipliers() const { return multipliers_.head(m_); }
  /// Takes out of a vector, in place, its part in the span of the active rows of the last solve.
  void leaveActiveRows(Eigen::Ref<Eigen::VectorXd> u);
  int activeCount() const { return active_count_; }
  int active(int i) const { return active_[i]; }                   ///< row index
  int side(int i) const { return side_[i]; }                       ///< of active(i): +1 upper, −1 lower
  int releasedCount() const { return released_; }
  int steps() const { return steps_; }

 private:
  enum State : char { row_free, row_active, row_equal, row_set_aside };
  struct Bounds {
    const double* lower;                                           // null: none
    const double* upper;
  };

  Outcome solve(const Rows& rows, const Bounds& bounds, const Vector& c, bool release);
  Outcome attempt(const Rows& rows, const Vector& c, bool release, bool guessed);
  bool holdEqualities(const Rows& rows);
  bool keepsDependentEqualities(const Rows& rows) const;
  void holdGuess(const Rows& rows);
  void settle(const Vector& c);
  bool outOfTime();
  double bound(int row, int side) const { return side > 0 ? bounds_.upper[row] : bounds_.lower[row]; }
  bool isEquality(int row) const { return bounds_.lower && bounds_.lower[row] == bounds_.upper[row]; }
  double violation(int row) const;                                 // of the last products; negative inside the bounds
  double largestViolation() const;
  bool activeAreAtBounds(double tolerance) const;
  void updateProducts(const Rows& rows);
  int mostViolated() const;
  Outcome addRow(const Rows& rows, int row, int side, bool release);
  double decompose(const Rows& rows, int row, int side);           // b = Q (Qᵀ b) + z; returns ‖z‖²
  void append(int row, int side, double free_part);
  void remove(int position);
  void recompute(const Vector& c);

  Bounds bounds_{};
  int n_ = 0;
  int m_ = 0;
  double size_ = 0;                                                // of c and of the largest violation
  double independence_;
  double dependence_tolerance_ = 0;                                // of this attempt
  int active_count_ = 0;
  int released_ = 0;
  int steps_ = 0;
  int step_limit_;
  TimePoint end_ = TimePoint::max();
  bool late_ = false;
  bool settled_ = false;                                           // x_ and the products belong to the active rows
  int guess_count_ = 0;
  Eigen::VectorXi guess_;                                          // row + 1, negative for a lower bound
  Eigen::VectorXi active_;
  Eigen::VectorXi side_;
  Eigen::Matrix<State, Eigen::Dynamic, 1> state_;
  Eigen::VectorXd x_;
  Eigen::VectorXd multipliers_;
  Eigen::VectorXd products_;                                       // B x
  Eigen::MatrixXd Q_;                                              // orthonormal basis of the active rows: B_aᵀ = Q R
  Eigen::MatrixXd R_;
  Eigen::VectorXd z_;                                              // part of the entering row outside of them
  Eigen::VectorXd projection_;                                     // Qᵀ b
  Eigen::VectorXd r_;                                              // R⁻¹ Qᵀ b, change of the multipliers
};

}  // namespace tactus::control
