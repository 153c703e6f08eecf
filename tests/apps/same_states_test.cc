// Small problems whose norms and violations can be worked out by hand.

#include "apps/tactus/same_states.h"

#include <gtest/gtest.h>

namespace tactus::app {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

/// M = diag(1, 4); level 1 holds joint 1 with F = 3.
control::TickProblem problem(control::Relation relation) {
  control::TickProblem problem;
  problem.dof = 2;
  problem.mass_matrix = Vector2d(1, 4).asDiagonal();
  control::TickTask task("hold", 1, 2);
  task.relation = relation;
  task.rows = 1;
  task.jacobian << 1, 0;
  task.force << 3;
  problem.levels.push_back({1, {}, {task}});
  return problem;
}

control::TickSolution solution(double tau1, double tau2) {
  control::TickSolution solution;
  solution.torque = Vector2d(tau1, tau2);
  return solution;
}

TEST(RelativeViolation, OfAnEqualityIsTheAccelerationAdded) {
  const auto equality = problem(control::Relation::equality);
  EXPECT_EQ(relativeViolation(equality, solution(3, 8)), 0);
  // Two too much: 2 over ‖(5, 0)‖ = 5.
  EXPECT_NEAR(relativeViolation(equality, solution(5, 0)), 0.4, 1e-15);
  EXPECT_NEAR(relativeViolation(equality, solution(1, 0)), 2, 1e-15);
  // In the M⁻¹ norm the torque (3, 8) has the length 5.
  EXPECT_NEAR(relativeViolation(equality, solution(-3, 8)), 6 / 5.0, 1e-15);
}

TEST(RelativeViolation, OfAnInequalityIsOnlyUpwards) {
  const auto inequality = problem(control::Relation::inequality);
  EXPECT_EQ(relativeViolation(inequality, solution(1, 0)), 0);
  EXPECT_NEAR(relativeViolation(inequality, solution(5, 0)), 0.4, 1e-15);
}

TEST(RelativeViolation, ScaledTorquesAreComparedWithScaledTasks) {
  control::TickSolution half = solution(1.5, 4);
  half.scale = 0.5;
  EXPECT_EQ(relativeViolation(problem(control::Relation::equality), half), 0);
}

TEST(RelativeViolation, KktResidualGoesFirst) {
  control::TickSolution with_kkt = solution(5, 0);
  with_kkt.has_kkt = true;
  with_kkt.kkt.primal = 0.125;
  EXPECT_EQ(relativeViolation(problem(control::Relation::equality), with_kkt), 0.125);
}

TEST(CompareTorques, InTheInverseInertiaNorm) {
  const std::vector<control::TickProblem> problems(3, problem(control::Relation::equality));
  Answers a, b;
  a.torques = {Vector2d(3, 8), Vector2d(1, 0), VectorXd()};
  b.torques = {Vector2d(3, 4), Vector2d(1, 0), Vector2d(9, 9)};
  const TorqueDifference difference = compareTorques(problems, a, b);
  EXPECT_EQ(difference.compared, 2);
  EXPECT_NEAR(difference.max, 2, 1e-15);            // √(4²/4)
  EXPECT_NEAR(difference.mean, 1, 1e-15);
  EXPECT_NEAR(difference.relative_max, 0.4, 1e-15);  // over ‖(3, 8)‖ = 5
}

TEST(SolveAll, CountsWhatWasNotSolved) {
  class SecondFails final : public control::BackEnd {
   public:
    SecondFails() : BackEnd({}) {}

   private:
    void doPrepare(const control::TickProblem&) override {}
    void doSolve(const control::TickProblem&, control::TickSolution& solution) override {
      solution.status = calls_++ == 1 ? control::Status::failed : control::Status::ok;
      solution.torque = Vector2d(3, 0);
    }
    int calls_ = 0;
  };
  SecondFails back_end;
  const Answers answers =
      solveAll(back_end, std::vector<control::TickProblem>(3, problem(control::Relation::equality)));
  EXPECT_EQ(answers.unsolved, 1);
  EXPECT_EQ(answers.torques[1].size(), 0);
  EXPECT_EQ(answers.torques[2], Vector2d(3, 0));
  EXPECT_EQ(answers.solve_us.size(), 3u);
  EXPECT_FALSE(answers.has_kkt);
}

}  // namespace
}  // namespace tactus::app
