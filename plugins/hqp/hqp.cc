#include "plugins/hqp/hqp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/control/least_distance.h"
#include "framework/control/level_ranks.h"
#include "framework/control/whitened_problem.h"

namespace tactus::hqp {

using control::ActiveRow;
using control::LeastDistance;
using control::PriorityFactor;
using control::RowMajorMatrix;
using control::Status;
using control::TickLevel;
using control::TickProblem;
using control::TickSolution;
using control::TickTask;

namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();
/// Price of a free direction over that of a level's own error, or of a limit's violation: so small that it decides
/// nothing but which rows are at their bounds.
constexpr double free_prices[] = {1e-6, 1e-3};                     // the second where rounding takes the first
/// Share of a level's error, relative to the size of its point, from which a row at its bound is said to cost it.
constexpr double costly_share = 1e-8;
constexpr double kept = 1e-12;                                     // violation, relative to the point, that is rounding
constexpr double room = 1e-12;                                     // for rounding, between a point and its bounds
constexpr double missed = 1e-9;                                    // violation, relative, of a point that is none
constexpr double independence = 1e-13;                             // rows differ by as little as the price leaves of them
constexpr int rows_per_friction_contact = 3;

bool exceedsItsBounds(const TickTask& task) {
  return task.contact && task.rows > 0 && (task.friction || task.F().maxCoeff() > task.force_max);
}

}  // namespace

/// One hierarchy and its memory.  A point y = L⁻¹ τ is `base_`, what the chain of decompositions holds, and coordinates
/// z in what it leaves.
class Hqp::Solver {
 public:
  Solver(const TickProblem& shape, const HqpOptions& options);
  void solve(const TickProblem& problem, const control::Deadline& deadline, bool with_ranks, TickSolution& solution);

  control::WarmStart warmStart() const;
  void setWarmStart(const control::WarmStart& start);

 private:
  enum class Outcome { solved, impossible, late };
  enum Rows { costly, met, kinds };                                // at their bounds: costing the level, or not

  const TickProblem& withinForceBounds(const TickProblem& problem);
  void makeLimits(const TickProblem& problem);
  bool enterLimits(const TickProblem& problem);
  bool leastViolation(double of_free_directions);

  Outcome solveLevel(const TickProblem& problem, int level);
  Outcome solveAsLastTime(const TickProblem& problem, int level);
  bool rowsCost(const TickProblem& problem, int level);
  void openStage(const TickProblem& problem, int level);
  Outcome price(int level, double of_free_directions);
  Outcome settle(const TickProblem& problem, int level);
  Outcome enterBounds(int level, double tolerated);
  void holdLevel(int level, TickSolution& solution);

  auto open() { return rows_.leftCols(open_rows_); }
  std::vector<int>& start(int level, Rows kind) { return starts_[level * kinds + kind]; }
  int signedRow(int i) const { return least_distance_.side(i) * (behind_[least_distance_.active(i)] + 1); }
  int stages() const { return chain_.stages(); }
  void restoreChain(int count);
  void holdAtBounds(std::vector<int>& signed_rows);
  bool isBounded(int signed_row) const;
  bool leavesABound(double share = kept);
  void advanceConstraints(int stages);
  void gatherRows(int first, double of_free_directions = 0);
  void guess(const std::vector<int>& signed_rows);
  Outcome nearest(int first);
  void toPoint();
  void reportActive(TickSolution& solution);

  int dof_;
  control::LevelRanks ranks_;
  control::WhitenedProblem whitened_;
  TickProblem bounded_;
  PriorityFactor chain_;
  int open_rows_ = 0;
  RowMajorMatrix rows_;                                            // of the open stage, as `hold` left them
  RowMajorMatrix held_rows_;                                       // of the stage of bounds, likewise
  Eigen::VectorXd target_;
  Eigen::VectorXd weights_;                                        // norms of the rows
  RowMajorMatrix column_;                                          // coordinates of a point, dof × 1
  Eigen::VectorXd z_;                                              // of the level, in the open stage's coordinates
  Eigen::VectorXd y_;                                              // τ⁽ⁱ⁾
  Eigen::VectorXd base_;
  Eigen::VectorXd above_;                                          // base_ when the level began
  int stages_above_ = 0;                                           // and the chain's stages
  Eigen::VectorXd priced_;                                         // the priced point, should there be no better one

