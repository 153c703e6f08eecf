#include "framework/control/level_ranks.h"

#include <algorithm>

namespace tactus::control {

void resetSolution(const TickProblem& problem, TickSolution& solution) {
  solution.status = Status::ok;
  solution.message.clear();
  solution.torque.setZero();
  solution.n_contact_forces = 0;
  solution.scale = 1;
  solution.late = false;
  solution.has_kkt = false;
  solution.iterations = 0;
  solution.rows_held = solution.rows_released = solution.rank_deficient_levels = 0;
  for (LevelReport& level : solution.levels) {
    level.rank = 0;
    level.nullity = problem.dof;
    level.residual = 0;
    level.active.clear();
  }
}

LevelRanks::LevelRanks(const TickProblem& shape, RankOptions options)
    : factor_(shape.dof, shape.rowCapacity(), static_cast<int>(shape.levels.size()), options),
      rows_(shape.dof, shape.rowCapacity()) {}

void LevelRanks::report(const WhitenedProblem& problem, TickSolution& solution) {
  factor_.reset();
  solution.rank_deficient_levels = 0;
  for (int i = 0; i < problem.levelCount(); ++i) {
    auto rows = rows_.leftCols(problem.equalityRows(i));
    rows = problem.equalities(i);
    factor_.advance(rows);
    write(factor_.hold(rows), i, problem.dof(), solution);
  }
}

void LevelRanks::write(const PriorityFactor::Stage& stage, int level, int dof, TickSolution& solution) {
  const int before = level == 0 ? dof : solution.levels[level - 1].nullity;
  // A direction that is faded can be seen by two levels; it is granted once.
  solution.levels[level].rank = std::min(stage.rank, before);
  solution.levels[level].nullity = before - solution.levels[level].rank;
  if (stage.deficient) ++solution.rank_deficient_levels;
}

}  // namespace tactus::control
