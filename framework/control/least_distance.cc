#include "framework/control/least_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::control {
namespace {

enum RowState { row_free, row_active, row_set_aside };

constexpr double violation_tolerance = 1e-13;                      // relative to the size of c and d
// Sine of a row's angle to the active ones below which it depends on them.  The least is right for all but vertices at
// which many more rows meet than there are dimensions; there it takes rounding for a direction, and the next is tried.
constexpr double dependence_tolerances[] = {1e-10, 1e-8, 1e-6};
constexpr double largest_change = 100;                             // of a multiplier, counted on by rounding
constexpr double zero_change = 1e-12;                              // of a multiplier: rounding, not a direction
constexpr int steps_per_row = 20;

}  // namespace

LeastDistance::LeastDistance(int dimension, int row_capacity)
    : active_(dimension),
      state_(row_capacity),
      x_(dimension),
      multipliers_(row_capacity),
      violations_(row_capacity),
      Q_(dimension, dimension),
      R_(dimension, dimension),
      z_(dimension),
      projection_(dimension),
      r_(dimension) {}

LeastDistance::Outcome LeastDistance::solve(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d,
                                            const Eigen::Ref<const Eigen::VectorXd>& c, bool release) {
  n_ = static_cast<int>(rows.rows());
  m_ = static_cast<int>(rows.cols());
  Outcome outcome = Outcome::exhausted;
  for (const double tolerance : dependence_tolerances) {
    dependence_tolerance_ = tolerance;
    outcome = attempt(rows, d, c, release);
    if (outcome != Outcome::solved) continue;
    updateViolations(rows, d);
    if (m_ == 0 || violations_.head(m_).maxCoeff() <= 10 * tolerance * size_) return outcome;
    outcome = Outcome::exhausted;
  }
  return outcome;
}

LeastDistance::Outcome LeastDistance::attempt(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d,
                                              const Eigen::Ref<const Eigen::VectorXd>& c, bool release) {
  x_.head(n_) = c;
  multipliers_.head(m_).setZero();
  state_.head(m_).setZero();
  active_count_ = released_ = steps_ = 0;
  step_limit_ = steps_per_row * (m_ + 1);
  updateViolations(rows, d);
  size_ = c.norm() + (m_ > 0 ? std::max(0.0, violations_.head(m_).maxCoeff()) : 0);
  for (int row = mostViolated(rows, d); row >= 0; row = mostViolated(rows, d)) {
    const Outcome outcome = addRow(rows, d, row, release);
    if (outcome != Outcome::solved) return outcome;
  }
  restoreAccuracy(d, c);
  return Outcome::solved;
}

void LeastDistance::updateViolations(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d) {
  auto violations = violations_.head(m_);
  violations = -d;
  for (int k = 0; k < n_; ++k) violations += x_[k] * rows.row(k).transpose();
}

int LeastDistance::mostViolated(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d) {
  updateViolations(rows, d);
  int worst = -1;
  double largest = 0;
  for (int j = 0; j < m_; ++j) {
    const double tolerance = violation_tolerance * (size_ + std::abs(d[j]));
    if (state_[j] != row_free || violations_[j] <= tolerance || violations_[j] <= largest) continue;
    largest = violations_[j];
    worst = j;
  }
  return worst;
}

// Classical Gram–Schmidt, twice.
void LeastDistance::decompose(const ConstColumnsRef& rows, int row) {
  const auto Q = Q_.topLeftCorner(n_, active_count_);
  auto z = z_.head(n_);
  auto projection = projection_.head(active_count_);
  auto again = r_.head(active_count_);
  z = rows.col(row);
  projection.noalias() = Q.transpose() * z;
  z.noalias() -= Q * projection;
  again.noalias() = Q.transpose() * z;
  z.noalias() -= Q * again;
  projection += again;
}

void LeastDistance::append(int row) {
  const double norm = z_.head(n_).norm();
  Q_.col(active_count_).head(n_) = z_.head(n_) / norm;
  R_.col(active_count_).head(active_count_) = projection_.head(active_count_);
  R_(active_count_, active_count_) = norm;
  active_[active_count_++] = row;
  state_[row] = row_active;
}

