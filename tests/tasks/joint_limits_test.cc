#include <gtest/gtest.h>

#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

TEST(JointLimits, HasARowOnlyInsideTheMarginPointingAtTheStop) {
  TaskWorld world;
  const auto task =
      world.make("joint-limits", {{"joints", "fingers"}, {"margin", "0.05"}, {"stiffness", "2"}, {"damping", "0.1"}});
  auto rows = world.rowsFor(*task);
  const int joint = world.model.jointIndex("index_proximal");
  world.feel();
  task->update(world.tick(), rows);
  EXPECT_EQ(rows.rows, 0);

  world.sensed.q[joint] = world.model.upper()[joint] - 0.02;
  world.sensed.qd[joint] = 0.3;
  world.feel();
  task->update(world.tick(), rows);
  ASSERT_EQ(rows.rows, 1);
  EXPECT_EQ(rows.jacobian(0, joint), 1);
  EXPECT_NEAR(rows.force[0], -2 * 0.03 - 0.1 * 0.3, 1e-12);

  world.sensed.q[joint] = world.model.lower()[joint] + 0.02;
  world.feel();
  task->update(world.tick(), rows);
  ASSERT_EQ(rows.rows, 1);
  EXPECT_EQ(rows.jacobian(0, joint), -1);
  EXPECT_NEAR(rows.force[0], -2 * 0.03, 1e-12) << "moving away from the stop is not damped";
}

TEST(JointLimits, RefusesAMarginThatLeavesNoRoom) {
  TaskWorld world;
  try {
    world.make("joint-limits", {{"joints", "abduction"}, {"margin", "0.47"}});
    FAIL();
  } catch (const control::ElementError& error) {
    EXPECT_EQ(error.attribute, "margin");
    EXPECT_STREQ(error.what(), "twice the margin leaves no room between the limits of joint 'index_abduction'");
  }
}

}  // namespace
}  // namespace tactus::test
