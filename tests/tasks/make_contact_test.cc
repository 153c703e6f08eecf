#include <gtest/gtest.h>

#include "framework/description/link_shape.h"
#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

using control::MissingSet;

TEST(MakeContact, KnowsNothingWithoutAnyContact) {
  TaskWorld world;
  world.feel();
  const auto task = world.make("make-contact", {{"on", "touch.missing"}});
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  EXPECT_EQ(rows.rows, 0);
}

TEST(MakeContact, TheReferenceMovesByTheMeanOfNormalAndDirection) {
  TaskWorld world;
  const double lambda = 0.05;
  const auto task = world.make("make-contact", {{"on", "touch.missing"}, {"speed", "0.05"}, {"damping", "0"}});
  auto rows = world.rowsFor(*task);
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
  world.feel();
  task->update(world.tick(), rows);
  const auto& missing = port<MissingSet>(world, "missing").points;
  ASSERT_EQ(rows.rows, 3 * static_cast<int>(missing.size()));
  for (std::size_t j = 0; j < missing.size(); ++j) {
    const Eigen::Vector3d u = (world.sensed.contacts[0].point_W - missing[j].point_W).normalized();
    const Eigen::Vector3d v = lambda * (Eigen::Vector3d(0, 0, -1) + u).normalized();
    EXPECT_LT((rows.force.segment<3>(3 * j) - 5 * v * world.dt).norm(), 1e-12) << "thesis 4.4.1, 4.3.5 after one tick";
  }
}

// The dominant patches of a grasp say where to go, before anything touches.
TEST(MakeContact, AGraspClosesAlongItsOpposition) {
  TaskWorld world;
  world.feel();
  const auto task = world.make("make-contact", {{"on", "touch.missing"}, {"speed", "0.05"}, {"damping", "0"},
                                                {"patch", "middle_medial"}, {"opposing-patch", "thumb_distal"},
                                                {"opposing", "index_distal"}});
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  const auto& missing = port<MissingSet>(world, "missing").points;
  ASSERT_EQ(rows.rows, 3 * static_cast<int>(missing.size()));
  const auto middle = [&](const char* name) {
    const int frame = world.model.frameIndex(name);
    return Eigen::Vector3d(world.tick().robot.framePose(frame) *
                           description::middleOf(world.robot.links[static_cast<std::size_t>(frame)]));
  };
  const Eigen::Vector3d across = (middle("thumb_distal") - middle("middle_medial")).normalized();
  int against = 0;
  for (std::size_t j = 0; j < missing.size(); ++j) {
    const bool opposing = missing[j].frame == world.model.frameIndex("index_distal");
    against += opposing;
    EXPECT_LT((rows.force.segment<3>(3 * j) - 5 * (opposing ? -0.05 : 0.05) * across * world.dt).norm(), 1e-12);
  }
  EXPECT_EQ(against, 1);
}

TEST(MakeContact, AGraspHasTwoSides) {
  TaskWorld world;
  EXPECT_THROW(world.make("make-contact", {{"on", "touch.missing"}, {"patch", "palm"}, {"opposing-patch", "palm"}}),
               control::ElementError);
}

TEST(MakeContact, ABlockedLinkDoesNotWindItsReferenceUp) {
  TaskWorld world;
  const auto task = world.make("make-contact", {{"on", "touch.missing"}, {"bound", "0.1"}});
  auto rows = world.rowsFor(*task);
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
  for (int k = 0; k < 10000; ++k) {
    world.feel();
    task->update(world.tick(), rows);
  }
  for (int j = 0; j < rows.rows / 3; ++j) {
    EXPECT_NEAR(rows.force.segment<3>(3 * j).norm(), 5 * 0.1, 1e-9);
  }
}

TEST(MakeContact, TheReferenceStartsAnewWhenAContactIsLost) {
  TaskWorld world;
  const auto task = world.make("make-contact", {{"on", "touch.missing"}, {"damping", "0"}});
  auto rows = world.rowsFor(*task);
  const auto index = world.contactOn("index_distal", {0, 0, -1}, 0.5);
  const auto ring = world.contactOn("ring_distal", {0, 0, -1}, 0.5);
  world.sensed.contacts = {index};
  for (int k = 0; k < 1000; ++k) {
    world.feel();
    task->update(world.tick(), rows);
  }
  world.sensed.contacts = {index, ring};
  world.feel();
  task->update(world.tick(), rows);
  world.sensed.contacts = {index};
  world.feel();
  task->update(world.tick(), rows);
  const auto& missing = port<MissingSet>(world, "missing").points;
  for (std::size_t j = 0; j < missing.size(); ++j) {
    const bool lost = missing[j].frame == world.link("ring_distal");
    const double pull = rows.force.segment<3>(3 * j).norm();
    if (lost) {
      EXPECT_LT(pull, 1e-3);
    } else {
      EXPECT_GT(pull, 0.1);
    }
  }
}

TEST(MakeContact, NormalAndDirectionThatCancelFallBackToTheNormal) {
  TaskWorld world;
  world.feel();
  // A contact straight above the missing point whose normal points up: u = −n.
  const auto& missing = port<MissingSet>(world, "missing").points;
  const control::MissingContact target = missing[0];
  control::ContactRecord record = world.contactOn("palm", {0, 0, 1}, 0.5);
  record.point_W = target.point_W - Eigen::Vector3d(0, 0, 0.001);
  world.sensed.contacts = {record};
  world.feel();
  const auto task = world.make("make-contact", {{"on", "touch.missing"}, {"damping", "0"}, {"speed", "0.05"}});
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  EXPECT_LT((rows.force.head<3>() - Eigen::Vector3d(0, 0, 5 * 0.05 * world.dt)).norm(), 1e-12);
}

}  // namespace
}  // namespace tactus::test
