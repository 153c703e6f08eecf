#include "plugins/qp/weighted_qp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tactus::qp {

using control::ActiveRow;
using control::Relation;
using control::TickLevel;
using control::TickProblem;
using control::TickTask;
using control::WhitenedProblem;

namespace {

constexpr int rows_per_friction_contact = 3;
constexpr double no_bound = std::numeric_limits<double>::infinity();

int contactRows(const TickProblem& shape) {
  int rows = 0;
  for (const TickLevel& level : shape.levels)
    for (const TickTask& task : level.tasks)
      if (task.contact) rows += task.capacity();
  return rows;
}

}  // namespace

int WeightedQp::variableCapacity(const TickProblem& shape) { return shape.dof + contactRows(shape); }

int WeightedQp::rowCapacity(const TickProblem& shape, const WeightedQpOptions& options) {
  // Of three rows with friction one has bounds, and each edge has a side.
  return shape.rowCapacity() + shape.dof + contactRows(shape) * (1 + options.friction_edges);
}

int WeightedQp::objectiveCapacity(const TickProblem& shape) { return shape.rowCapacity(); }

WeightedQp::WeightedQp(const TickProblem& shape, const WeightedQpOptions& options)
    : options_(options),
      dof_(shape.dof),
      weights_(shape.levels.size()),
      roles_(shape.rowCapacity()),
      variables_(shape.rowCapacity()),
      origins_(rowCapacity(shape, options)),
      own_(shape.dof, shape.levels.size()),
      has_own_(shape.levels.size()) {
  const int variables = variableCapacity(shape);
  const int rows = rowCapacity(shape, options);
  programme_.dense = dof_;
  programme_.F.resize(objectiveCapacity(shape), dof_);
  programme_.t.resize(objectiveCapacity(shape));
  programme_.ridge.resize(variables);
  programme_.reference.resize(variables);
  programme_.A.resize(variables, rows);
  programme_.lower.resize(rows);
  programme_.upper.resize(rows);
}

bool WeightedQp::torqueCoordinates() const {
  return options_.objective == Objective::torque && options_.metric == Metric::identity;
}

// A contact with friction is one thing: where its normal force backs off, its tangential rows hold nothing.
WeightedQp::Role WeightedQp::role(const TickTask& task, int row) {
  if (!task.contact) return Role::task;
  const int normal = task.friction ? row - row % rows_per_friction_contact : row;
  if (task.force[normal] >= 0) return Role::force;
  return row == normal ? Role::backing_off : Role::dropped;
}

void WeightedQp::build(const TickProblem& problem, const WhitenedProblem& whitened) {
  force_count_ = 0;
  own_.setZero();
  has_own_.assign(has_own_.size(), false);
  for (int j = 0; j < whitened.rowCount(); ++j) {
    const ActiveRow& at = whitened.origin(j);
    const TickTask& task = problem.levels[at.level].tasks[at.task];
    roles_[j] = role(task, at.row);
    variables_[j] = roles_[j] == Role::force ? dof_ + force_count_++ : -1;
    if (roles_[j] == Role::force) continue;
    own_.col(at.level) += task.force[at.row] * whitened.norm(j) * whitened.row(j);
    has_own_[at.level] = true;
  }
  programme_.variables = dof_ + force_count_;
  programme_.objective_rows = programme_.rows = 0;
  addObjective(problem, whitened);
  addEqualities(whitened);
  addInequalities(whitened);
  if (torqueCoordinates()) toCoordinates(whitened);
  if (problem.torque_limits) addTorqueLimits(problem, whitened);
  addForceBounds(problem, whitened);
}

// φ over f; a row without effect has no size of its own.
double WeightedQp::forceScale(const WhitenedProblem& whitened, int j) const {
  return whitened.norm(j) > 0 ? whitened.norm(j) : 1;
}

void WeightedQp::addObjective(const TickProblem& problem, const WhitenedProblem& whitened) {
  double weight = 1;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    if (i > 0) weight /= options_.weight_ratio;
    weight = problem.levels[i].weight.value_or(weight);
    weights_[i] = weight;
  }
  if (options_.objective == Objective::torque)
    addTorqueObjective(whitened);
  else
    addAccelerationObjective(problem, whitened);
  const double root = std::sqrt(options_.force_weight);
  for (int j = 0; j < whitened.rowCount(); ++j) {
    if (variables_[j] < 0) continue;
    const ActiveRow& at = whitened.origin(j);
    const double scale = forceScale(whitened, j);
    programme_.ridge[variables_[j]] = root / scale;
    programme_.reference[variables_[j]] = problem.levels[at.level].tasks[at.task].force[at.row] * scale;
  }
}

void WeightedQp::addTorqueObjective(const WhitenedProblem& whitened) {
  double inverse = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i)
    if (has_own_[i]) inverse += 1 / weights_[i];
  programme_.ridge.head(dof_).setConstant(inverse > 0 ? std::sqrt(1 / inverse) : 1);
  auto reference = programme_.reference.head(dof_);
  reference = own_.rowwise().sum();
  if (torqueCoordinates()) {
    const auto& L = whitened.massFactor();
    for (int i = dof_ - 1; i >= 0; --i) reference[i] = L.row(i).head(i + 1).dot(reference.head(i + 1));
  }
}

