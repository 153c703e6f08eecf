// A tick of the hierarchy: its limits, the levels from the top, and what each leaves to those below.
#include "plugins/hqp/solver.h"

#include <algorithm>
#include <cmath>

namespace tactus::hqp {

using control::ActiveRow;
using control::Status;
using control::TickLevel;
using control::TickTask;

namespace {

constexpr double room = 1e-12;                                     // for rounding, between a point and its bounds
constexpr double independence = 1e-13;                             // rows differ by as little as the price leaves of them
constexpr int rows_per_friction_contact = 3;

bool exceedsItsBounds(const TickTask& task) {
  return task.contact && task.rows > 0 && (task.friction || task.F().maxCoeff() > task.force_max);
}

}  // namespace

Hqp::Solver::Solver(const TickProblem& shape, const HqpOptions& options)
    : dof_(shape.dof),
      ranks_(shape, options.rank),
      whitened_(shape, options.objective),
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
      y_above_(shape.dof),
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
    y_above_ = y_;
    const Outcome outcome = solveLevel(problem, i);
    if (outcome == Outcome::solved) {
      holdLevel(i, solution);
      continue;
    }
    y_ = y_above_;
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
  auto limits = constraints_.leftCols(count_);
  for (int k = 0; k < dof_; ++k) {
    limits.row(k).head(k).setZero();
    limits.row(k).tail(dof_ - k) = L.col(k).tail(dof_ - k).cwiseQuotient(lengths.tail(dof_ - k)).transpose();
  }
  lower_.head(count_).setConstant(-no_bound);
  upper_.head(count_).setConstant(no_bound);
}

// From here on the limits bind.  False when what is held above does not fit: then they are relaxed by the least squares
// of their violations, or by those of the levels above where rounding leaves no way to find these.
bool Hqp::Solver::enterLimits(const TickProblem& problem) {
  auto products = products_.head(limit_count_);
  products.noalias() = y_.transpose() * constraints_.leftCols(limit_count_);
  lower_.head(limit_count_) = problem.torque_limits->lower.cwiseQuotient(limit_lengths_);
  upper_.head(limit_count_) = problem.torque_limits->upper.cwiseQuotient(limit_lengths_);
  bool fits = true;
  for (int i = 0; i < limit_count_; ++i) fits &= products[i] >= lower_[i] && products[i] <= upper_[i];
  if (fits) return true;
  const bool found = std::any_of(std::begin(free_prices), std::end(free_prices),
                                 [this](double of_free_directions) { return leastViolation(of_free_directions); });
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

}  // namespace tactus::hqp
