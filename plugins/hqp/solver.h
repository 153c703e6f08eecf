#pragma once

#include <limits>
#include <vector>

#include "framework/control/least_distance.h"
#include "framework/control/level_ranks.h"
#include "framework/control/whitened_problem.h"
#include "plugins/hqp/hqp.h"

namespace tactus::hqp {

using control::LeastDistance;
using control::PriorityFactor;
using control::RowMajorMatrix;
using control::TickProblem;
using control::TickSolution;

inline constexpr double no_bound = std::numeric_limits<double>::infinity();
/// Price of a free direction over that of a level's own error, or of a limit's violation: so small that it decides
/// nothing but which rows are at their bounds.  The second where rounding takes the first.
inline constexpr double free_prices[] = {1e-6, 1e-3};
/// Share of a level's error, relative to the size of its point, from which a row at its bound is said to cost it.
inline constexpr double costly_share = 1e-8;

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
  bool leavesABound(double share);
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
  Eigen::VectorXd y_above_;                                        // y_, likewise
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

}  // namespace tactus::hqp
