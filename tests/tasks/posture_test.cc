#include <gtest/gtest.h>

#include <numbers>

#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

TEST(Posture, IsASpringAndDamperOnEachJoint) {
  TaskWorld world;
  world.sensed.qd.setConstant(0.2);
  world.feel();
  const auto task = world.make("posture", {{"joints", "thumb"}, {"stiffness", "1 2 3 4"}, {"damping", "0.1"},
                                           {"q", "0.3 1 0 0"}});
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  ASSERT_EQ(rows.rows, 4);
  const Eigen::Vector4d reference(0.3, 1, 0, 0);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(rows.jacobian(k, 19 + k), 1);
    EXPECT_NEAR(rows.force[k], (k + 1) * (reference[k] - world.sensed.q[19 + k]) - 0.1 * 0.2, 1e-12);
  }
}

TEST(Posture, SwingsAboutItsReferenceWithTheSpeedOfTheSwing) {
  TaskWorld world;
  const auto task = world.make("posture", {{"joints", "thumb"}, {"stiffness", "2"}, {"damping", "0.1"}, {"q", "0.3 0.3 0.3 0.3"},
                                           {"swing", "0.2 -0.2 0 0.4"}, {"swing-rate", "0.25"}});
  auto rows = world.rowsFor(*task);
  const Eigen::Vector4d swing(0.2, -0.2, 0, 0.4);
  // Four seconds a period: still at its reference and fastest at 0, farthest and still after 1 s, back after 2 s.
  const double way[] = {0, 1, 0, -1, 0};
  const double speed[] = {1, 0, -1, 0, 1};
  for (int second = 0; second <= 4; ++second) {
    world.sensed.time = second;
    world.sensed.q.tail(4).setConstant(0.1);
    world.sensed.qd.tail(4).setConstant(0.5);
    world.feel();
    task->update(world.tick(), rows);
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(rows.force[k],
                  2 * (0.3 + swing[k] * way[second] - 0.1) + 0.1 * (swing[k] * speed[second] * std::numbers::pi / 2 - 0.5),
                  1e-12) << second << " s, joint " << k;
  }
}

TEST(Posture, FreeJointsAreThoseOfFourThreeOne) {
  TaskWorld world;
  const auto task = world.make("posture", {{"joints", "free"}, {"delay", "0.2"}});
  auto rows = world.rowsFor(*task);
  // Untouched: C = ∅, all joints.
  world.feel();
  task->update(world.tick(), rows);
  EXPECT_EQ(rows.rows, 23);
  // A desired link touches: fingers and arm carry desired contacts, the thumb's chain has none.
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
  world.feel();
  task->update(world.tick(), rows);
  EXPECT_EQ(rows.rows, 4);
  for (int k = 0; k < rows.rows; ++k) EXPECT_EQ(rows.jacobian(k, 19 + k), 1);
  // The thumb is touched as well: no joint is free.
  world.sensed.contacts.push_back(world.contactOn("thumb_distal", {0, 0, -1}, 0.5));
  world.feel();
  task->update(world.tick(), rows);
  EXPECT_EQ(rows.rows, 0);
  // All is lost: free again, but only after the delay.
  world.sensed.contacts.clear();
  world.sensed.time += 0.1;
  world.feel();
  task->update(world.tick(), rows);
  EXPECT_LE(rows.rows, 4);
  world.sensed.time += 0.11;
  world.feel();
  task->update(world.tick(), rows);
  EXPECT_EQ(rows.rows, 23);
}

TEST(Posture, RefusesAReferenceOfTheWrongLength) {
  TaskWorld world;
  try {
    world.make("posture", {{"joints", "thumb"}, {"q", "1 2 3"}});
    FAIL();
  } catch (const control::ElementError& error) {
    EXPECT_EQ(error.attribute, "q");
    EXPECT_STREQ(error.what(), "q has 3 numbers, expected 1 or 4 (one a joint)");
  }
}

}  // namespace
}  // namespace tactus::test
