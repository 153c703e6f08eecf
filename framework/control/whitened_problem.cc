#include "framework/control/whitened_problem.h"

#include <cmath>

#include "framework/control/strips.h"

namespace tactus::control {
namespace {

constexpr int whole_strip = 16;

/// a ← L⁻¹ a for a strip of columns; zeros of L, which a tree of bodies has, cost nothing.
template <int width>
void forwardStrip(const Eigen::MatrixXd& L, double* a, Eigen::Index stride) {
  for (int i = 0; i < L.rows(); ++i) {
    Strip<width> w = Eigen::Map<const Strip<width>>(a + i * stride);
    for (int k = 0; k < i; ++k)
      if (L(i, k) != 0) w -= L(i, k) * Eigen::Map<const Strip<width>>(a + k * stride);
    Eigen::Map<Strip<width>>(a + i * stride) = w / L(i, i);
  }
}

}  // namespace

WhitenedProblem::WhitenedProblem(const TickProblem& shape, const ObjectiveOptions& objective)
    : objective_(objective),
      dof_(shape.dof),
      levels_(shape.levels.size()),
      origins_(shape.rowCapacity()),
      cholesky_(shape.dof),
      columns_(RowMajorMatrix::Zero(shape.dof, (shape.rowCapacity() + whole_strip - 1) / whole_strip * whole_strip)),
      norms_(shape.rowCapacity()),
      forces_(shape.rowCapacity()),
      bears_(shape.rowCapacity()),
      own_torques_(shape.dof, shape.levels.size()),
      products_(shape.rowCapacity()),
      borne_torques_(shape.dof, shape.levels.size() + 1),
      from_own_(shape.dof) {}

bool WhitenedProblem::update(const TickProblem& problem) {
  cholesky_.compute(problem.mass_matrix);
  if (cholesky_.info() != Eigen::Success) return false;
  gather(problem);
  whiten();
  own_torques_.setZero();
  for (int j = 0; j < count_; ++j)
    if (forces_[j] != 0) own_torques_.col(origins_[j].level) += forces_[j] * columns_.col(j);
  borne_torques_.setZero();
  for (int j = 0; j < count_; ++j)
    if (bears_[j]) borne_torques_.col(origins_[j].level + 1) += forces_[j] * columns_.col(j);
  for (int i = 1; i <= levelCount(); ++i) borne_torques_.col(i) += borne_torques_.col(i - 1);
  auto A = columns_.leftCols(count_);
  auto norms = norms_.head(count_);
  auto lengths = products_.head(count_);
  lengths.setZero();
  for (int k = 0; k < dof_; ++k) lengths += A.row(k).cwiseAbs2();
  norms = lengths.transpose().cwiseSqrt();
  if (!norms.allFinite()) return false;
  lengths = (norms.array() > 0).select(norms, 1.0).transpose();
  for (int k = 0; k < dof_; ++k) A.row(k).array() /= lengths.array();
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
          bears_[count_] = task.contact && task.force[row] > 0;
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

// Forward substitution L Aᵀ = Jᵀ for all rows; the last strip may reach beyond them, into columns that nobody reads.
void WhitenedProblem::whiten() {
  for (int j = 0; j < count_; j += whole_strip)
    forwardStrip<whole_strip>(massFactor(), columns_.data() + j, columns_.outerStride());
}

int WhitenedProblem::inequalityRowsAbove(int level) const {
  return level == levelCount() ? inequality_count_ : levels_[level].first_inequality - first_inequality_;
}

void WhitenedProblem::toTorque(const Eigen::VectorXd& y, Eigen::VectorXd& torque) const {
  torque.noalias() = massFactor().triangularView<Eigen::Lower>() * y;
}

// Calls f(j, asked, reached) for each row that the level asks something of: what it asks for in the row's own units, and
// the unit row's product with y.  Of a task that asks for what its own torque y° does, 0 and the product with y − y°.
// Balanced, y and y° are without what contacts bear, of this level and those above.
template <typename F>
void WhitenedProblem::forEachObjective(const TickProblem& problem, int level, const Eigen::VectorXd& y, bool balanced,
                                       const F& f) {
  for (const Relation relation : {Relation::equality, Relation::inequality}) {
    const bool equality = relation == Relation::equality;
    int first = equality ? levels_[level].first_equality : levels_[level].first_inequality;
    for (const TickTask& task : problem.levels[level].tasks) {
      if (task.relation != relation) continue;
      auto reached = products_.head(task.rows);
      from_own_ = y;
      if (!task.has_acceleration) from_own_ -= own_torques_.col(level);
      if (balanced) from_own_ -= borne_torques_.col(task.has_acceleration ? level + 1 : level);
      reached.noalias() = from_own_.transpose() * columns_.middleCols(first, task.rows);
      for (int row = 0; row < task.rows; ++row)
        if (equality || forces_[first + row] != 0)
          f(first + row, task.has_acceleration ? task.acceleration[row] : 0, reached[row]);
      first += task.rows;
    }
  }
}

int WhitenedProblem::gatherObjective(const TickProblem& problem, int level, const Eigen::VectorXd& y,
                                     RowMajorMatrix& columns, Eigen::VectorXd& b, Eigen::VectorXd& weights) {
  const LevelRows& rows = levels_[level];
  columns.leftCols(rows.equalities) = equalities(level);
  int count = 0;
  const bool by_inertia = objective_.metric == RowMetric::inertia;
  forEachObjective(problem, level, y, balanced(), [&](int j, double asked, double reached) {
    if (count >= rows.equalities) columns.col(count) = columns_.col(j);
    weights[count] = by_inertia || !(norms_[j] > 0) ? 1 : norms_[j];
    b[count++] = (norms_[j] > 0 ? asked / norms_[j] : 0) - reached;
  });
  if (!damps(level) || count == 0) return count;
  columns.middleCols(count, dof_).setIdentity();
  b.segment(count, dof_) = -y;
  weights.segment(count, dof_).setConstant(objective_.damping * weights.head(count).maxCoeff());
  return count + dof_;
}

void WhitenedProblem::objectiveLeft(const TickProblem& problem, int level, const Eigen::VectorXd& y,
                                    Eigen::VectorXd& b) {
  int count = 0;
  forEachObjective(problem, level, y, balanced(), [&](int j, double asked, double reached) {
    b[count++] = (norms_[j] > 0 ? asked / norms_[j] : 0) - reached;
  });
  if (damps(level) && count > 0) b.segment(count, dof_) = -y;
}

void WhitenedProblem::reportResiduals(const TickProblem& problem, const Eigen::VectorXd& y, TickSolution& solution) {
  for (int i = 0; i < levelCount(); ++i) {
    double sum = 0;
    forEachObjective(problem, i, y, false, [&](int j, double asked, double reached) {
      const double r = norms_[j] * reached - asked;
      sum += r * r;
    });
    solution.levels[i].residual = std::sqrt(sum);
  }
}

}  // namespace tactus::control
