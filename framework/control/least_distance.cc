#include "framework/control/least_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/control/strips.h"

namespace tactus::control {
namespace {

constexpr double violation_tolerance = 1e-13;                      // relative to the size of c and of the bounds
// Sine of a row's angle to the active ones below which it depends on them.  The least is right for all but vertices at
// which many more rows meet than there are dimensions; there it takes rounding for a direction, and the next is tried.
constexpr double coarser_tolerances[] = {1e-8, 1e-6};
constexpr double largest_change = 100;                             // of a multiplier, counted on by rounding
constexpr double zero_change = 1e-12;                              // of a multiplier: rounding, not a direction
constexpr double turned_away = 0.25;                               // ‖z‖² of a unit row below which z is cleaned again
constexpr int steps_per_row = 20;
constexpr double no_bound = std::numeric_limits<double>::infinity();

}  // namespace

LeastDistance::LeastDistance(int dimension, int row_capacity, double independence)
    : independence_(independence),
      step_limit_(std::numeric_limits<int>::max()),
      guess_(row_capacity),
      active_(dimension),
      side_(dimension),
      state_(row_capacity),
      x_(dimension),
      multipliers_(row_capacity),
      products_(row_capacity),
      Q_(dimension, dimension),
      R_(dimension, dimension),
      z_(dimension),
      projection_(dimension),
      r_(dimension) {}

void LeastDistance::guess(int row, int side) {
  if (guess_count_ < guess_.size()) guess_[guess_count_++] = side > 0 ? row + 1 : -(row + 1);
}

LeastDistance::Outcome LeastDistance::solve(const Rows& rows, const Vector& lower, const Vector& upper,
                                            const Vector& c) {
  return solve(rows, {lower.data(), upper.data()}, c, true);
}

LeastDistance::Outcome LeastDistance::solve(const Rows& rows, const Vector& upper, const Vector& c, bool release) {
  return solve(rows, {nullptr, upper.data()}, c, release);
}

LeastDistance::Outcome LeastDistance::solve(const Rows& rows, const Bounds& bounds, const Vector& c, bool release) {
  n_ = static_cast<int>(rows.rows());
  m_ = static_cast<int>(rows.cols());
  bounds_ = bounds;
  steps_ = 0;
  late_ = false;
  Outcome outcome = Outcome::exhausted;
  bool guessed = guess_count_ > 0;
  bool contradiction = false;
  for (const double tolerance : {independence_, coarser_tolerances[0], coarser_tolerances[1]}) {
    dependence_tolerance_ = tolerance;
    outcome = attempt(rows, c, release, guessed);
    guessed = false;
    contradiction |= outcome == Outcome::infeasible;
    if (outcome == Outcome::solved) {
      if (largestViolation() <= 10 * tolerance * size_ && activeAreAtBounds(10 * tolerance)) break;
      outcome = Outcome::exhausted;
    }
    if (late_) break;
  }
  forgetGuess();
  return outcome == Outcome::exhausted && contradiction ? Outcome::infeasible : outcome;
}

LeastDistance::Outcome LeastDistance::attempt(const Rows& rows, const Vector& c, bool release, bool guessed) {
  x_.head(n_) = c;
  multipliers_.head(m_).setZero();
  state_.head(m_).setConstant(row_free);
  active_count_ = released_ = 0;
  const int last_step = steps_ + steps_per_row * (m_ + 1);
  updateProducts(rows);
  size_ = c.norm() + std::max(0.0, largestViolation());
  const bool dependent = bounds_.lower && holdEqualities(rows);
  if (guessed) holdGuess(rows);
  settle(c);
  if (dependent && !keepsDependentEqualities(rows)) return Outcome::infeasible;
  if (active_count_ > 0) updateProducts(rows);
  for (int row = mostViolated(); row >= 0; row = mostViolated()) {
    if (steps_ >= last_step) return Outcome::exhausted;
    const int side = products_[row] > bounds_.upper[row] ? 1 : -1;
    settled_ = false;
    const Outcome outcome = addRow(rows, row, side, release);
    if (outcome != Outcome::solved) return outcome;
    updateProducts(rows);
  }
  if (settled_) return Outcome::solved;
  recompute(c);
  updateProducts(rows);
  return Outcome::solved;
}

// True when some row depends on others.
bool LeastDistance::holdEqualities(const Rows& rows) {
  bool any_dependent = false;
  for (int j = 0; j < m_; ++j) {
    if (!isEquality(j)) continue;
    const double free_part = decompose(rows, j, 1);
    const bool dependent = active_count_ == n_ || free_part < dependence_tolerance_ * dependence_tolerance_;
    if (!dependent) append(j, 1, free_part);
    state_[j] = dependent ? row_set_aside : row_equal;
    any_dependent |= dependent;
  }
  return any_dependent;
}

bool LeastDistance::keepsDependentEqualities(const Rows& rows) const {
  for (int j = 0; j < m_; ++j) {
    if (!isEquality(j) || state_[j] == row_equal) continue;
    const double off = std::abs(rows.col(j).dot(x_.head(n_)) - bounds_.upper[j]);
    if (off > largest_change * dependence_tolerance_ * (size_ + std::abs(bounds_.upper[j]))) return false;
  }
  return true;
}

void LeastDistance::holdGuess(const Rows& rows) {
  for (int i = 0; i < guess_count_ && active_count_ < n_; ++i) {
    const int row = std::abs(guess_[i]) - 1;
    const int side = guess_[i] > 0 ? 1 : -1;
    if (row >= m_ || state_[row] != row_free || (side < 0 && !bounds_.lower)) continue;
    if (!std::isfinite(bound(row, side))) continue;
    const double free_part = decompose(rows, row, side);
    if (free_part > coarser_tolerances[1]) append(row, side, free_part);
  }
}

// The point of the rows held so far; those whose multiplier has the wrong sign are let go, the worst first.
void LeastDistance::settle(const Vector& c) {
  settled_ = true;
  while (active_count_ > 0) {
    recompute(c);
    int worst = -1;
    double least = 0;
    for (int i = 0; i < active_count_; ++i) {
      const double multiplier = side_[i] * multipliers_[active_[i]];
      if (state_[active_[i]] == row_equal || multiplier >= least) continue;
      least = multiplier;
      worst = i;
    }
    if (worst < 0) return;
    remove(worst);
    ++steps_;
  }
  x_.head(n_) = c;
}

void LeastDistance::updateProducts(const Rows& rows) {
  const double* b = rows.data();
  const Eigen::Index stride = rows.outerStride();
  forEachStrip(m_, [&](auto width, int j) {
    Strip<width()> sum = Strip<width()>::Zero();
    for (int k = 0; k < n_; ++k) sum += x_[k] * Eigen::Map<const Strip<width()>>(b + k * stride + j);
    products_.segment<width()>(j) = sum;
  });
}

double LeastDistance::violation(int row) const {
  const double above = products_[row] - bounds_.upper[row];
  return bounds_.lower ? std::max(above, bounds_.lower[row] - products_[row]) : above;
}

double LeastDistance::largestViolation() const {
  double largest = -no_bound;
  for (int j = 0; j < m_; ++j) largest = std::max(largest, violation(j));
  return largest;
}

// Not so where rows that contradict each other passed for independent ones: their point lies far inside of some.
bool LeastDistance::activeAreAtBounds(double tolerance) const {
  for (int i = 0; i < active_count_; ++i) {
    const double at = bound(active_[i], side_[i]);
    if (std::abs(products_[active_[i]] - at) > tolerance * (size_ + std::abs(at))) return false;
  }
  return true;
}

bool LeastDistance::outOfTime() {
  late_ = late_ || steps_ >= step_limit_ || (end_ != TimePoint::max() && std::chrono::steady_clock::now() >= end_);
  return late_;
}

// The row furthest beyond its bound by the products of the last point, or -1.
int LeastDistance::mostViolated() const {
  int worst = -1;
  double largest = violation_tolerance * size_;
  for (int j = 0; j < m_; ++j) {
    const double excess = violation(j);
    if (excess <= largest || state_[j] != row_free) continue;
    const double at = products_[j] > bounds_.upper[j] ? bounds_.upper[j] : bounds_.lower[j];
    if (excess <= violation_tolerance * (size_ + std::abs(at))) continue;
    largest = excess;
    worst = j;
  }
  return worst;
}

// Classical Gram–Schmidt, twice where the row turned out to lie close to the others (Daniel et al. 1976).
double LeastDistance::decompose(const Rows& rows, int row, int side) {
  const auto Q = Q_.topLeftCorner(n_, active_count_);
  auto z = z_.head(n_);
  auto projection = projection_.head(active_count_);
  z = side * rows.col(row);
  if (active_count_ == 0) return z.squaredNorm();
  projection.noalias() = Q.transpose() * z;
  z.noalias() -= Q * projection;
  double free_part = z.squaredNorm();
  if (free_part > turned_away) return free_part;
  auto again = r_.head(active_count_);
  again.noalias() = Q.transpose() * z;
  z.noalias() -= Q * again;
  projection += again;
  return z.squaredNorm();
}

void LeastDistance::append(int row, int side, double free_part) {
  const double norm = std::sqrt(free_part);
  Q_.col(active_count_).head(n_) = z_.head(n_) / norm;
  R_.col(active_count_).head(active_count_) = projection_.head(active_count_);
  R_(active_count_, active_count_) = norm;
  side_[active_count_] = side;
  active_[active_count_++] = row;
  state_[row] = row_active;
}

// The column leaves R; Givens rotations of its rows, and of the columns of Q with them, make it triangular again.
void LeastDistance::remove(int position) {
  state_[active_[position]] = row_free;
  multipliers_[active_[position]] = 0;
  --active_count_;
  for (int i = position; i < active_count_; ++i) {
    active_[i] = active_[i + 1];
    side_[i] = side_[i + 1];
    R_.col(i).head(i + 2) = R_.col(i + 1).head(i + 2);
  }
  for (int i = position; i < active_count_; ++i) {
    const double length = std::hypot(R_(i, i), R_(i + 1, i));
    const double cosine = R_(i, i) / length;
    const double sine = R_(i + 1, i) / length;
    for (int j = i; j < active_count_; ++j) {
      const double a = R_(i, j);
      const double b = R_(i + 1, j);
      R_(i, j) = cosine * a + sine * b;
      R_(i + 1, j) = cosine * b - sine * a;
    }
    double* first = Q_.col(i).data();
    double* second = Q_.col(i + 1).data();
    for (int k = 0; k < n_; ++k) {
      const double a = first[k];
      const double b = second[k];
      first[k] = cosine * a + sine * b;
      second[k] = cosine * b - sine * a;
    }
  }
  // With one row less, those that depended on it count again.
  for (int j = 0; j < m_; ++j)
    if (state_[j] == row_set_aside && !isEquality(j)) state_[j] = row_free;
}

LeastDistance::Outcome LeastDistance::addRow(const Rows& rows, int row, int side, bool release) {
  const double at = side * bound(row, side);
  while (true) {
    if (outOfTime()) return Outcome::exhausted;
    ++steps_;
    const double free_part = decompose(rows, row, side);
    auto r = r_.head(active_count_);
    r = projection_.head(active_count_);
    if (active_count_ > 0)
      R_.topLeftCorner(active_count_, active_count_).triangularView<Eigen::Upper>().solveInPlace(r);
    const bool dependent = active_count_ == n_ || free_part < dependence_tolerance_ * dependence_tolerance_;
    const double excess = side * rows.col(row).dot(x_.head(n_)) - at;
    const double largest = active_count_ > 0 ? r.cwiseAbs().maxCoeff() : 0;
    // A row that the active ones imply is violated by their rounding.
    const double rounding = dependence_tolerance_ * (size_ + std::abs(at)) * (1 + std::min(largest, largest_change));
    if (dependent && excess <= rounding) {
      state_[row] = row_set_aside;
      return Outcome::solved;
    }

    double step = dependent ? no_bound : excess / free_part;
    int leaving = -1;
    for (int i = 0; i < active_count_ && release; ++i) {
      // What the multiplier, positive by its side, loses for each unit of the step.
      const double loss = r[i];
      if (state_[active_[i]] == row_equal || loss <= zero_change * std::max(1.0, largest)) continue;
      const double limit = side_[i] * multipliers_[active_[i]] / loss;
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
    for (int i = 0; i < active_count_; ++i) multipliers_[active_[i]] -= side_[i] * step * r[i];
    multipliers_[row] += side * step;
    if (leaving < 0) {
      append(row, side, free_part);
      return Outcome::solved;
    }
    ++released_;
    remove(leaving);
  }
}

void LeastDistance::leaveActiveRows(Eigen::Ref<Eigen::VectorXd> u) {
  if (active_count_ == 0) return;
  const auto Q = Q_.topLeftCorner(n_, active_count_);
  auto part = r_.head(active_count_);
  part.noalias() = Q.transpose() * u;
  u.noalias() -= Q * part;
}

// The point from the active rows alone: B x = d means Qᵀ x = R⁻ᵀ d, and x = c − Bᵀ λ.
void LeastDistance::recompute(const Vector& c) {
  if (active_count_ == 0) {
    x_.head(n_) = c;
    return;
  }
  const auto R = R_.topLeftCorner(active_count_, active_count_);
  const auto Q = Q_.topLeftCorner(n_, active_count_);
  auto target = projection_.head(active_count_);                   // R⁻ᵀ d
  auto lambda = r_.head(active_count_);
  for (int i = 0; i < active_count_; ++i) target[i] = side_[i] * bound(active_[i], side_[i]);
  R.transpose().triangularView<Eigen::Lower>().solveInPlace(target);
  lambda = -target;
  lambda.noalias() += Q.transpose() * c;
  x_.head(n_) = c;
  x_.head(n_).noalias() -= Q * lambda;
  R.triangularView<Eigen::Upper>().solveInPlace(lambda);
  for (int i = 0; i < active_count_; ++i) multipliers_[active_[i]] = side_[i] * lambda[i];
  // Once more, against the rounding of the first projection where c is much larger than x.
  target.noalias() -= Q.transpose() * x_.head(n_);
  x_.head(n_).noalias() += Q * target;
}

}  // namespace tactus::control