  // Constraints l ≤ c y ≤ u: torque limits, then the inequality rows of the levels above.
  int count_ = 0;
  int limit_count_ = 0;
  RowMajorMatrix constraints_;                                     // unit rows, dof × count
  RowMajorMatrix advanced_;                                        // taken through the chain's first stages,
  int advanced_stages_ = 0;                                        // so many of them
  RowMajorMatrix turned_;                                          // and through the open stage, if it was asked for
  bool have_turned_ = false;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd limit_lengths_;
  Eigen::RowVectorXd at_base_;                                     // c base, when it was last asked for
  Eigen::RowVectorXd products_;                                    // c y at the point that was looked at last
  Eigen::VectorXd multipliers_;

  LeastDistance least_distance_;
  RowMajorMatrix small_;                                           // rows of a least-distance programme
  int small_count_ = 0;
  Eigen::VectorXd small_lower_;
  Eigen::VectorXd small_upper_;
  Eigen::VectorXd centre_;
  Eigen::VectorXd lengths_;                                        // of its rows over those in z
  Eigen::VectorXi behind_;                                         // constraint behind each of its rows
  Eigen::VectorXi place_;                                          // and back, -1 for none
  std::vector<int> costly_;                                        // ±(constraint + 1) that cost the level something
  std::vector<int> active_;                                        // all at their bounds in the priced point
  std::vector<int> order_;
  std::vector<std::vector<int>> starts_;                           // the same, of the last tick, by level and kind
  int steps_ = 0;
  int step_limit_ = 0;
  LeastDistance::TimePoint end_;
  int released_ = 0;
  bool relaxed_ = false;
  bool holds_bounds_ = false;
  bool with_ranks_ = true;
};

Hqp::Solver::Solver(const TickProblem& shape, const HqpOptions& options)
    : dof_(shape.dof),
      ranks_(shape, options.rank),
      whitened_(shape),
      bounded_(shape),
      chain_(shape.dof, shape.rowCapacity() + shape.dof, 2 * static_cast<int>(shape.levels.size()) + 2, options.rank),
      rows_(shape.dof, shape.rowCapacity() + shape.dof),
      held_rows_(shape.dof, shape.dof),
      target_(rows_.cols()),
      weights_(rows_.cols()),
      column_(shape.dof, 1),
      z_(shape.dof),
      y_(shape.dof),
      base_(shape.dof),
      above_(shape.dof),
      priced_(shape.dof),
      constraints_(shape.dof, shape.rowCapacity() + shape.dof),
      advanced_(constraints_),
      turned_(constraints_),
      lower_(constraints_.cols()),
      upper_(constraints_.cols()),
      limit_lengths_(shape.dof),
      at_base_(constraints_.cols()),
      products_(constraints_.cols()),
      multipliers_(shape.dof),
      least_distance_(2 * shape.dof, static_cast<int>(constraints_.cols()), independence),
      small_(2 * shape.dof, constraints_.cols()),
      small_lower_(constraints_.cols()),
      small_upper_(constraints_.cols()),
      centre_(2 * shape.dof),
      lengths_(constraints_.cols()),
      behind_(constraints_.cols()),
      place_(constraints_.cols()),
      starts_(shape.levels.size() * kinds) {
  costly_.reserve(2 * shape.dof);
  active_.reserve(2 * shape.dof);
  order_.reserve(2 * shape.dof);
  for (std::vector<int>& start : starts_) start.reserve(2 * shape.dof);
}

