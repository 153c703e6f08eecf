#include <gtest/gtest.h>

#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

TEST(ContactLimit, IsAnInequalityWithoutForceBelowItsMaximum) {
  TaskWorld world;
  world.sensed.contacts = {world.contactOn("palm", {0, 0, -1}, 0.9), world.contactOn("index_distal", {0, 0, -1}, 4)};
  world.feel();
  const auto task = world.make("contact-limit", {{"on", "touch.undesired"}, {"max-force", "1"}});
  EXPECT_EQ(task->relation(), control::Relation::inequality);
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  ASSERT_EQ(rows.rows, 1);
  EXPECT_EQ(rows.force[0], 0);
}

TEST(ContactLimit, BacksOffAboveItsMaximumUpToItsLimit) {
  TaskWorld world;
  const auto task = world.make("contact-limit", {{"on", "touch.undesired"}, {"max-force", "1"}, {"feedback", "2"},
                                                 {"feedback-filter", "0"}, {"back-off-limit", "5"}});
  auto rows = world.rowsFor(*task);
  world.sensed.contacts = {world.contactOn("palm", {0, 0, -1}, 1.5)};
  world.feel();
  task->update(world.tick(), rows);
  EXPECT_DOUBLE_EQ(rows.force[0], -1);
  world.sensed.contacts = {world.contactOn("palm", {0, 0, -1}, 100)};
  world.feel();
  task->update(world.tick(), rows);
  EXPECT_DOUBLE_EQ(rows.force[0], -5);
}

TEST(ContactLimit, WithoutMaximumItNeverPushes) {
  TaskWorld world;
  const auto task = world.make("contact-limit", {{"on", "touch.undesired"}});
  auto rows = world.rowsFor(*task);
  world.sensed.contacts = {world.contactOn("palm", {0, 0, -1}, 100)};
  world.feel();
  for (int k = 0; k < 100; ++k) task->update(world.tick(), rows);
  ASSERT_EQ(rows.rows, 1);
  EXPECT_EQ(rows.force[0], 0);
}

}  // namespace
}  // namespace tactus::test
