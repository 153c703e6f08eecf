#include "framework/control/whitened_problem.h"

#include <cmath>

namespace tactus::control {

WhitenedProblem::WhitenedProblem(const TickProblem& shape)
    : dof_(shape.dof),
      levels_(shape.levels.size()),
      origins_(shape.rowCapacity()),
      cholesky_(shape.dof),
      columns_(shape.dof, shape.rowCapacity()),
      norms_(shape.rowCapacity()),
      forces_(shape.rowCapacity()),
      own_torques_(shape.dof, shape.levels.size()),
      products_(shape.rowCapacity()) {}

bool WhitenedProblem::update(const TickProblem& problem) {
  cholesky_.compute(problem.mass_matrix);
  if (cholesky_.info() != Eigen::Success) return false;
  gather(problem);
  whiten();
  own_torques_.setZero();
  for (int j = 0; j < count_; ++j)
    if (forces_[j] != 0) own_torques_.col(origins_[j].level) += forces_[j] * columns_.col(j);
  for (int j = 0; j < count_; ++j) {
    norms_[j] = columns_.col(j).norm();
    if (!std::isfinite(norms_[j])) return false;
    if (norms_[j] > 0) columns_.col(j) /= norms_[j];
  }
  return own_torques_.allFinite() && massFactor().diagonal().allFinite();
}

// Equality rows level by level, then inequality rows level by level.
void WhitenedProblem::gather(const TickProblem& problem) {
  count_ = 0;
  for (const Relation relation : {Relation::equality, Relation::inequality}) {
    if (relation == Relation::inequality) first_inequality_ = count_;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      const int first = count_;
      const std::vector<TickTask>& tasks = problem.levels[i].tasks;
      for (std::size_t t = 0; t < tasks.size(); ++t) {
        const TickTask& task = tasks[t];
        if (task.relation != relation) continue;
        for (int row = 0; row < task.rows; ++row, ++count_) {
          origins_[count_] = {static_cast<int>(i), static_cast<int>(t), row};
          forces_[count_] = task.force[row];
        }
        columns_.middleCols(count_ - task.rows, task.rows) = task.J().transpose();
      }
      if (relation == Relation::equality) {
        levels_[i].first_equality = first;
        levels_[i].equalities = count_ - first;
      } else {
        levels_[i].first_inequality = first;
        levels_[i].inequalities = count_ - first;
      }
    }
  }
  inequality_count_ = count_ - first_inequality_;
}

// Forward substitution L Aᵀ = Jᵀ for all rows at once; zeros of L, which a tree of bodies has, cost nothing.
void WhitenedProblem::whiten() {
  const Eigen::MatrixXd& L = massFactor();
  auto A = columns_.leftCols(count_);
  for (int i = 0; i < dof_; ++i) {
    for (int j = 0; j < i; ++j)
      if (L(i, j) != 0) A.row(i) -= L(i, j) * A.row(j);
    A.row(i) /= L(i, i);
  }
}

int WhitenedProblem::inequalityRowsAbove(int level) const {
  return level == levelCount() ? inequality_count_ : levels_[level].first_inequality - first_inequality_;
}

void WhitenedProblem::toTorque(const Eigen::VectorXd& y, Eigen::VectorXd& torque) const {
  torque.noalias() = massFactor().triangularView<Eigen::Lower>() * y;
}

int WhitenedProblem::gatherObjective(const TickProblem& problem, int level, const Eigen::VectorXd& y,
                                     RowMajorMatrix& columns, Eigen::VectorXd& b, Eigen::VectorXd& weights) const {
  const LevelRows& rows = levels_[level];
  int count = 0;
  const auto add = [&](int j) {
    const ActiveRow& at = origins_[j];
    const TickTask& task = problem.levels[at.level].tasks[at.task];
    columns.col(count) = columns_.col(j);
    weights[count] = norms_[j] > 0 ? norms_[j] : 1;
    b[count] = task.has_acceleration ? (norms_[j] > 0 ? task.acceleration[at.row] / norms_[j] : 0)
                                     : columns_.col(j).dot(own_torques_.col(level));
    b[count++] -= columns_.col(j).dot(y);
  };
  for (int j = rows.first_equality; j < rows.first_equality + rows.equalities; ++j) add(j);
  for (int j = rows.first_inequality; j < rows.first_inequality + rows.inequalities; ++j)
    if (forces_[j] != 0) add(j);
  return count;
}

void WhitenedProblem::reportResiduals(const TickProblem& problem, const Eigen::VectorXd& y, TickSolution& solution) {
  for (int i = 0; i < levelCount(); ++i) {
    const LevelRows& rows = levels_[i];
    double sum = 0;
    const auto add = [&](int first, int count, bool with_force_alone) {
      auto products = products_.head(count);                       // A (y − y°)
      products.setZero();
      for (int k = 0; k < dof_; ++k)
        products += (y[k] - own_torques_(k, i)) * columns_.row(k).segment(first, count);
      for (int j = first; j < first + count; ++j) {
        if (with_force_alone && forces_[j] == 0) continue;
        const ActiveRow& at = origins_[j];
        const TickTask& task = problem.levels[at.level].tasks[at.task];
        const double r = task.has_acceleration ? norms_[j] * columns_.col(j).dot(y) - task.acceleration[at.row]
                                               : norms_[j] * products[j - first];
        sum += r * r;
      }
    };
    add(rows.first_equality, rows.equalities, false);
    add(rows.first_inequality, rows.inequalities, true);
    solution.levels[i].residual = std::sqrt(sum);
  }
}

}  // namespace tactus::control