void Hqp::Solver::solve(const TickProblem& given, const control::Deadline& deadline, bool with_ranks,
                        TickSolution& solution) {
  control::resetSolution(given, solution);
  const TickProblem& problem = withinForceBounds(given);
  if (!whitened_.update(problem)) {
    solution.status = Status::failed;
    solution.message = "the mass matrix is not positive definite, or a Jacobian or force is not finite";
    return;
  }
  steps_ = released_ = count_ = limit_count_ = 0;
  step_limit_ = deadline.iterations;
  end_ = deadline.end();
  chain_.reset();
  advanced_stages_ = 0;
  y_.setZero();
  base_.setZero();
  bool entered = !problem.torque_limits;
  relaxed_ = holds_bounds_ = false;
  with_ranks_ = with_ranks;
  if (problem.torque_limits) makeLimits(problem);
  for (int i = 0; i < whitened_.levelCount() && solution.status != Status::failed; ++i) {
    const int limits = problem.torque_limits ? problem.torque_limits->priority.value_or(problem.levels[0].priority) : 0;
    if (!entered && problem.levels[i].priority >= limits) {
      entered = true;
      relaxed_ = !enterLimits(problem);
    }
    const Outcome outcome = solveLevel(problem, i);
    if (outcome == Outcome::solved) {
      holdLevel(i, solution);
      continue;
    }
    solution.status = Status::failed;
    solution.late = outcome == Outcome::late;
    solution.message = solution.late ? "the deadline came before level " : "rounding left no way to solve level ";
    solution.message += std::to_string(problem.levels[i].priority);
    solution.message += "; the levels above it stand";
  }
  if (!entered) relaxed_ = !enterLimits(problem);
  whitened_.toTorque(y_, solution.torque);
  if (problem.torque_limits) {
    const control::TorqueLimits& limits = *problem.torque_limits;
    if (relaxed_ && solution.status == Status::ok) {
      solution.status = Status::infeasible;
      solution.message = "the levels above the torque limits do not fit into them; the torque was cut";
    }
    // By rounding, or after an infeasible tick by more.
    solution.torque = solution.torque.cwiseMin(limits.upper).cwiseMax(limits.lower);
    if (relaxed_) {
      y_ = solution.torque;
      whitened_.massFactor().triangularView<Eigen::Lower>().solveInPlace(y_);
    }
  }
  // With bounds held in the chain it does not say what the levels' rows alone could.
  if (with_ranks_ && holds_bounds_) ranks_.report(whitened_, solution);
  whitened_.reportResiduals(problem, y_, solution);
  solution.iterations = steps_;
  solution.rows_released = released_;
  reportActive(solution);
}

// The reference of a contact is brought into its bounds; what no bound cuts is used as it was given.
const TickProblem& Hqp::Solver::withinForceBounds(const TickProblem& problem) {
  bool any = false;
  for (const TickLevel& level : problem.levels) any |= std::any_of(level.tasks.begin(), level.tasks.end(), exceedsItsBounds);
  if (!any) return problem;
  bounded_ = problem;
  for (TickLevel& level : bounded_.levels)
    for (TickTask& task : level.tasks) {
      if (!exceedsItsBounds(task)) continue;
      const int step = task.friction ? rows_per_friction_contact : 1;
      for (int r = 0; r < task.rows; r += step) {
        task.force[r] = std::min(task.force[r], task.force_max);
        if (!task.friction) continue;
        auto tangential = task.force.segment<2>(r + 1);
        const double most = *task.friction * std::max(0.0, task.force[r]);
        if (tangential.norm() > most) tangential *= most / tangential.norm();
      }
    }
  return bounded_;
}

// Row i of L as a constraint on y; nothing binds before the limits' level.
void Hqp::Solver::makeLimits(const TickProblem& problem) {
  limit_count_ = count_ = problem.dof;
  const auto& L = whitened_.massFactor();
  auto lengths = limit_lengths_.head(count_);
  lengths.setZero();
  for (int k = 0; k < dof_; ++k) lengths.tail(dof_ - k) += L.col(k).tail(dof_ - k).cwiseAbs2();
  lengths = lengths.cwiseSqrt();
  for (int k = 0; k < dof_; ++k) {
    constraints_.row(k).head(k).setZero();
    constraints_.row(k).segment(k, dof_ - k) = L.col(k).tail(dof_ - k).cwiseQuotient(lengths.tail(dof_ - k)).transpose();
  }
  lower_.head(count_).setConstant(-no_bound);
  upper_.head(count_).setConstant(no_bound);
}

