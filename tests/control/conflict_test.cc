// Tick problems that have no solution, by hand: who contradicts whom, and what would do.
#include "framework/control/conflict.h"

#include <gtest/gtest.h>

#include "tests/plugins/random_problem.h"

namespace tactus::control {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Kind = ConflictGroup::Kind;

TickTask makeTask(const std::string& name, const MatrixXd& jacobian, Relation relation, bool contact) {
  TickTask task(name, static_cast<int>(jacobian.rows()), static_cast<int>(jacobian.cols()));
  task.rows = task.capacity();
  task.jacobian = jacobian;
  task.relation = relation;
  task.contact = contact;
  return task;
}

TickProblem makeProblem(const std::vector<TickTask>& tasks, const VectorXd& lower, const VectorXd& upper) {
  TickProblem problem;
  problem.dof = static_cast<int>(lower.size());
  problem.mass_matrix.setIdentity(problem.dof, problem.dof);
  problem.torque_limits = TorqueLimits{lower, upper, {}};
  problem.levels.resize(1);
  problem.levels[0].tasks = tasks;
  return problem;
}

MatrixXd row(std::initializer_list<double> numbers) {
  MatrixXd row(1, static_cast<Eigen::Index>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), row.data());
  return row;
}

TEST(Conflict, NoneWhereASolutionExists) {
  const TickProblem problem = makeProblem({makeTask("wall", row({1, 0}), Relation::inequality, true)},
                                          Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1));
  const Conflict conflict = findConflict(problem);
  EXPECT_FALSE(conflict.exists());
  EXPECT_TRUE(conflict.beyond.empty());
  EXPECT_EQ(describe(conflict, problem), "");
}

TEST(Conflict, AnInequalityRowAgainstALimitThatLeavesOutZero) {
  // τ₁ ∈ [2, 3] must accelerate joint 1 upwards, which the row forbids.  Joint 2 has no part in it.
  const TickProblem problem = makeProblem(
      {makeTask("stop", row({2, 0}), Relation::inequality, false),
       makeTask("far", row({0, 1}), Relation::inequality, false)},
      Eigen::Vector2d(2, -1), Eigen::Vector2d(3, 1));
  const Conflict conflict = findConflict(problem);
  ASSERT_EQ(conflict.groups.size(), 2u);
  EXPECT_EQ(conflict.groups[0].kind, Kind::rows);
  EXPECT_EQ(conflict.groups[0].task, 0);
  EXPECT_EQ(conflict.groups[1].kind, Kind::torque_limit);
  EXPECT_EQ(conflict.groups[1].joint, 0);
  EXPECT_NEAR(conflict.relaxations[0].amount, 4, 1e-9);            // J M⁻¹ τ = 2 · 2
  EXPECT_NEAR(conflict.relaxations[1].amount, 2, 1e-9);
  EXPECT_FALSE(conflict.relaxations[1].upper);
  ASSERT_EQ(conflict.beyond.size(), 1u);
  EXPECT_EQ(conflict.beyond[0].beyond, 2);
  ConflictNames names;
  names.joints = {"a1", "a2"};
  names.places = {{"stop", "stack.xml:12:5"}};
  EXPECT_EQ(describe(conflict, problem, names),
            "task 'stop' (stack.xml:12:5) and the torque limit of joint a1 contradict each other; any one of these "
            "would do: let 'stop' be accelerated by 4 m/s² or rad/s², or allow joint a1 2 N m beyond its lower limit");
  EXPECT_EQ(describe(conflict, problem),
            "task 'stop' and the torque limit of joint 1 contradict each other; any one of these would do: let 'stop' "
            "be accelerated by 4 m/s² or rad/s², or allow joint 1 2 N m beyond its lower limit");
}

TEST(Conflict, AContactMustPressMoreThanItMay) {
  // Gravity presses joint 1 down by 5 N m; the contact bears at most 3 N and may not move.
  TickTask hold = makeTask("hold", row({1, 0}), Relation::equality, true);
  hold.force << 0.5;
  hold.force_max = 3;
  const TickProblem problem = makeProblem({hold}, Eigen::Vector2d(5, -1), Eigen::Vector2d(9, 1));
  const Conflict conflict = findConflict(problem);
  ASSERT_EQ(conflict.groups.size(), 3u);
  EXPECT_EQ(conflict.groups[0].kind, Kind::rows);
  EXPECT_EQ(conflict.groups[1].kind, Kind::forces);
  EXPECT_EQ(conflict.groups[2].kind, Kind::torque_limit);
  for (const Relaxation& relaxation : conflict.relaxations) {
    EXPECT_NEAR(relaxation.amount, 2, 1e-9);
    EXPECT_TRUE(relaxation.enough);
  }
  EXPECT_EQ(describe(conflict, problem),
            "task 'hold' and the torque limit of joint 1 contradict each other; any one of these would do: let 'hold' "
            "be accelerated by 2 m/s², allow the force of 'hold' 2 N more, or allow joint 1 2 N m beyond its lower limit");
}

