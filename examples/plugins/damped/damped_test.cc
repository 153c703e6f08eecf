// The cascade alone, on tick problems made by hand.

#include <gtest/gtest.h>

#include <cmath>

#include "conformance/bench.h"
#include "conformance/conformance.h"

namespace {

using namespace tactus::control;

class CascadeTest : public ::testing::Test {
 protected:
  CascadeTest() {
    problem.dof = 3;
    problem.mass_matrix = Eigen::Vector3d(1, 2, 4).asDiagonal();
  }

  void addLevel(const Eigen::RowVector3d& row, double wanted) {
    TickTask task("task", 1, 3);
    task.rows = 1;
    task.jacobian = row;
    task.force[0] = 0;
    task.has_acceleration = true;
    task.acceleration[0] = wanted;
    problem.levels.push_back({static_cast<int>(problem.levels.size()) + 1, std::nullopt, {task}});
  }

  const TickSolution& solve(const std::string& damping) {
    const auto& row = *workshop.registry().elements().findBackEnd("damped.cascade");
    const auto back_end = workshop.registry().makeBackEnd(makeValues(row, {{"damping", damping}}));
    back_end->prepare(problem, solution);
    back_end->solve(problem, solution);
    EXPECT_EQ(solution.status, Status::ok) << solution.message;
    return solution;
  }
  double acceleration(int level) const {
    return (problem.levels[level].tasks[0].J() * problem.mass_matrix.inverse() * solution.torque)[0];
  }

  tactus::conformance::Workshop workshop{{PLUGIN}};
  TickProblem problem;
  TickSolution solution;
};

TEST_F(CascadeTest, IndependentLevelsGetWhatTheyAskFor) {
  addLevel({1, 1, 0}, 2);
  addLevel({0, 1, 1}, -1);
  solve("1e-6");
  EXPECT_NEAR(acceleration(0), 2, 1e-9);
  EXPECT_NEAR(acceleration(1), -1, 1e-9);
  EXPECT_EQ(solution.levels[1].nullity, 1);
}

TEST_F(CascadeTest, TheHigherOfTwoThatContradictWins) {
  addLevel({1, 1, 0}, 2);
  addLevel({2, 2, 0}, -1);
  solve("1e-4");
  EXPECT_NEAR(acceleration(0), 2, 1e-7);
  EXPECT_EQ(solution.levels[1].rank, 0);
}

// Level 1 alone and with a level below: the same, however much it is damped.
TEST_F(CascadeTest, LowerLevelsChangeNothingAbove) {
  addLevel({1, 1, 0}, 2);
  solve("0.3");
  const double alone = acceleration(0);
  addLevel({1, 0, 1}, -7);
  solve("0.3");
  EXPECT_NEAR(acceleration(0), alone, 1e-12);
}

// One row with σ = ‖A‖: it reaches 1/(1 + λ²) of what it asks for.
TEST_F(CascadeTest, DampingTakesTheShareThatItsHeaderStates) {
  addLevel({1, 1, 0}, 2);
  solve("0.5");
  EXPECT_NEAR(acceleration(0), 2 / (1 + 0.25), 1e-12);
}

// Two rows of one level that become parallel: a true inverse grows as 1/sin of their angle.
TEST_F(CascadeTest, TheTorqueStaysBoundedNearASingularity) {
  TickTask task("task", 2, 3);
  task.rows = 2;
  task.has_acceleration = true;
  task.acceleration << 1, -1;
  task.force.setZero();
  problem.levels.push_back({1, std::nullopt, {task}});
  for (const double angle : {1e-3, 1e-6, 1e-9, 0.0}) {
    problem.levels[0].tasks[0].jacobian << 1, 0, 0, std::cos(angle), std::sin(angle), 0;
    const double largest = std::sqrt(2.0) / (2 * 0.01 * std::sqrt(2.0)) * 2;  // ‖a‖/(2μ) times ‖L‖
    EXPECT_LT(solve("0.01").torque.norm(), largest) << angle;
  }
}

TEST(Plugin, KeepsTheLaws) {
  const auto report = tactus::conformance::checkPlugin(PLUGIN, STACK);
  EXPECT_TRUE(report.conforms()) << report.text();
}

}  // namespace
