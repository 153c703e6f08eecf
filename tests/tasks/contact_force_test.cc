#include <gtest/gtest.h>

#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

TEST(ContactForce, PressesAlongTheNormalOfEachHeldContact) {
  TaskWorld world;
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, -1).normalized();
  const control::ContactRecord record = world.contactOn("index_distal", normal, 0.4);
  world.sensed.contacts = {record, world.contactOn("palm", normal, 1)};
  world.feel();
  const auto task = world.make("contact-force", {{"on", "touch.held"}, {"force", "0.7"}});
  EXPECT_TRUE(task->isContact());
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  ASSERT_EQ(rows.rows, 1);
  EXPECT_EQ(rows.force[0], 0.7);
  Eigen::MatrixXd J(3, world.model.dof());
  world.cache.pointJacobian(record.link, record.point_W, J.topRows<3>());
  EXPECT_LT((rows.J() - normal.transpose() * J).norm(), 1e-12);
  EXPECT_NEAR(task->error(), 0.3, 1e-12);
}

TEST(ContactForce, WithFrictionHoldsTheTangentsToo) {
  TaskWorld world;
  const auto task = world.make("contact-force", {{"on", "touch.held"}, {"force", "0.7"}, {"friction", "0.4"}});
  auto rows = world.rowsFor(*task);
  for (const Eigen::Vector3d& along : {Eigen::Vector3d(0.2, -0.1, -1), Eigen::Vector3d(-1, 0.1, 0)}) {
    const Eigen::Vector3d normal = along.normalized();
    const control::ContactRecord record = world.contactOn("index_distal", normal, 0.4);
    world.sensed.contacts = {record};
    world.feel();
    task->update(world.tick(), rows);
    ASSERT_EQ(rows.rows, 3);
    EXPECT_EQ(rows.friction, 0.4);
    EXPECT_EQ(Eigen::Vector3d(rows.F()), Eigen::Vector3d(0.7, 0, 0));
    Eigen::MatrixXd J(3, world.model.dof());
    world.cache.pointJacobian(record.link, record.point_W, J.topRows<3>());
    // Three orthonormal directions, the first one the normal: the rows are those of the point, turned.
    EXPECT_LT((rows.J().row(0) - normal.transpose() * J).norm(), 1e-12);
    EXPECT_LT((rows.J().transpose() * rows.J() - J.transpose() * J).norm(), 1e-12);
  }
}

TEST(ContactForce, FeedbackBacksOffOnOneSideOnlyAndNoLowerThanItsFloor) {
  TaskWorld world;
  const auto task = world.make("contact-force", {{"on", "touch.held"}, {"feedback", "2"}, {"feedback-threshold", "1"},
                                                 {"feedback-filter", "0"}, {"min-force", "-3"}});
  auto rows = world.rowsFor(*task);
  const auto reference = [&](double measured) {
    world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, measured)};
    world.feel();
    task->update(world.tick(), rows);
    return rows.force[0];
  };
  EXPECT_DOUBLE_EQ(reference(0.1), 0.5);
  EXPECT_DOUBLE_EQ(reference(1.0), 0.5);
  EXPECT_DOUBLE_EQ(reference(1.5), 0.5 - 2 * 0.5);
  EXPECT_DOUBLE_EQ(reference(50), -3);
}

TEST(ContactForce, EachContactOfALinkHasItsOwnFeedback) {
  TaskWorld world;
  const control::ElementValues values =
      control::makeValues(*world.registry.elements().find("contacts"),
                          {{"name", "touch"}, {"desired", "fingers"}, {"hold", "0"}, {"per-link", "2"}});
  world.touch = world.registry.makeSignal(world.context(values));
  const auto task = world.make("contact-force", {{"on", "touch.held"}, {"feedback", "2"}, {"feedback-threshold", "1"},
                                                 {"feedback-filter", "0"}});
  EXPECT_EQ(task->capacity(), 18);
  control::ContactRecord light = world.contactOn("index_proximal", {0, 0, -1}, 0.4), heavy = light;
  heavy.force_N = 1.5;
  heavy.point_W += world.cache.framePose(heavy.link).linear() * Eigen::Vector3d(0, 0, 0.03);
  world.sensed.contacts = {light, heavy};
  world.feel();
  auto rows = world.rowsFor(*task);
  task->update(world.tick(), rows);
  ASSERT_EQ(rows.rows, 2);
  EXPECT_DOUBLE_EQ(rows.force[0], 0.5);
  EXPECT_DOUBLE_EQ(rows.force[1], 0.5 - 2 * 0.5);
}

TEST(ContactForce, TheExcessIsFilteredWithItsTimeConstant) {
  TaskWorld world;
  const auto task = world.make("contact-force", {{"on", "touch.held"}, {"feedback", "1"}, {"feedback-filter", "0.01"}});
  auto rows = world.rowsFor(*task);
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 2)};
  world.feel();
  double expected = 0;
  for (int k = 0; k < 30; ++k) {
    task->update(world.tick(), rows);
    expected += 0.001 / 0.011 * (1 - expected);
    EXPECT_NEAR(rows.force[0], 0.5 - expected, 1e-12);
  }
}

}  // namespace
}  // namespace tactus::test