// From here on the limits bind.  False when what is held above does not fit: then they are relaxed by the least squares
// of their violations.
bool Hqp::Solver::enterLimits(const TickProblem& problem) {
  auto products = products_.head(limit_count_);
  products.noalias() = y_.transpose() * constraints_.leftCols(limit_count_);
  lower_.head(limit_count_) = problem.torque_limits->lower.cwiseQuotient(limit_lengths_);
  upper_.head(limit_count_) = problem.torque_limits->upper.cwiseQuotient(limit_lengths_);
  bool fits = true;
  for (int i = 0; i < limit_count_; ++i) fits &= products[i] >= lower_[i] && products[i] <= upper_[i];
  if (fits) return true;
  const bool found = std::any_of(std::begin(free_prices), std::end(free_prices), [&](double p) { return leastViolation(p); });
  fits = found;
  for (int i = 0; i < limit_count_; ++i) {
    const double reached = found ? products_[i] : constraints_.col(i).dot(y_);
    const double tolerance = costly_share * (1 + std::abs(reached));
    fits &= reached >= lower_[i] - tolerance && reached <= upper_[i] + tolerance;
    lower_[i] = std::min(lower_[i], reached - tolerance);
    upper_[i] = std::max(upper_[i], reached + tolerance);
  }
  return fits;
}

// A slack for each limit, beside the free directions at their price; what the limits then reach is in `products_`.
bool Hqp::Solver::leastViolation(double of_free_directions) {
  const int first = chain_.held();
  const int free = dof_ - first;
  const int size = free + limit_count_;
  at_base_.head(count_).noalias() = base_.transpose() * constraints_.leftCols(count_);
  advanceConstraints(stages());
  auto rows = small_.topLeftCorner(size, count_);
  rows.setZero();
  rows.topRows(free) = advanced_.block(first, 0, free, count_) / of_free_directions;
  rows.bottomRows(limit_count_).diagonal().setOnes();
  for (int j = 0; j < count_; ++j) {
    // What nothing free can change is as the levels above left it.
    if (j >= limit_count_ && advanced_.col(j).tail(free).norm() <= control::RankOptions{}.rank_tolerance) {
      rows.col(j).setZero();
      small_lower_[j] = -no_bound;
      small_upper_[j] = no_bound;
      continue;
    }
    const double length = rows.col(j).norm();
    rows.col(j) /= length;
    small_lower_[j] = (lower_[j] - at_base_[j]) / length;
    small_upper_[j] = (upper_[j] - at_base_[j]) / length;
  }
  centre_.head(size).setZero();
  least_distance_.limit(std::numeric_limits<int>::max());          // bounded by itself
  const auto outcome =
      least_distance_.solve(rows, small_lower_.head(count_), small_upper_.head(count_), centre_.head(size));
  const auto x = least_distance_.x().head(free) / of_free_directions;
  products_.head(limit_count_) = at_base_.head(limit_count_);
  for (int i = 0; i < limit_count_; ++i) products_[i] += advanced_.col(i).tail(free).dot(x);
  return outcome == LeastDistance::Outcome::solved;
}