TEST(Conflict, AContactThatWouldHaveToPull) {
  TickTask hold = makeTask("hold", row({1, 0}), Relation::equality, true);
  hold.force << 0.5;
  const TickProblem problem = makeProblem({hold}, Eigen::Vector2d(-9, -1), Eigen::Vector2d(-5, 1));
  const Conflict conflict = findConflict(problem);
  ASSERT_EQ(conflict.groups.size(), 3u);
  EXPECT_EQ(conflict.groups[1].kind, Kind::forces);
  EXPECT_NEAR(conflict.relaxations[1].amount, 5, 1e-9);
  EXPECT_TRUE(conflict.relaxations[2].upper);
}

TEST(Conflict, TwoTasksAgainstALimit) {
  // Neither row alone forbids what the limits of joints 1 and 2 force: τ₁ = τ₂ = 1 … 2 needs the sum to rise.
  const TickProblem problem =
      makeProblem({makeTask("sum", row({1, 1, 0}), Relation::inequality, false),
                   makeTask("free", row({0, 0, 1}), Relation::inequality, false)},
                  Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(2, 2, 1));
  const Conflict conflict = findConflict(problem);
  // τ₁ ≥ 1 and τ₂ ≥ 1 and τ₁ + τ₂ ≤ 0: all three.
  ASSERT_EQ(conflict.groups.size(), 3u);
  EXPECT_EQ(conflict.groups[1].joint, 0);
  EXPECT_EQ(conflict.groups[2].joint, 1);
  EXPECT_NEAR(conflict.relaxations[0].amount, 2, 1e-9);
}

TEST(Conflict, OthersBesidesAreTold) {
  // Two contradictions that share nothing: relaxing one of them is not enough.
  const TickProblem problem = makeProblem({makeTask("first", row({1, 0}), Relation::inequality, false),
                                           makeTask("second", row({0, 1}), Relation::inequality, false)},
                                          Eigen::Vector2d(1, 3), Eigen::Vector2d(2, 4));
  const Conflict conflict = findConflict(problem);
  ASSERT_EQ(conflict.groups.size(), 2u);
  EXPECT_EQ(conflict.groups[0].task, 0) << "the higher one is told";
  EXPECT_FALSE(conflict.relaxations[0].enough);
  EXPECT_NEAR(conflict.relaxations[0].amount, 1, 1e-9);
  EXPECT_NE(describe(conflict, problem).find("; other constraints contradict each other besides"), std::string::npos);
}

TEST(Conflict, LimitsThatLeaveOutZeroAloneForbidOnlyScaling) {
  const TickProblem problem = makeProblem({}, Eigen::Vector2d(5, -1), Eigen::Vector2d(10, 1));
  const Conflict conflict = findConflict(problem);
  EXPECT_FALSE(conflict.exists());
  ASSERT_EQ(conflict.beyond.size(), 1u);
  EXPECT_EQ(describe(conflict, problem, {{"hip", "knee"}, {}}),
            "gravity and motion alone ask for more than the actuators have: joint hip by 5 N m; a torque within the "
            "limits exists, but is no multiple of the tasks' torque");
}

TEST(Conflict, ABackedOffContactIsAnInequality) {
  TickTask hold = makeTask("hold", row({1, 0}), Relation::equality, true);
  hold.force << -0.5;
  EXPECT_TRUE(findConflict(makeProblem({hold}, Eigen::Vector2d(5, -1), Eigen::Vector2d(9, 1))).exists());
  EXPECT_FALSE(findConflict(makeProblem({hold}, Eigen::Vector2d(-9, -1), Eigen::Vector2d(-5, 1))).exists());
}

TEST(Conflict, OfNumbersThatAreNoneIsNoConflict) {
  TickTask broken = makeTask("broken", row({1, NAN}), Relation::equality, true);
  EXPECT_FALSE(findConflict(makeProblem({broken}, Eigen::Vector2d(5, -1), Eigen::Vector2d(9, 1))).exists());
}

}  // namespace
}  // namespace tactus::control
