#include "plugins/qp/weighted_qp.h"

#include <algorithm>
#include <cmath>

namespace tactus::qp {

using control::ActiveRow;
using control::Relation;
using control::TickLevel;
using control::TickProblem;
using control::TickTask;
using control::WhitenedProblem;

namespace {

constexpr int rows_per_friction_contact = 3;
constexpr int limits_per_force = 4;                                // two bounds; a pyramid's four sides per three

int contactRows(const TickProblem& shape) {
  int rows = 0;
  for (const TickLevel& level : shape.levels)
    for (const TickTask& task : level.tasks)
      if (task.contact) rows += task.capacity();
  return rows;
}

}  // namespace

int WeightedQp::variableCapacity(const TickProblem& shape) { return shape.dof + contactRows(shape); }

int WeightedQp::inequalityCapacity(const TickProblem& shape) {
  return shape.rowCapacity() + 2 * shape.dof + limits_per_force * contactRows(shape);
}

int WeightedQp::objectiveCapacity(const TickProblem& shape) {
  return shape.rowCapacity() + shape.dof + contactRows(shape);
}

WeightedQp::WeightedQp(const TickProblem& shape, const WeightedQpOptions& options)
    : options_(options),
      dof_(shape.dof),
      weights_(shape.levels.size()),
      roles_(shape.rowCapacity()),
      variables_(shape.rowCapacity()),
      inequality_origins_(inequalityCapacity(shape)),
      own_(shape.dof, shape.levels.size()),
      has_own_(shape.levels.size()) {
  const int variables = variableCapacity(shape);
  programme_.F.resize(objectiveCapacity(shape), variables);
  programme_.t.resize(objectiveCapacity(shape));
  programme_.E.resize(contactRows(shape), variables);
  programme_.G.resize(inequalityCapacity(shape), variables);
  programme_.h.resize(inequalityCapacity(shape));
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
  programme_.objective_rows = programme_.equality_rows = programme_.inequality_rows = 0;
  addObjective(problem, whitened);
  addRowConstraints(whitened);
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
  programme_.F.leftCols(programme_.variables).setZero();
  if (options_.objective == Objective::torque)
    addTorqueObjective(whitened);
  else
    addAccelerationObjective(problem, whitened);
  for (int j = 0; j < whitened.rowCount(); ++j) {
    if (variables_[j] < 0) continue;
    const ActiveRow& at = whitened.origin(j);
    const int row = programme_.objective_rows++;
    programme_.F(row, variables_[j]) = std::sqrt(options_.force_weight) / forceScale(whitened, j);
    programme_.t[row] = std::sqrt(options_.force_weight) * problem.levels[at.level].tasks[at.task].force[at.row];
  }
}

void WeightedQp::addTorqueObjective(const WhitenedProblem& whitened) {
  double inverse = 0;
  for (std::size_t i = 0; i < weights_.size(); ++i)
    if (has_own_[i]) inverse += 1 / weights_[i];
  const double root = inverse > 0 ? std::sqrt(1 / inverse) : 1;
  auto F = programme_.F.topLeftCorner(dof_, dof_);
  if (options_.metric == Metric::identity)
    F = root * Eigen::MatrixXd(whitened.massFactor().triangularView<Eigen::Lower>());
  else
    F.diagonal().setConstant(root);
  programme_.t.head(dof_) = F * own_.rowwise().sum();
  programme_.objective_rows = dof_;
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
    programme_.F.row(row).head(dof_) = scale * norm * whitened.row(j).transpose();
    programme_.t[row] = task.has_acceleration ? scale * task.acceleration[at.row]
                                              : programme_.F.row(row).head(dof_).dot(own_.col(at.level));
  }
  const double least = weights_.empty() ? 1 : *std::min_element(weights_.begin(), weights_.end());
  programme_.F.block(programme_.objective_rows, 0, dof_, dof_).diagonal().setConstant(
      std::sqrt(options_.regularisation * least));
  programme_.t.segment(programme_.objective_rows, dof_).setZero();
  programme_.objective_rows += dof_;
}

void WeightedQp::addRowConstraints(const WhitenedProblem& whitened) {
  for (int j = 0; j < whitened.rowCount(); ++j) {
    const bool inequality = j >= whitened.firstInequality() || roles_[j] == Role::backing_off;
    if (roles_[j] == Role::dropped) continue;
    if (inequality) {
      newInequality(0, j).head(dof_) = whitened.row(j).transpose();
    } else if (roles_[j] == Role::force) {
      auto row = programme_.E.row(programme_.equality_rows++).head(programme_.variables);
      row.setZero();
      row.head(dof_) = whitened.row(j).transpose();
    }
  }
}

void WeightedQp::addTorqueLimits(const TickProblem& problem, const WhitenedProblem& whitened) {
  for (int i = 0; i < dof_; ++i)
    for (const double sign : {1.0, -1.0}) {
      const double bound = sign > 0 ? problem.torque_limits->upper[i] : -problem.torque_limits->lower[i];
      if (!std::isfinite(bound)) continue;
      auto row = newInequality(bound, -1);
      row.head(i + 1) = sign * whitened.massFactor().row(i).head(i + 1);
      for (int j = 0; j < whitened.rowCount(); ++j) {
        if (variables_[j] < 0) continue;
        const ActiveRow& at = whitened.origin(j);
        row[variables_[j]] =
            sign * problem.levels[at.level].tasks[at.task].jacobian(at.row, i) / forceScale(whitened, j);
      }
      normaliseLast();
    }
}

void WeightedQp::addForceBounds(const TickProblem& problem, const WhitenedProblem& whitened) {
  for (int j = 0; j < whitened.rowCount(); ++j) {
    if (variables_[j] < 0) continue;
    const ActiveRow& at = whitened.origin(j);
    const TickTask& task = problem.levels[at.level].tasks[at.task];
    const int place = task.friction ? at.row % rows_per_friction_contact : 0;
    if (place != 0) continue;
    newInequality(0, -1)[variables_[j]] = -1;
    if (std::isfinite(task.force_max)) newInequality(task.force_max * forceScale(whitened, j), -1)[variables_[j]] = 1;
    if (!task.friction) continue;
    for (const double s1 : {1.0, -1.0})
      for (const double s2 : {1.0, -1.0}) {
        auto row = newInequality(0, -1);
        row[variables_[j]] = -*task.friction / forceScale(whitened, j);
        row[variables_[j] + 1] = s1 / forceScale(whitened, j + 1);
        row[variables_[j] + 2] = s2 / forceScale(whitened, j + 2);
        normaliseLast();
      }
  }
}

Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> WeightedQp::newInequality(double bound, int origin) {
  const int row = programme_.inequality_rows++;
  programme_.h[row] = bound;
  inequality_origins_[row] = origin;
  programme_.G.row(row).head(programme_.variables).setZero();
  return programme_.G.row(row).head(programme_.variables);
}

void WeightedQp::normaliseLast() {
  const int row = programme_.inequality_rows - 1;
  const double norm = programme_.G.row(row).head(programme_.variables).norm();
  programme_.G.row(row).head(programme_.variables) /= norm;
  programme_.h[row] /= norm;
}

int WeightedQp::answer(const TickProblem& problem, const WhitenedProblem& whitened, const Eigen::VectorXd& x,
                       Eigen::VectorXd& torque, Eigen::VectorXd& forces) const {
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