Hqp::Solver::Outcome Hqp::Solver::solveLevel(const TickProblem& problem, int level) {
  stages_above_ = stages();
  above_ = base_;
  if (!start(level, costly).empty() || !start(level, met).empty()) {
    const Outcome outcome = solveAsLastTime(problem, level);
    if (outcome != Outcome::impossible) return outcome;
    restoreChain(stages_above_);
  }
  openStage(problem, level);
  if (!leavesABound()) {
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

// With the same rows costing the level as in the last tick.  Its optimum if nothing leaves a bound and each of them does
// cost it something; then nothing is to be priced.
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
  if (!leavesABound()) {
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
// level's error and of that price.  Those that the coordinates before
// decide already fade out.
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

// The level's equality rows stay as they are; its inequality rows become constraints at where they are.
void Hqp::Solver::holdLevel(int level, TickSolution& solution) {
  const int equalities = whitened_.equalityRows(level);
  const bool open_stage_stays = open_rows_ == equalities;
  if (!open_stage_stays) {                                         // it has inequality rows too, which may sink
    restoreChain(stages_above_);
    open_rows_ = equalities;
    open() = whitened_.equalities(level);
    chain_.advance(open());
    chain_.hold(open());
  }
  holds_bounds_ |= stages() > stages_above_ + 1;
  if (with_ranks_ && !holds_bounds_) control::LevelRanks::write(chain_.lastStage(), level, dof_, solution);
  if (level + 1 == whitened_.levelCount()) return;
  if (open_stage_stays && have_turned_) {
    chain_.fade(stages() - 1, turned_.leftCols(count_));
    advanced_.swap(turned_);
    ++advanced_stages_;
  }
  // What lower levels cannot reach of the point; a faded direction by its share.
  column_.col(0) = y_;
  chain_.advance(column_);
  chain_.embed(column_);
  base_ = y_ - column_.col(0);

  const int first = whitened_.inequalityRowsAbove(level);
  const int rows = whitened_.inequalityRowsAbove(level + 1) - first;
  if (rows > 0) {
    constraints_.middleCols(count_, rows) = whitened_.inequalities().middleCols(first, rows);
    advanced_stages_ = 0;
    for (int j = count_; j < count_ + rows; ++j) {
      lower_[j] = -no_bound;
      upper_[j] = constraints_.col(j).dot(y_) + room * y_.norm();
    }
    count_ += rows;
  }
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

// Inequality rows that some level met; limits are no task's rows.
void Hqp::Solver::reportActive(TickSolution& solution) {
  for (const std::vector<int>& start : starts_)
    for (const int signed_row : start) {
      const int inequality = std::abs(signed_row) - 1 - limit_count_;
      if (inequality < 0) continue;
      const ActiveRow& row = whitened_.origin(whitened_.firstInequality() + inequality);
      std::vector<ActiveRow>& active = solution.levels[row.level].active;
      const auto same = [&](const ActiveRow& other) { return other.task == row.task && other.row == row.row; };
      if (std::any_of(active.begin(), active.end(), same)) continue;
      active.push_back(row);
      ++solution.rows_held;
    }
}

// By level and kind: how many, then the rows.
control::WarmStart Hqp::Solver::warmStart() const {
  control::WarmStart numbers;
  for (const std::vector<int>& start : starts_) {
    numbers.push_back(static_cast<int>(start.size()));
    numbers.insert(numbers.end(), start.begin(), start.end());
  }
  return numbers;
}

void Hqp::Solver::setWarmStart(const control::WarmStart& numbers) {
  std::size_t at = 0;
  for (std::vector<int>& start : starts_) {
    start.clear();
    if (at >= numbers.size()) continue;
    const int count = numbers[at++];
    for (int i = 0; i < count && at < numbers.size(); ++i, ++at)
      if (numbers[at] != 0 && start.size() < start.capacity()) start.push_back(numbers[at]);
  }
}

Hqp::Hqp(const HqpOptions& options)
    : BackEnd({.strict_levels = true,
               .inequalities = true,
               .torque_limits = true,
               .force_bounds = true,
               .friction_cones = true,
               .strict_first_level = true,
               .limits_at_levels = true}),
      options_(options) {}

Hqp::~Hqp() = default;

void Hqp::doPrepare(const TickProblem& shape) { solver_ = std::make_unique<Solver>(shape, options_); }
void Hqp::doSolve(const TickProblem& problem, TickSolution& solution) {
  solver_->solve(problem, deadline(), reportsRanks(), solution);
}
control::WarmStart Hqp::warmStart() const { return solver_->warmStart(); }
void Hqp::setWarmStart(const control::WarmStart& start) { solver_->setWarmStart(start); }

}  // namespace tactus::hqp
