// One level of the hierarchy, in what the levels above it left.
#include <algorithm>
#include <cmath>

#include "plugins/hqp/solver.h"

namespace tactus::hqp {
namespace {

constexpr double kept = 1e-12;                                     // violation, relative to the point, that is rounding
constexpr double missed = 1e-9;                                    // violation, relative, of a point that is none

}  // namespace

Hqp::Solver::Outcome Hqp::Solver::solveLevel(const TickProblem& problem, int level) {
  stages_above_ = stages();
  above_ = base_;
  if (!start(level, costly).empty() || !start(level, met).empty()) {
    const Outcome outcome = solveAsLastTime(problem, level);
    if (outcome != Outcome::impossible) return outcome;
    restoreChain(stages_above_);
  }
  openStage(problem, level);
  if (!leavesABound(kept)) {
    start(level, costly).clear();
    start(level, met).clear();
    return Outcome::solved;
  }
  Outcome outcome = Outcome::impossible;
  for (const double of_free_directions : free_prices) {
    outcome = price(level, of_free_directions);
    if (outcome != Outcome::impossible) break;
  }
  return outcome == Outcome::solved ? settle(problem, level) : outcome;
}

// With the same rows costing the level as in the last tick.  Its optimum if nothing leaves a bound and each of them
// does cost it something; then nothing is to be priced.
Hqp::Solver::Outcome Hqp::Solver::solveAsLastTime(const TickProblem& problem, int level) {
  std::vector<int>& held = start(level, costly);
  const bool fits = static_cast<int>(held.size()) <= dof_ - chain_.held();
  if (!fits || !std::all_of(held.begin(), held.end(), [this](int row) { return isBounded(row); })) held.clear();
  if (!held.empty()) holdAtBounds(held);
  openStage(problem, level);
  const Outcome outcome = enterBounds(level, kept);
  if (outcome != Outcome::solved || held.empty() || rowsCost(problem, level)) return outcome;
  return Outcome::impossible;
}

bool Hqp::Solver::isBounded(int signed_row) const {
  const int j = std::abs(signed_row) - 1;
  return j < count_ && std::isfinite(signed_row > 0 ? upper_[j] : lower_[j]);
}

// Whether the multipliers of the level's rows at their bounds have the right sign and count: Σ μ c is what the gradient
// of its error leaves in their stage.
bool Hqp::Solver::rowsCost(const TickProblem& problem, int level) {
  const PriorityFactor::Stage& bounds = chain_.stage(stages_above_);
  const PriorityFactor::Stage& own = chain_.lastStage();
  if (bounds.deficient || own.rank > own.held || open_rows_ == 0) return false;
  whitened_.objectiveLeft(problem, level, y_, target_);
  auto left = target_.head(open_rows_).array();
  const auto weights = weights_.head(open_rows_).array();
  left *= (weights / weights.maxCoeff()).square();
  auto multipliers = multipliers_.head(bounds.held);
  multipliers.noalias() = rows_.block(bounds.first, 0, bounds.held, open_rows_) * target_.head(open_rows_);
  const auto triangle = held_rows_.block(bounds.first, 0, bounds.held, bounds.held);
  triangle.triangularView<Eigen::Upper>().solveInPlace(multipliers);
  const std::vector<int>& held = start(level, costly);
  const double least = costly_share * (z_.norm() + base_.norm());
  for (int i = 0; i < bounds.held; ++i) {
    const double multiplier = held[i] > 0 ? multipliers[i] : -multipliers[i];
    if (!(multiplier * triangle.col(i).head(i + 1).norm() > least)) return false;
  }
  return true;
}

// Decomposes what the level asks for, in what the chain leaves, and comes nearest to it when nothing else is looked at.
void Hqp::Solver::openStage(const TickProblem& problem, int level) {
  open_rows_ = whitened_.gatherObjective(problem, level, base_, rows_, target_, weights_);
  chain_.advance(open());
  chain_.hold(open());
  chain_.leastSquares(open(), target_.head(open_rows_), weights_.head(open_rows_), z_);
  toPoint();
  have_turned_ = false;
}

bool Hqp::Solver::leavesABound(double share) {
  if (count_ == 0) return false;
  auto products = products_.head(count_);
  products.noalias() = y_.transpose() * constraints_.leftCols(count_);
  const double tolerance = share * (z_.norm() + base_.norm());
  for (int j = 0; j < count_; ++j)
    if (products[j] > upper_[j] + tolerance || products[j] < lower_[j] - tolerance) return true;
  return false;
}

// The nearest point within the bounds that the open stage's free directions can reach.
Hqp::Solver::Outcome Hqp::Solver::enterBounds(int level, double tolerated) {
  std::vector<int>& met_rows = start(level, met);
  if (!leavesABound(kept)) {
    met_rows.clear();
    return Outcome::solved;
  }
  const int first = chain_.held();
  if (first < dof_) {
    gatherRows(first);
    guess(met_rows);
    const Outcome outcome = nearest(first);
    if (outcome != Outcome::solved) return outcome;
    z_.tail(dof_ - first) += least_distance_.x();
    toPoint();
    met_rows.clear();
    for (int i = 0; i < least_distance_.activeCount(); ++i) met_rows.push_back(signedRow(i));
  }
  return leavesABound(tolerated) ? Outcome::impossible : Outcome::solved;
}

void Hqp::Solver::advanceConstraints(int stages) {
  if (advanced_stages_ == 0) advanced_.leftCols(count_) = constraints_.leftCols(count_);
  for (; advanced_stages_ < stages; ++advanced_stages_) chain_.advance(advanced_stages_, advanced_.leftCols(count_));
}

// Constraints in the coordinates from `first` on, about the point z_, as unit rows; with a price in the metric of the
// level's error and of that price.  Those that the coordinates before decide already fade out.
void Hqp::Solver::gatherRows(int first, double of_free_directions) {
  const int free = dof_ - first;
  if (!have_turned_) {
    advanceConstraints(stages() - 1);
    turned_.leftCols(count_) = advanced_.leftCols(count_);
    chain_.turn(stages() - 1, turned_.leftCols(count_));
    have_turned_ = true;
  }
  auto rows = small_.topLeftCorner(dof_, count_);
  rows = turned_.leftCols(count_);
  if (of_free_directions > 0) {
    chain_.toMetric(open(), rows);
    rows.bottomRows(dof_ - chain_.held()) /= of_free_directions;
  }
  small_count_ = 0;
  for (int j = 0; j < count_; ++j) {
    place_[j] = -1;
    if (lower_[j] == -no_bound && upper_[j] == no_bound) continue;
    const double unpriced = turned_.col(j).tail(free).norm();
    const double weight = control::fadeWeight(unpriced, control::RankOptions{});
    if (weight == 0) continue;
    const double length = rows.col(j).tail(free).norm();
    const double above = products_[j] - upper_[j];
    const double below = lower_[j] - products_[j];
    small_upper_[small_count_] = (-above + (1 - weight) * std::max(0.0, above)) / length;
    small_lower_[small_count_] = (below - (1 - weight) * std::max(0.0, below)) / length;
    // Leftwards, so that no row is lost that is still to come.
    small_.block(0, small_count_, free, 1) = rows.col(j).tail(free) / length;
    lengths_[small_count_] = length / unpriced;
    behind_[small_count_] = j;
    place_[j] = small_count_++;
  }
  centre_.head(free).setZero();
}

void Hqp::Solver::guess(const std::vector<int>& signed_rows) {
  for (const int row : signed_rows) {
    const int constraint = std::abs(row) - 1;
    if (constraint < count_ && place_[constraint] >= 0) least_distance_.guess(place_[constraint], row);
  }
}

Hqp::Solver::Outcome Hqp::Solver::nearest(int first) {
  const int free = dof_ - first;
  least_distance_.limit(step_limit_ - steps_, end_);
  const auto outcome = least_distance_.solve(small_.topLeftCorner(free, small_count_), small_lower_.head(small_count_),
                                             small_upper_.head(small_count_), centre_.head(free));
  steps_ += least_distance_.steps();
  released_ += least_distance_.releasedCount();
  if (outcome == LeastDistance::Outcome::solved) return Outcome::solved;
  return least_distance_.late() ? Outcome::late : Outcome::impossible;
}

// The level's error, and each free direction at its price: finds which rows are at their bounds, and which of them cost
// the level something.
Hqp::Solver::Outcome Hqp::Solver::price(int level, double of_free_directions) {
  const int held = chain_.held();
  const int first = held - chain_.lastStage().held;
  gatherRows(first, of_free_directions);
  guess(start(level, costly));
  guess(start(level, met));
  const Outcome outcome = nearest(first);
  if (outcome != Outcome::solved) return outcome;
  const auto u = least_distance_.x();
  column_.setZero();
  column_.col(0).tail(dof_ - first) = u;
  chain_.fromMetric(open(), column_.col(0));
  z_ += column_.col(0);
  z_.tail(dof_ - held) += (1 / of_free_directions - 1) * column_.col(0).tail(dof_ - held);
  const double size = z_.norm() + base_.norm();
  costly_.clear();
  active_.clear();
  for (int i = 0; i < least_distance_.activeCount(); ++i) {
    const int row = least_distance_.active(i);
    active_.push_back(signedRow(i));
    const double cost = std::abs(least_distance_.multipliers()[row]) / lengths_[row];
    if (cost > costly_share * size) costly_.push_back(active_.back());
  }
  return Outcome::solved;
}

// The point itself: rows that cost the level are equalities, its own rows then come as near as they can, and of what is
// left the shortest is taken.
Hqp::Solver::Outcome Hqp::Solver::settle(const TickProblem& problem, int level) {
  start(level, costly) = costly_;
  toPoint();
  priced_ = y_;
  for (std::vector<int>* rows : {&costly_, &active_}) {            // all of them, should the cost have been misjudged
    if (rows == &active_ && costly_.size() == active_.size()) break;
    restoreChain(stages_above_);
    if (!rows->empty()) holdAtBounds(*rows);
    openStage(problem, level);
    const Outcome outcome = enterBounds(level, missed);
    if (outcome != Outcome::impossible) return outcome;
  }
  restoreChain(stages_above_);
  openStage(problem, level);
  y_ = priced_;
  start(level, met) = active_;
  return Outcome::solved;
}

// The chain with its first stages alone, as it was when the level began.
void Hqp::Solver::restoreChain(int count) {
  if (stages() == count + 1) {                                     // the open stage alone goes
    chain_.dropLastStage();
    return;
  }
  while (stages() > count) chain_.dropLastStage();
  base_ = above_;
  if (advanced_stages_ > count) advanced_stages_ = 0;
}

// A stage of constraints, ±(index + 1), at their upper or lower bounds; brings them into its own order.
void Hqp::Solver::holdAtBounds(std::vector<int>& signed_rows) {
  const int count = static_cast<int>(signed_rows.size());
  at_base_.head(count_).noalias() = base_.transpose() * constraints_.leftCols(count_);
  for (int i = 0; i < count; ++i) {
    const int j = std::abs(signed_rows[i]) - 1;
    held_rows_.col(i) = constraints_.col(j);
    target_[i] = (signed_rows[i] > 0 ? upper_[j] : lower_[j]) - at_base_[j];
  }
  auto rows = held_rows_.leftCols(count);
  chain_.advance(rows);
  chain_.hold(rows);
  weights_.head(count).setOnes();
  chain_.leastSquares(rows, target_.head(count), weights_.head(count), z_);
  toPoint();
  base_ = y_;
  order_ = signed_rows;
  for (int i = 0; i < count; ++i) signed_rows[i] = order_[chain_.column(i)];
}

// y = base + what z_ stands for.
void Hqp::Solver::toPoint() {
  column_.col(0) = z_;
  for (int stage = stages() - 1; stage >= 0; --stage) {
    if (stage == stages() - 1)
      chain_.turnBack(stage, column_);
    else
      chain_.bringBack(stage, column_);
  }
  y_ = base_ + column_.col(0);
}

}  // namespace tactus::hqp
