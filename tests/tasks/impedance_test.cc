#include <gtest/gtest.h>

#include "tasks/orientation_error.h"
#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

TEST(OrientationError, TurnsTheFrameOntoItsReferenceInWorldAxes) {
  std::srand(1);
  for (int k = 0; k < 200; ++k) {
    const Eigen::Matrix3d R = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    const Eigen::Matrix3d R_r = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
    const Eigen::Vector3d turn = tasks::orientationError(R, R_r);
    const Eigen::Matrix3d reached = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * R;
    EXPECT_LT((reached - R_r).norm(), 1e-9);
  }
}

TEST(Impedance, HoldsThePoseOfItsFirstTick) {
  TaskWorld world;
  world.feel();
  const auto task = world.make("impedance", {{"frame", "palm"}});
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  ASSERT_EQ(rows.rows, 6);
  EXPECT_LT(rows.F().norm(), 1e-12);
  const Eigen::Vector3d start = world.cache.framePose(world.link("palm")).translation();
  world.sensed.q[1] += 0.1;
  world.feel();
  task->update(world.tick(), rows);
  const Eigen::Vector3d away = start - world.cache.framePose(world.link("palm")).translation();
  EXPECT_LT((rows.force.head<3>() - 300 * away).norm(), 1e-9);
  EXPECT_NEAR(task->error(), away.norm(), 1e-12);
}

TEST(Impedance, StiffnessPerAxisIsMeantInTheAxesAskedFor) {
  TaskWorld world;
  world.feel();
  const int palm = world.link("palm");
  const Eigen::Isometry3d X = world.cache.framePose(palm);
  const Eigen::Vector3d target = X * Eigen::Vector3d(0.01, 0.02, 0.03);
  std::ostringstream position;
  position.precision(17);
  position << target.x() << " " << target.y() << " " << target.z();
  const auto task = world.make("impedance", {{"frame", "palm"}, {"position", position.str()}, {"axes", "link"},
                                             {"stiffness", "0 100 200"}});
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  EXPECT_LT((X.linear().transpose() * rows.force.head<3>() - Eigen::Vector3d(0, 2, 6)).norm(), 1e-9);
}

TEST(Impedance, ForceIsTheGradientOfItsPotential) {
  // −∂/∂q ½ kᵖ‖p_r − p‖² = Jᵀ kᵖ (p_r − p): the Jacobian belongs to the error, by finite differences.
  TaskWorld world;
  const auto task = world.make("impedance", {{"frame", "palm"}, {"position", "0.5 0.1 0.2"},
                                             {"rotation-stiffness", "0 0 0"}});
  auto rows = world.rowsFor(*task);
  world.feel();
  task->update(world.tick(), rows);
  const Eigen::VectorXd torque = rows.J().transpose() * rows.F();
  const Eigen::VectorXd q = world.sensed.q;
  const double h = 1e-6;
  for (int i = 0; i < world.model.dof(); ++i) {
    double energy[2];
    for (const int side : {0, 1}) {
      world.sensed.q = q;
      world.sensed.q[i] += side ? h : -h;
      world.feel();
      task->update(world.tick(), rows);
      energy[side] = 0.5 * 300 * task->error() * task->error();
    }
    EXPECT_NEAR(torque[i], -(energy[1] - energy[0]) / (2 * h), 1e-5);
  }
}

TEST(Impedance, AReferenceWithASpeedGoesToItsGoalAndStaysThere) {
  // The robot stands still, so the force is K times the way that the reference has gone, plus D times its velocity.
  TaskWorld world;
  world.feel();
  const Eigen::Isometry3d X = world.cache.framePose(world.link("palm"));
  const Eigen::Vector3d goal = X.translation() + Eigen::Vector3d(0.03, 0, -0.04);
  std::ostringstream position;
  position.precision(17);
  position << goal.x() << " " << goal.y() << " " << goal.z();
  const auto task = world.make("impedance", {{"frame", "palm"}, {"position", position.str()}, {"speed", "0.05"}});
  auto rows = world.rowsFor(*task);
  control::Tick tick = world.tick();
  const Eigen::Vector3d way(0.6, 0, -0.8);
  for (int k = 1; k <= 1000; ++k) {
    task->update(tick, rows);
    tick.time += tick.dt;
    if (k == 1000) continue;                                       // the last step may be one of rounding
    const Eigen::Vector3d expected = (300 * 0.05 * k * tick.dt + 300 * 0.05) * way;
    ASSERT_LT((rows.force.head<3>() - expected).norm(), 1e-6) << k;
    ASSERT_NEAR(task->error(), 0.05, 1e-12);
  }
  task->update(tick, rows);
  task->update(tick, rows);
  EXPECT_LT((rows.force.head<3>() - 300 * 0.05 * way).norm(), 1e-9);
  EXPECT_LT(rows.force.segment<3>(3).norm(), 1e-9);
}

TEST(Impedance, ATurningReferenceKeepsItsSpeedOnTheShortestWay) {
  TaskWorld world;
  world.feel();
  const auto task = world.make("impedance", {{"frame", "palm"}, {"orientation", "3 0.2 -1"}, {"turn-speed", "0.5"},
                                             {"rotation-damping", "0 0 0"}});
  auto rows = world.rowsFor(*task);
  control::Tick tick = world.tick();
  const Eigen::Matrix3d R = world.cache.framePose(world.link("palm")).linear();
  const Eigen::Matrix3d goal = (Eigen::AngleAxisd(-1, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(3, Eigen::Vector3d::UnitX())).toRotationMatrix();
  const Eigen::Vector3d whole = tasks::orientationError(R, goal);
  const int ticks = static_cast<int>(whole.norm() / (0.5 * tick.dt));
  for (int k = 1; k <= ticks + 10; ++k) {
    task->update(tick, rows);
    tick.time += tick.dt;
    const Eigen::Vector3d turned = rows.force.segment<3>(3) / 10;
    ASSERT_LT((turned - std::min(0.5 * tick.dt * k, whole.norm()) * whole.normalized()).norm(), 1e-6) << k;
  }
}

TEST(Impedance, AfterAPauseTheReferenceStartsWhereTheLinkIs) {
  TaskWorld world;
  world.feel();
  const auto task = world.make("impedance", {{"frame", "palm"}, {"position", "0.5 0.1 0.2"}, {"speed", "0.1"},
                                             {"damping", "0 0 0"}, {"stiffness", "1000 1000 1000"}});
  auto rows = world.rowsFor(*task);
  control::Tick tick = world.tick();
  for (int k = 0; k < 100; ++k) {
    task->update(tick, rows);
    tick.time += tick.dt;
  }
  EXPECT_NEAR(rows.force.head<3>().norm(), 1000 * 0.1 * 100 * tick.dt, 1e-9);
  tick.time += 1;
  task->update(tick, rows);
  EXPECT_NEAR(rows.force.head<3>().norm(), 1000 * 0.1 * tick.dt, 1e-9);
}

}  // namespace
}  // namespace tactus::test
