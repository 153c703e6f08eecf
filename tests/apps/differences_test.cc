// Two answers to one problem: what is at a bound in one of them alone.

#include "apps/tactus/differences.h"

#include <gtest/gtest.h>

namespace tactus::app {
namespace {

using Eigen::Vector2d;

control::TickProblem problem() {
  control::TickProblem problem;
  problem.dof = 2;
  problem.mass_matrix = Vector2d(1, 4).asDiagonal();
  problem.torque_limits = control::TorqueLimits{Vector2d(-3, -8), Vector2d(3, 8), {}};
  control::TickTask task("wall", 2, 2);
  task.relation = control::Relation::inequality;
  task.rows = 2;
  task.jacobian.setIdentity();
  problem.levels.push_back({1, {}, {task}});
  return problem;
}

control::TickSolution solution(double tau1, double tau2, const std::vector<int>& active) {
  control::TickSolution solution;
  solution.torque = Vector2d(tau1, tau2);
  solution.levels.resize(1);
  for (const int row : active) solution.levels[0].active.push_back({0, 0, row});
  return solution;
}

TEST(Differences, RowsAndLimitsOfOneAnswerAlone) {
  const TickDifference difference = differenceOf(problem(), solution(3, 4, {0}), solution(-3, 8, {0, 1}));
  EXPECT_NEAR(difference.distance, std::sqrt(36 + 4), 1e-12);      // √(6² + 4²/4)
  EXPECT_NEAR(difference.relative, std::sqrt(40.0 / 13), 1e-12);
  EXPECT_TRUE(difference.both_solved);
  ASSERT_EQ(difference.here.rows.size(), 1u);
  EXPECT_EQ(difference.here.rows[0].row, 1);
  EXPECT_TRUE(difference.there.rows.empty());
  EXPECT_EQ(difference.here.joints, std::vector<int>{1}) << "joint 1 is at a limit in both, if not at the same";
  EXPECT_TRUE(difference.there.joints.empty());
  const TickDifference back = differenceOf(problem(), solution(-3, 8, {0, 1}), solution(3, 4, {0}));
  EXPECT_EQ(back.there.rows.size(), 1u);
  EXPECT_TRUE(back.here.rows.empty());
}

TEST(Differences, TheTaskThatOneAnswerDoesBetter) {
  control::TickProblem two = problem();
  control::TickTask lift("lift", 1, 2), hold("hold", 1, 2);
  lift.rows = hold.rows = 1;
  lift.jacobian << 1, 0;
  lift.force << 2;                                                 // a = 2 m/s²
  hold.jacobian << 0, 1;
  hold.has_acceleration = true;
  hold.acceleration << 0.5;
  two.levels.push_back({2, {}, {lift}});
  two.levels.push_back({3, {}, {hold}});
  const TickDifference difference = differenceOf(two, solution(2, 2, {}), solution(1, 2, {}));
  ASSERT_EQ(difference.tasks.size(), 1u) << "the other task is as good in both";
  EXPECT_EQ(difference.tasks[0].level, 1);
  EXPECT_NEAR(difference.tasks[0].asked, 2, 1e-12);
  EXPECT_NEAR(difference.tasks[0].here, 1, 1e-12);
  EXPECT_NEAR(difference.tasks[0].there, 0, 1e-12);
}

TEST(Differences, NoneOfAnAnswerFromItself) {
  const TickDifference difference = differenceOf(problem(), solution(3, 4, {0}), solution(3, 4, {0}));
  EXPECT_EQ(difference.distance, 0);
  EXPECT_EQ(difference.relative, 0);
  EXPECT_TRUE(difference.here.rows.empty() && difference.there.rows.empty());
  EXPECT_TRUE(difference.here.joints.empty() && difference.there.joints.empty());
}

}  // namespace
}  // namespace tactus::app