void WeightedQp::addAccelerationObjective(const TickProblem& problem, const WhitenedProblem& whitened) {
  for (int j = 0; j < whitened.rowCount(); ++j) {
    const ActiveRow& at = whitened.origin(j);
    const TickTask& task = problem.levels[at.level].tasks[at.task];
    if (roles_[j] == Role::force || roles_[j] == Role::dropped) continue;
    const bool bound_only = (task.relation == Relation::inequality || roles_[j] == Role::backing_off) &&
                            task.force[at.row] == 0;
    if (bound_only) continue;
    const int row = programme_.objective_rows++;
    const double root = std::sqrt(weights_[at.level]);
    const double norm = whitened.norm(j);                          // √(J M⁻¹ Jᵀ); whitened rows have length 1
    const double scale = options_.metric == Metric::identity ? root : norm > 0 ? root / norm : 0;
    programme_.F.row(row) = scale * norm * whitened.row(j).transpose();
    programme_.t[row] = task.has_acceleration ? scale * task.acceleration[at.row]
                                              : programme_.F.row(row).dot(own_.col(at.level));
  }
  const double least = weights_.empty() ? 1 : *std::min_element(weights_.begin(), weights_.end());
  programme_.ridge.head(dof_).setConstant(std::sqrt(options_.regularisation * least));
  programme_.reference.head(dof_).setZero();
}

void WeightedQp::addEqualities(const WhitenedProblem& whitened) {
  for (int j = 0; j < whitened.firstInequality(); ++j)
    if (roles_[j] == Role::force) programme_.row(newRow(0, 0, j)).head(dof_) = whitened.row(j);
}

void WeightedQp::addInequalities(const WhitenedProblem& whitened) {
  for (int j = 0; j < whitened.rowCount(); ++j) {
    const bool inequality = j >= whitened.firstInequality() || roles_[j] == Role::backing_off;
    if (inequality && roles_[j] != Role::dropped) programme_.row(newRow(-no_bound, 0, j)).head(dof_) = whitened.row(j);
  }
}

// Rows so far multiply y = L⁻¹ τ; now τ: a L⁻¹, by back substitution for all of them at once.
void WeightedQp::toCoordinates(const WhitenedProblem& whitened) {
  const auto& L = whitened.massFactor();
  auto rows = programme_.A.leftCols(programme_.rows);
  for (int i = dof_ - 1; i >= 0; --i) {
    for (int k = i + 1; k < dof_; ++k)
      if (L(k, i) != 0) rows.row(i) -= L(k, i) * rows.row(k);
    rows.row(i) /= L(i, i);
  }
}

void WeightedQp::addTorqueLimits(const TickProblem& problem, const WhitenedProblem& whitened) {
  const int first = programme_.rows;
  for (int i = 0; i < dof_; ++i) newRow(problem.torque_limits->lower[i], problem.torque_limits->upper[i], -1);
  auto rows = programme_.A.middleCols(first, dof_);
  if (torqueCoordinates())
    rows.topRows(dof_).diagonal().setOnes();
  else
    rows.topRows(dof_) = whitened.massFactor().triangularView<Eigen::Lower>().transpose();
  for (int j = 0; j < whitened.rowCount(); ++j) {
    if (variables_[j] < 0) continue;
    const ActiveRow& at = whitened.origin(j);
    rows.row(variables_[j]) =
        problem.levels[at.level].tasks[at.task].jacobian.row(at.row) / forceScale(whitened, j);
  }
}

void WeightedQp::addForceBounds(const TickProblem& problem, const WhitenedProblem& whitened) {
  const double half_angle = std::numbers::pi / options_.friction_edges;
  for (int j = 0; j < whitened.rowCount(); ++j) {
    if (variables_[j] < 0) continue;
    const ActiveRow& at = whitened.origin(j);
    const TickTask& task = problem.levels[at.level].tasks[at.task];
    const int place = task.friction ? at.row % rows_per_friction_contact : 0;
    if (place != 0) continue;
    programme_.row(newRow(0, task.force_max * forceScale(whitened, j), -1))[variables_[j]] = 1;
    if (!task.friction) continue;
    for (int edge = 0; edge < options_.friction_edges; ++edge) {
      // The side between two edges: its normal points half an angle further, at cos(half angle) of their distance.
      const double angle = (2 * edge + 1) * half_angle;
      auto row = programme_.row(newRow(-no_bound, 0, -1));
      row[variables_[j]] = -*task.friction * std::cos(half_angle) / forceScale(whitened, j);
      row[variables_[j] + 1] = std::cos(angle) / forceScale(whitened, j + 1);
      row[variables_[j] + 2] = std::sin(angle) / forceScale(whitened, j + 2);
    }
  }
}

int WeightedQp::newRow(double lower, double upper, int origin) {
  const int row = programme_.rows++;
  programme_.lower[row] = lower;
  programme_.upper[row] = upper;
  origins_[row] = origin;
  programme_.row(row).setZero();
  return row;
}

int WeightedQp::answer(const TickProblem& problem, const WhitenedProblem& whitened, const Eigen::VectorXd& x,
                       Eigen::VectorXd& torque, Eigen::VectorXd& forces) const {
  if (torqueCoordinates())
    torque = x.head(dof_);
  else
    torque.noalias() = whitened.massFactor().triangularView<Eigen::Lower>() * x.head(dof_);
  // Equality and inequality contacts may alternate in the problem: each force finds its place by its origin.
  int count = 0;
  for (std::size_t i = 0; i < problem.levels.size(); ++i)
    for (std::size_t t = 0; t < problem.levels[i].tasks.size(); ++t) {
      const TickTask& task = problem.levels[i].tasks[t];
      if (!task.contact) continue;
      forces.segment(count, task.rows) = task.F();
      for (int j = 0; j < whitened.rowCount(); ++j) {
        const ActiveRow& at = whitened.origin(j);
        if (variables_[j] < 0 || at.level != static_cast<int>(i) || at.task != static_cast<int>(t)) continue;
        const double force = x[variables_[j]] / forceScale(whitened, j);
        forces[count + at.row] = force;
        torque += force * task.jacobian.row(at.row).transpose();
      }
      count += task.rows;
    }
  return count;
}

}  // namespace tactus::qp
