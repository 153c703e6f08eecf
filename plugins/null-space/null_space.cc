#include "plugins/null-space/null_space.h"

#include <algorithm>
#include <cmath>

#include "framework/control/level_ranks.h"
#include "framework/control/torque_scaling.h"

namespace tactus::null_space {

using control::ActiveRow;
using control::PriorityFactor;
using control::RowMajorMatrix;
using control::Status;
using control::TickProblem;
using control::TickSolution;

struct NullSpace::Workspace {
  Workspace(const TickProblem& shape, const NullSpaceOptions& options)
      : problem(shape, options.objective),
        chain(shape.dof, shape.rowCapacity() + shape.dof, static_cast<int>(shape.levels.size()) + 1, options.rank),
        single(shape.dof, shape.rowCapacity(), 2, options.rank),
        projection(shape.dof, shape.rowCapacity(), options.inequalities, options.rank, options.release_rows),
        rows(shape.dof, shape.rowCapacity() + shape.dof),
        inequalities(shape.dof, shape.rowCapacity()),
        target(rows.cols()),
        weights(rows.cols()),
        torque(shape.dof, 1),
        total(shape.dof) {}

  control::WhitenedProblem problem;
  PriorityFactor chain;                                            // equality rows of all levels, from the top
  PriorityFactor single;                                           // of one level alone
  Projection projection;
  RowMajorMatrix rows;                                             // equality rows on their way into a factor
  RowMajorMatrix inequalities;                                     // taken through the factor's stages
  Eigen::VectorXd target;                                          // what a level asks for, row by row
  Eigen::VectorXd weights;                                         // and the rows' norms
  RowMajorMatrix torque;                                           // the one that is being projected
  Eigen::VectorXd total;                                           // L⁻¹ τ
  control::LeastDistance::TimePoint end;                           // of this tick's deadline
};

NullSpace::NullSpace(const NullSpaceOptions& options)
    : BackEnd({.strict_levels = options.cascade != Cascade::successive,
               .inequalities = true,
               .strict_first_level = true,
               .why_not_strict = "the successive cascade keeps only its first level strictly"}),
      options_(options) {}

NullSpace::~NullSpace() = default;

void NullSpace::doPrepare(const TickProblem& shape) { work_ = std::make_unique<Workspace>(shape, options_); }

void NullSpace::doSolve(const TickProblem& problem, TickSolution& solution) {
  Workspace& work = *work_;
  control::resetSolution(problem, solution);
  if (!work.problem.update(problem)) {
    solution.status = Status::failed;
    solution.message = "the mass matrix is not positive definite, or a Jacobian or force is not finite";
    return;
  }
  work.total.setZero();
  work.end = deadline().end();
  switch (options_.cascade) {
    case Cascade::augmented: augmented(solution); break;
    case Cascade::successive: successive(solution); break;
    case Cascade::consistent: consistent(problem, solution); break;
  }

  work.problem.toTorque(work.total, solution.torque);
  const bool overflows = !solution.torque.allFinite();
  if (overflows) {
    solution.torque.setZero();
    work.total.setZero();
  }
  if (problem.torque_limits) {
    const control::TorqueScaling scaling = control::scaleIntoLimits(*problem.torque_limits, solution.torque);
    solution.scale = scaling.scale;
    work.total *= scaling.scale;
    if (!scaling.possible) {
      solution.status = Status::infeasible;
      solution.message = "no multiple of the torque lies within the torque limits";
    }
  }
  if (overflows) {
    solution.status = Status::failed;
    solution.message = "the torque overflows: Jacobians, forces or masses are too large or too small to work with";
  }
  work.problem.reportResiduals(problem, work.total, solution);
}

void NullSpace::augmented(TickSolution& solution) {
  Workspace& work = *work_;
  const int levels = work.problem.levelCount();
  const int all = work.problem.inequalityRowsAbove(levels);
  auto inequalities = work.inequalities.leftCols(all);
  inequalities = work.problem.inequalities();
  work.chain.reset();
  for (int i = 0; i < levels; ++i) {
    work.torque = work.problem.ownTorque(i);
    if (i > 0) project(work.chain, 0, work.problem.inequalityRowsAbove(i), solution);
    work.total += work.torque;

    auto rows = work.rows.leftCols(work.problem.equalityRows(i));
    rows = work.problem.equalities(i);
    work.chain.advance(rows);
    control::LevelRanks::write(work.chain.hold(rows), i, work.problem.dof(), solution);
    if (i + 1 < levels) work.chain.advance(i, inequalities);
  }
}

void NullSpace::consistent(const TickProblem& problem, TickSolution& solution) {
  Workspace& work = *work_;
  const int levels = work.problem.levelCount();
  auto inequalities = work.inequalities.leftCols(work.problem.inequalityRowsAbove(levels));
  inequalities = work.problem.inequalities();
  work.chain.reset();
  for (int i = 0; i < levels; ++i) {
    // What the level asks for, in the directions that the equality rows above leave.
    const int count = work.problem.gatherObjective(problem, i, work.total, work.rows, work.target, work.weights);
    auto wanted = work.rows.leftCols(count);
    work.chain.advance(wanted);
    work.chain.hold(wanted);
    work.chain.leastSquares(wanted, work.target.head(count), work.weights.head(count), work.torque.col(0));
    work.chain.turnBack(i, work.torque);
    work.chain.dropLastStage();
    for (int stage = i - 1; stage >= 0; --stage) work.chain.bringBack(stage, work.torque);
    if (i > 0 && work.problem.inequalityRowsAbove(i) > 0)
      project(work.chain, 0, work.problem.inequalityRowsAbove(i), solution);
    work.total += work.torque;

    auto rows = work.rows.leftCols(work.problem.equalityRows(i));
    rows = work.problem.equalities(i);
    work.chain.advance(rows);
    control::LevelRanks::write(work.chain.hold(rows), i, work.problem.dof(), solution);
    if (i + 1 < levels) work.chain.advance(i, inequalities);
  }
}

void NullSpace::successive(TickSolution& solution) {
  Workspace& work = *work_;
  const int levels = work.problem.levelCount();
  work.chain.reset();
  for (int i = 0; i < levels; ++i) {
    auto rows = work.rows.leftCols(work.problem.equalityRows(i));
    rows = work.problem.equalities(i);
    work.chain.advance(rows);
    control::LevelRanks::write(work.chain.hold(rows), i, work.problem.dof(), solution);
  }
  for (int i = levels - 1; i >= 0; --i) {
    if (i + 1 < levels) {
      auto rows = work.rows.leftCols(work.problem.equalityRows(i));
      rows = work.problem.equalities(i);
      work.single.reset();
      work.single.hold(rows);
      const int first = work.problem.inequalityRowsAbove(i);
      const int count = work.problem.inequalityRowsAbove(i + 1) - first;
      auto inequalities = work.inequalities.middleCols(first, count);
      inequalities = work.problem.inequalities().middleCols(first, count);
      work.single.advance(0, inequalities);
      work.torque = work.total;
      project(work.single, first, count, solution);
      work.total = work.torque;
    }
    work.total += work.problem.ownTorque(i);
  }
}

// Projects work.torque onto what `factor` holds and these inequality rows, and notes which of them came to be held.
void NullSpace::project(PriorityFactor& factor, int first_inequality, int inequalities, TickSolution& solution) {
  Workspace& work = *work_;
  work.projection.limit(deadline().iterations - solution.iterations, work.end);
  work.projection.apply(factor, work.inequalities.middleCols(first_inequality, inequalities),
                        work.problem.inequalities().middleCols(first_inequality, inequalities), work.torque);
  const Projection::Counts& counts = work.projection.counts();
  if (counts.failed) {
    solution.status = Status::failed;
    solution.late |= counts.late;
    solution.message = counts.late ? "the deadline came before the inequality rows were settled; a level was left out"
                                   : "the inequality rows were not settled in the bounded number of steps; a level was "
                                     "left out";
  }
  solution.iterations += counts.steps;
  solution.rows_held += counts.held;
  solution.rows_released += counts.released;
  for (int i = 0; i < counts.held; ++i) {
    const ActiveRow& row =
        work.problem.origin(work.problem.firstInequality() + first_inequality + work.projection.heldRow(i));
    std::vector<ActiveRow>& active = solution.levels[row.level].active;
    const auto same = [&](const ActiveRow& other) { return other.task == row.task && other.row == row.row; };
    if (std::none_of(active.begin(), active.end(), same)) active.push_back(row);
  }
}

}  // namespace tactus::null_space
