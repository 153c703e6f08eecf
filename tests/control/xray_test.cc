// The priority x-ray on problems whose answer is known by hand, and against the ranks of PriorityFactor on random ones.
#include "framework/control/xray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "framework/control/level_ranks.h"
#include "tests/plugins/random_problem.h"

namespace tactus::control {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TickTask makeTask(const std::string& name, const MatrixXd& jacobian, const VectorXd& force,
                  Relation relation = Relation::equality) {
  TickTask task(name, static_cast<int>(jacobian.rows()), static_cast<int>(jacobian.cols()));
  task.rows = task.capacity();
  task.jacobian = jacobian;
  task.force = force;
  task.relation = relation;
  return task;
}

/// Unit inertia unless said; one task a level.
TickProblem makeProblem(const std::vector<TickTask>& tasks) {
  TickProblem problem;
  problem.dof = static_cast<int>(tasks.front().jacobian.cols());
  problem.mass_matrix.setIdentity(problem.dof, problem.dof);
  for (const TickTask& task : tasks) {
    TickLevel level;
    level.priority = static_cast<int>(problem.levels.size()) + 1;
    level.tasks.push_back(task);
    problem.levels.push_back(level);
  }
  return problem;
}

TickSolution answer(const TickProblem& problem, const VectorXd& torque) {
  TickSolution solution;
  solution.torque = torque;
  solution.levels.resize(problem.levels.size());
  return solution;
}

VectorXd one(double value) { return VectorXd::Constant(1, value); }

TEST(Xray, TheSameDirectionIsLostWhollyToTheHigherTask) {
  const MatrixXd row = (MatrixXd(1, 3) << 0, 2, 0).finished();
  const TickProblem problem = makeProblem({makeTask("first", row, one(1)), makeTask("second", -5 * row, one(1))});
  const Xray found = xray(problem, answer(problem, Eigen::Vector3d(0, 2, 0)));
  ASSERT_TRUE(found.usable);
  ASSERT_EQ(found.tasks.size(), 2u);
  EXPECT_EQ(found.tasks[0].wanted, 1);
  EXPECT_EQ(found.tasks[0].granted, 1);
  EXPECT_TRUE(found.tasks[0].lost.empty());
  const TaskXray& second = found.tasks[1];
  EXPECT_EQ(second.wanted, 1);
  EXPECT_EQ(second.granted, 0);
  ASSERT_EQ(second.lost.size(), 1u);
  EXPECT_NEAR(second.lost[0].share, 1, 1e-12);
  EXPECT_NEAR(second.lost[0].rows[0], 1, 1e-12);
  EXPECT_LT((second.lost[0].joints - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12) << "where its force asks to";
  ASSERT_EQ(second.lost[0].takers.size(), 1u);
  EXPECT_EQ(second.lost[0].takers[0].level, 0);
  EXPECT_NEAR(second.lost[0].takers[0].share, 1, 1e-12);
  EXPECT_EQ(found.levels[0].freedom_left, 2);
  EXPECT_EQ(found.levels[1].wanted, 1);
  EXPECT_EQ(found.levels[1].granted, 0);
  EXPECT_EQ(found.levels[1].freedom_left, 2);
}

TEST(Xray, AtThirtyDegreesThreeQuartersAreLost) {
  const double angle = std::numbers::pi / 6;
  const MatrixXd first = (MatrixXd(1, 2) << 1, 0).finished();
  const MatrixXd second = (MatrixXd(1, 2) << std::cos(angle), std::sin(angle)).finished();
  const TickProblem problem = makeProblem({makeTask("first", first, one(0)), makeTask("second", second, one(1))});
  const TaskXray task = xray(problem, answer(problem, Eigen::Vector2d(0, 0.5))).tasks[1];
  EXPECT_EQ(task.granted, 1) << "a direction is left, if only a part of it";
  ASSERT_EQ(task.lost.size(), 1u);
  EXPECT_NEAR(task.lost[0].share, 0.75, 1e-12);
  ASSERT_EQ(task.lost[0].takers.size(), 1u);
  EXPECT_NEAR(task.lost[0].takers[0].share, 0.75, 1e-12);
  EXPECT_NEAR(task.asked, 1, 1e-12);
  EXPECT_NEAR(task.residual, 0.75, 1e-12);                         // ½ sin 30° of 1 is reached
}

TEST(Xray, AnglesAreThoseOfTheInertia) {
  // Orthogonal in joints, not in the M⁻¹ metric: cos θ = (M⁻¹)₁₂ / √((M⁻¹)₁₁ (M⁻¹)₂₂).
  TickProblem problem = makeProblem({makeTask("first", MatrixXd::Identity(1, 2), one(0)),
                                     makeTask("second", (MatrixXd(1, 2) << 0, 1).finished(), one(1))});
  problem.mass_matrix << 2, 1, 1, 3;
  const MatrixXd inverse = problem.mass_matrix.inverse();
  const double cosine = inverse(0, 1) / std::sqrt(inverse(0, 0) * inverse(1, 1));
  const TaskXray task = xray(problem, answer(problem, Eigen::Vector2d::Zero())).tasks[1];
  ASSERT_EQ(task.lost.size(), 1u);
  EXPECT_NEAR(task.lost[0].share, cosine * cosine, 1e-12);
}

TEST(Xray, EachLostDirectionNamesItsOwnTaker) {
  // Two tasks at the top take x and z of a position; y stays.
  TickProblem problem = makeProblem({makeTask("x", (MatrixXd(1, 4) << 3, 0, 0, 0).finished(), one(0)),
                                     makeTask("position", MatrixXd::Identity(3, 4), Eigen::Vector3d(-1, 2, 3))});
  problem.levels[0].tasks.push_back(makeTask("z", (MatrixXd(1, 4) << 0, 0, 0.1, 0).finished(), one(0)));
  const TaskXray task = xray(problem, answer(problem, Eigen::Vector4d(0, 2, 0, 0))).tasks[2];
  EXPECT_EQ(task.wanted, 3);
  EXPECT_EQ(task.granted, 1);
  ASSERT_EQ(task.lost.size(), 2u);
  for (const LostDirection& lost : task.lost) {
    EXPECT_NEAR(lost.share, 1, 1e-12);
    // The lost plane is told by directions that span it; each is shared out between the two that take it.
    double shares = 0;
    for (const Taker& taker : lost.takers) {
      const double coordinate = lost.rows[taker.task == 0 ? 0 : 2];
      EXPECT_NEAR(taker.share, coordinate * coordinate, 1e-12);
      shares += taker.share;
    }
    EXPECT_NEAR(shares, 1, 0.02);
    EXPECT_NEAR(lost.rows[1], 0, 1e-12);
  }
}

TEST(Xray, TheHighestOfThoseThatHoldADirectionTookIt) {
  const MatrixXd row = MatrixXd::Identity(1, 3);
  const TickProblem problem =
      makeProblem({makeTask("first", row, one(0)), makeTask("again", row, one(0)), makeTask("third", row, one(1))});
  const Xray found = xray(problem, answer(problem, Eigen::Vector3d::Zero()));
  ASSERT_EQ(found.tasks[2].lost.size(), 1u);
  ASSERT_EQ(found.tasks[2].lost[0].takers.size(), 1u) << "'again' had lost it itself";
  EXPECT_EQ(found.tasks[2].lost[0].takers[0].level, 0);
}

TEST(Xray, RowsOfALevelCanTakeTogetherWhatNoneDoesAlone) {
  // e₁ and e₁ + 0.01 e₂ hold e₂ between them; the second one has the only part in it.
  TickProblem problem = makeProblem({makeTask("one", MatrixXd::Identity(1, 3), one(0)),
                                     makeTask("low", (MatrixXd(1, 3) << 0, 1, 0).finished(), one(1))});
  problem.levels[0].tasks.push_back(makeTask("two", (MatrixXd(1, 3) << 1, 0.01, 0).finished(), one(0)));
  const TaskXray task = xray(problem, answer(problem, Eigen::Vector3d::Zero())).tasks[2];
  EXPECT_EQ(task.granted, 0);
  ASSERT_EQ(task.lost.size(), 1u);
  ASSERT_EQ(task.lost[0].takers.size(), 1u);
  EXPECT_EQ(task.lost[0].takers[0].task, 1);
  EXPECT_NEAR(task.lost[0].takers[0].share, 1, 1e-9);
}

TEST(Xray, AnInequalityTakesOnlyWhereItIsActive) {
  const MatrixXd row = MatrixXd::Identity(1, 2);
  const TickProblem problem =
      makeProblem({makeTask("wall", row, one(0), Relation::inequality), makeTask("push", row, one(1))});
  TickSolution solution = answer(problem, Eigen::Vector2d::Zero());
  EXPECT_EQ(xray(problem, solution).tasks[1].granted, 1);
  EXPECT_TRUE(xray(problem, solution).tasks[1].lost.empty());
  solution.levels[0].active.push_back({0, 0, 0});
  const Xray found = xray(problem, solution);
  EXPECT_EQ(found.tasks[0].active, std::vector<int>{0});
  EXPECT_EQ(found.tasks[1].granted, 0);
  ASSERT_EQ(found.tasks[1].lost.size(), 1u);
  EXPECT_EQ(found.tasks[1].lost[0].takers.at(0).level, 0);
}

TEST(Xray, FadedDirectionsShowTheirNumbers) {
  XrayOptions options;
  options.rank = {1e-3, 1e-1};
  const double sine = 0.03;
  const MatrixXd second = (MatrixXd(1, 2) << std::sqrt(1 - sine * sine), sine).finished();
  const TickProblem problem =
      makeProblem({makeTask("first", MatrixXd::Identity(1, 2), one(0)), makeTask("second", second, one(1))});
  const TaskXray task = xray(problem, answer(problem, Eigen::Vector2d::Zero()), options).tasks[1];
  EXPECT_EQ(task.granted, 1);
  ASSERT_EQ(task.faded.size(), 1u);
  EXPECT_NEAR(task.faded[0].sigma, sine, 1e-12);
  EXPECT_NEAR(task.faded[0].weight, fadeWeight(sine, options.rank), 1e-12);
  EXPECT_TRUE(xray(problem, answer(problem, Eigen::Vector2d::Zero())).tasks[1].faded.empty());
}

TEST(Xray, TorqueByTaskAndWhatTheCascadeLeftOfIt) {
  // wall: the first joint may not accelerate upwards; hold: the second one not at all; rest wants all three.
  TickProblem problem = makeProblem({makeTask("wall", MatrixXd::Identity(1, 3), one(0), Relation::inequality),
                                     makeTask("rest", MatrixXd::Identity(3, 3), Eigen::Vector3d(4, 5, 6))});
  problem.levels[0].tasks.push_back(makeTask("hold", (MatrixXd(1, 3) << 0, 1, 0).finished(), one(2)));
  TickSolution solution = answer(problem, Eigen::Vector3d(0, 1, 3));
  solution.scale = 0.5;
  solution.levels[0].active.push_back({0, 0, 0});
  const Xray found = xray(problem, solution);
  ASSERT_EQ(found.tasks.size(), 3u);
  EXPECT_EQ(found.tasks[2].torque, Eigen::Vector3d(4, 5, 6));
  ASSERT_TRUE(found.tasks[2].torque_left);
  EXPECT_LT((*found.tasks[2].torque_left - Eigen::Vector3d(0, 0, 3)).norm(), 1e-12);
  EXPECT_LT((*found.tasks[1].torque_left - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  // A torque that is no such sum: another back end's.
  solution.torque[2] = 2.9;
  EXPECT_FALSE(xray(problem, solution).tasks[2].torque_left);
}

TEST(Xray, LimitsThatAreHit) {
  TickProblem problem = makeProblem({makeTask("rest", MatrixXd::Identity(3, 3), Eigen::Vector3d(4, 5, 6))});
  problem.torque_limits = TorqueLimits{Eigen::Vector3d(-1, -2, -3), Eigen::Vector3d(1, 2, 3), {}};
  const Xray found = xray(problem, answer(problem, Eigen::Vector3d(1, 0, -3)));
  ASSERT_EQ(found.limits.size(), 2u);
  EXPECT_EQ(found.limits[0].joint, 0);
  EXPECT_TRUE(found.limits[0].upper);
  EXPECT_EQ(found.limits[1].joint, 2);
  EXPECT_FALSE(found.limits[1].upper);
  EXPECT_EQ(found.limits[1].limit, -3);
}

TEST(Xray, OfNumbersThatAreNoneIsEmpty) {
  TickProblem problem = makeProblem({makeTask("rest", MatrixXd::Identity(2, 2), Eigen::Vector2d(1, NAN))});
  EXPECT_FALSE(xray(problem, answer(problem, Eigen::Vector2d::Zero())).usable);
}

TEST(Xray, OnRandomProblemsRanksAreThoseOfTheFactorAndSharesAreShares) {
  test::ProblemSource source(77);
  test::RandomProblemOptions options;
  options.inequality_share = 0;
  options.max_dof = 16;
  options.max_log10_condition = 2;
  options.max_log10_scale = 1;
  for (int k = 0; k < 60; ++k) {
    const TickProblem problem = source.problem(options);
    TickSolution ranks = answer(problem, VectorXd::Zero(problem.dof));
    WhitenedProblem whitened(problem);
    ASSERT_TRUE(whitened.update(problem));
    LevelRanks(problem).report(whitened, ranks);
    const Xray found = xray(problem, ranks);
    for (std::size_t i = 0; i < problem.levels.size(); ++i) {
      EXPECT_EQ(found.levels[i].granted, ranks.levels[i].rank);
      EXPECT_EQ(found.levels[i].freedom_left, ranks.levels[i].nullity);
    }
    for (const TaskXray& task : found.tasks) {
      EXPECT_LE(task.granted, task.wanted);
      int wholly = 0;
      double before = 1 + 1e-9;
      for (const LostDirection& lost : task.lost) {
        EXPECT_LE(lost.share, before + 1e-9);
        before = lost.share;
        wholly += lost.share > 1 - 1e-10;
        EXPECT_NEAR(lost.rows.norm(), 1, 1e-9);
        // Who takes most takes no more than is lost, and all together take it.
        if (lost.share < 0.3) continue;                            // takers of less than a hundredth are not told
        ASSERT_FALSE(lost.takers.empty());
        EXPECT_LE(lost.takers[0].share, lost.share + 1e-9);
        double sum = 0;
        for (const Taker& taker : lost.takers) sum += taker.share;
        EXPECT_GE(sum, lost.share - 0.01 * 15);
      }
      EXPECT_EQ(task.wanted - task.granted, wholly);
    }
  }
}

}  // namespace
}  // namespace tactus::control