void LeastDistance::remove(const ConstColumnsRef& rows, int position) {
  const int count = active_count_;
  state_[active_[position]] = row_free;
  multipliers_[active_[position]] = 0;
  active_count_ = position;
  for (int i = position + 1; i < count; ++i) {
    decompose(rows, active_[i]);
    append(active_[i]);
  }
  // With one row less, those that depended on it count again.
  for (int j = 0; j < m_; ++j)
    if (state_[j] == row_set_aside) state_[j] = row_free;
}

LeastDistance::Outcome LeastDistance::addRow(const ConstColumnsRef& rows, const Eigen::Ref<const Eigen::VectorXd>& d,
                                             int row, bool release) {
  while (true) {
    if (++steps_ > step_limit_) return Outcome::exhausted;
    decompose(rows, row);
    auto r = r_.head(active_count_);
    r = projection_.head(active_count_);
    R_.topLeftCorner(active_count_, active_count_).triangularView<Eigen::Upper>().solveInPlace(r);
    const double free_part = z_.head(n_).squaredNorm();
    const bool dependent = active_count_ == n_ || free_part < dependence_tolerance_ * dependence_tolerance_;
    const double violation = rows.col(row).dot(x_.head(n_)) - d[row];
    const double largest = active_count_ > 0 ? r.cwiseAbs().maxCoeff() : 0;
    // A row that the active ones imply is violated by their rounding.
    const double rounding =
        dependence_tolerance_ * (size_ + std::abs(d[row])) * (1 + std::min(largest, largest_change));
    if (dependent && violation <= rounding) {
      state_[row] = row_set_aside;
      return Outcome::solved;
    }

    const double full = dependent ? std::numeric_limits<double>::infinity() : violation / free_part;
    double step = full;
    int leaving = -1;
    for (int i = 0; i < active_count_ && release; ++i) {
      if (r[i] <= zero_change * std::max(1.0, largest)) continue;
      const double limit = multipliers_[active_[i]] / r[i];
      if (limit < step) {
        step = limit;
        leaving = i;
      }
    }
    if (dependent && leaving < 0) {
      if (release) return Outcome::infeasible;                      // no held row can give way
      state_[row] = row_set_aside;
      return Outcome::solved;
    }
    if (!dependent) x_.head(n_) -= step * z_.head(n_);
    for (int i = 0; i < active_count_; ++i) multipliers_[active_[i]] -= step * r[i];
    multipliers_[row] += step;
    if (leaving < 0) {
      append(row);
      return Outcome::solved;
    }
    ++released_;
    remove(rows, leaving);
  }
}

// The same point from the active rows alone: B x = d means Qᵀ x = R⁻ᵀ d, and x = c − Bᵀ λ.
void LeastDistance::restoreAccuracy(const Eigen::Ref<const Eigen::VectorXd>& d,
                                    const Eigen::Ref<const Eigen::VectorXd>& c) {
  if (active_count_ == 0) return;
  const auto R = R_.topLeftCorner(active_count_, active_count_);
  const auto Q = Q_.topLeftCorner(n_, active_count_);
  auto target = projection_.head(active_count_);                   // R⁻ᵀ d
  auto lambda = r_.head(active_count_);
  for (int i = 0; i < active_count_; ++i) target[i] = d[active_[i]];
  R.transpose().triangularView<Eigen::Lower>().solveInPlace(target);
  lambda = -target;
  lambda.noalias() += Q.transpose() * c;
  x_.head(n_) = c;
  x_.head(n_).noalias() -= Q * lambda;
  R.triangularView<Eigen::Upper>().solveInPlace(lambda);
  for (int i = 0; i < active_count_; ++i) multipliers_[active_[i]] = lambda[i];
  // Once more, against the rounding of the first projection where c is much larger than x.
  target.noalias() -= Q.transpose() * x_.head(n_);
  x_.head(n_).noalias() += Q * target;
}

}  // namespace tactus::control
