#pragma once

#include "framework/control/priority_factor.h"
#include "framework/control/tick_solution.h"

namespace tactus::control {

/// Brings a solution back to "nothing done yet" for this tick, keeping its memory: zero torque, status ok.
void resetSolution(const TickProblem& problem, TickSolution& solution);

/// Ranks and nullities of the levels, for back ends that do not need them themselves: of each level's equality rows
/// projected into what all higher levels leave.
class LevelRanks {
 public:
  explicit LevelRanks(const TickProblem& shape, RankOptions options = {});
  void report(const WhitenedProblem& problem, TickSolution& solution);

  /// Writes one level's entry; levels come from the top.
  static void write(const PriorityFactor::Stage& stage, int level, int dof, TickSolution& solution);

 private:
  PriorityFactor factor_;
  RowMajorMatrix rows_;
};

}  // namespace tactus::control
