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

}  // namespace
}  // namespace tactus::test
