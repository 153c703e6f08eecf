#include <gtest/gtest.h>

#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

constexpr const char* kAlong = "0.60 -0.10 0.2; 0.72 -0.10 0.2; 0.72 0 0.2";

double column(const control::Task& task, const std::string& name) {
  std::vector<control::LogColumn> columns;
  task.columns(columns);
  for (const auto& c : columns) {
    if (c.name == name) return *c.value;
  }
  ADD_FAILURE() << "no column " << name;
  return 0;
}

class FollowSurface : public ::testing::Test {
 protected:
  TaskWorld world;
  std::unique_ptr<control::Task> task;
  control::TickTask rows;

  void make(Attributes more) {
    more.insert({{"frame", "palm"}, {"along", kAlong}, {"normal-filter", "0"}});
    task = world.make("follow-surface", more);
    rows = world.rowsFor(*task);
  }
  void update() {
    world.feel();
    task->update(world.tick(), rows);
    world.sensed.time += world.dt;
  }
  Eigen::Isometry3d palm() { return world.cache.framePose(world.link("palm")); }
};

TEST_F(FollowSurface, ApproachesAlongTheLastNormalWhileNothingTouches) {
  make({{"along", "0 0 0"}, {"approach-speed", "0.02"}, {"normal-damping", "100"}});
  update();
  EXPECT_NEAR(-rows.force.head<3>().z(), 100 * 0.02, 1e-9);
  // Without contact no key is passed, however near.
  EXPECT_EQ(column(*task, "keys_passed"), 0);
}

TEST_F(FollowSurface, NeverPushesAlongTheSurfaceNormalInContact) {
  make({});
  const Eigen::Vector3d normal = Eigen::Vector3d(0.1, 0.2, -1).normalized();
  world.sensed.contacts = {world.contactOn("index_distal", normal, 0.5)};
  update();
  EXPECT_GT(rows.force.head<3>().norm(), 0.1);
  EXPECT_NEAR(normal.dot(rows.force.head<3>()), 0, 1e-9);
}

TEST_F(FollowSurface, FarFromTheKeyThePullIsStiffnessTimesReach) {
  make({{"along", "5 -0.1 0.2"}, {"reach", "0.03"}, {"stiffness", "300"}, {"tilt", "0"}});
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
  update();
  Eigen::Vector3d way = Eigen::Vector3d(5, -0.1, 0.2) - palm().translation();
  way.z() = 0;
  const Eigen::Vector3d expected = 300 * 0.03 * way.normalized();
  EXPECT_LT((rows.force.head<3>() - expected).norm(), 1e-9);
}

TEST_F(FollowSurface, TheMedianNormalIsTheMeanOfTheTwoMostDifferent) {
  make({{"tilt", "0"}});
  const Eigen::Vector3d a = Eigen::Vector3d(0.6, 0, -1).normalized();
  const Eigen::Vector3d b = Eigen::Vector3d(-0.2, 0, -1).normalized();
  world.sensed.contacts = {world.contactOn("index_distal", a, 0.5), world.contactOn("middle_distal", b, 0.5),
                           world.contactOn("ring_distal", b, 0.5), world.contactOn("ring_medial", b, 0.5)};
  update();
  const Eigen::Vector3d median = (a + b).normalized();
  // The moment turns the palm's normal axis towards the median normal, about both directions across it.
  const Eigen::Vector3d axis = palm().linear().col(0);
  const Eigen::Vector3d turn = axis.cross(median);
  EXPECT_GT(turn.norm(), 0.05);
  EXPECT_GT(rows.force.segment<3>(3).dot(turn) / (rows.force.segment<3>(3).norm() * turn.norm()), 0.99);
}

TEST_F(FollowSurface, NoMomentWhereTheHandIsAsWanted) {
  make({{"tilt", "0.174532925"}});
  // The start pose has the palm leaned by 10 degrees, fingers down, within the rounding of its joint angles.
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
  update();
  EXPECT_LT(rows.force.segment<3>(3).norm(), 0.1) << "10 N m/rad: less than 0.01 rad";
}

TEST_F(FollowSurface, PassesKeysInContactAndGivesUpStalledOnes) {
  world.feel();
  make({{"stall-time", "2"}});
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
  update();
  update();
  EXPECT_EQ(column(*task, "keys_passed"), 1) << "the palm starts within 15 mm of the first key";
  // The hand does not move: the second key is given up after two seconds, not before.
  for (int k = 0; k < 1990; ++k) update();
  EXPECT_EQ(column(*task, "keys_given_up"), 0);
  for (int k = 0; k < 20; ++k) update();
  EXPECT_EQ(column(*task, "keys_given_up"), 1);
  EXPECT_EQ(column(*task, "keys_passed"), 1) << "a key given up is not passed";
}

TEST_F(FollowSurface, ItsPullFadesWhereAContactPresses) {
  make({{"along", "5 -0.1 0.2"}, {"reach", "0.03"}, {"stiffness", "300"}, {"tilt", "0"}, {"yield-from", "0.6"},
        {"yield-until", "1"}, {"yield-filter", "0"}});
  const auto pull = [&](double force_N) {
    world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, force_N)};
    update();
    return rows.force.head<3>().norm();
  };
  EXPECT_NEAR(pull(0.6), 9, 1e-9);
  EXPECT_NEAR(pull(0.8), 4.5, 1e-9) << "half way, a smoothstep";
  EXPECT_NEAR(pull(1.0), 0, 1e-9);
  EXPECT_NEAR(pull(5.0), 0, 1e-9);
  EXPECT_NEAR(pull(0.5), 9, 1e-9);
}

TEST_F(FollowSurface, YieldsToTheForcesThatItIsToldToLookAt) {
  make({{"along", "5 -0.1 0.2"}, {"yield-from", "0.6"}, {"yield-filter", "0"}, {"yield-on", "touch.all"}});
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5), world.contactOn("palm", {0, 0, -1}, 2)};
  update();
  EXPECT_NEAR(rows.force.head<3>().norm(), 0, 1e-9) << "the palm is not desired, but pressed";
}

TEST_F(FollowSurface, RefusesToYieldBackwards) {
  try {
    make({{"yield-from", "1"}, {"yield-until", "0.5"}});
    FAIL();
  } catch (const control::ElementError& error) {
    EXPECT_EQ(error.attribute, "yield-until");
    EXPECT_STREQ(error.what(), "yield-until must be greater than yield-from");
  }
}

TEST_F(FollowSurface, TurnsNoMoreThanItsTurnReachAheadOfTheHand) {
  const auto yaw = [&](const std::string& heading, const std::string& turn_reach) {
    Attributes more{{"heading", heading}, {"yaw-stiffness", "10"}, {"rotation-damping", "0"}, {"tilt", "0"}};
    if (!turn_reach.empty()) more["turn-reach"] = turn_reach;
    make(more);
    world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
    update();
    return -rows.force.segment<3>(3).z();
  };
  EXPECT_LT(yaw("0 1 0", ""), -10) << "more than a radian, to the left, about −z";
  // The lean of 10 degrees and the turn add up to one rotation: its part about the normal is the turn's within 2 %.
  EXPECT_NEAR(yaw("0 1 0", "0.2"), -2, 0.04);
  EXPECT_NEAR(yaw("0 -1 0", "0.2"), 2, 0.04);
}

TEST_F(FollowSurface, TurnsTheOtherWayRoundRatherThanThroughWhatItAvoids) {
  const auto yaw = [&](const std::string& heading) {
    make({{"heading", heading}, {"yaw-stiffness", "10"}, {"turn-reach", "0.2"}, {"turn-avoids", "0 1 0"}, {"tilt", "0"}});
    world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
    update();
    return -rows.force.segment<3>(3).z();
  };
  EXPECT_LT(yaw("1 0.9 0"), -1) << "before it: to the left";
  EXPECT_GT(yaw("-0.9 1 0"), 1) << "behind it: the long way, to the right";
  EXPECT_GT(yaw("0 -1 0"), 1);
}

TEST_F(FollowSurface, AKeyWithAHeadingIsPassedWhenTheHandHasTurned) {
  const auto passed = [&](const std::string& headings) {
    make({{"headings", headings}, {"yaw-stiffness", "10"}, {"turn-reach", "0.3"}});
    world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
    update();
    update();
    return column(*task, "keys_passed");
  };
  EXPECT_EQ(passed("1 0 0; 1 0 0; 1 0 0"), 1) << "the palm starts within 15 mm of the first key, pointing ahead";
  EXPECT_EQ(passed("0 1 0; 1 0 0; 1 0 0"), 0);
}

TEST_F(FollowSurface, LeansOnlySoFar) {
  const Eigen::Vector3d side = Eigen::Vector3d(-0.9, 0, -0.2).normalized();
  const auto moment = [&](const std::string& lean) {
    Attributes more{{"rotation-damping", "0"}, {"tilt", "0"}};
    if (!lean.empty()) more["lean"] = lean;
    make(more);
    world.sensed.contacts = {world.contactOn("index_distal", side, 0.5)};
    update();
    return rows.force.segment<3>(3).norm();
  };
  world.feel();
  const double way = std::acos(palm().linear().col(0).dot(side));
  EXPECT_NEAR(moment(""), 10 * way, 1e-6);
  EXPECT_NEAR(moment("3"), 10 * way, 1e-6) << "farther than the surface";
  const Eigen::Vector3d down(0, 0, -1);
  const Eigen::Vector3d least = Eigen::AngleAxisd(0.5, down.cross(side).normalized()) * down;
  EXPECT_NEAR(moment("0.5"), 10 * std::acos(palm().linear().col(0).dot(least)), 0.05);
}

TEST_F(FollowSurface, RefusesHeadingsThatDoNotFitTheKeys) {
  const auto refusal = [&](const Attributes& more) -> std::string {
    try {
      make(more);
    } catch (const control::ElementError& error) {
      return error.attribute + ": " + error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal({{"headings", "1 0 0; 0 1 0"}}), "headings: headings has 2 directions, expected 3, one a key");
  EXPECT_EQ(refusal({{"headings", "1 0 0; 0 1 0; 0 0 0"}}), "headings: a heading must not be a zero vector");
  EXPECT_EQ(refusal({{"heading", "1 0 0"}, {"headings", "1 0 0"}}),
            "headings: give heading, one for all keys, or headings, one for each, not both");
}

TEST_F(FollowSurface, WithoutKeysItStaysOnTheSurfaceWhereItIs) {
  task = world.make("follow-surface", {{"frame", "palm"}, {"normal-filter", "0"}});
  rows = world.rowsFor(*task);
  world.sensed.contacts = {world.contactOn("index_distal", {0, 0, -1}, 0.5)};
  update();
  EXPECT_NEAR(rows.force.head<3>().norm(), 0, 1e-9);
}

TEST_F(FollowSurface, RefusesAxesThatAreNotPerpendicular) {
  try {
    make({{"forward-axis", "1 0 1"}});
    FAIL();
  } catch (const control::ElementError& error) {
    EXPECT_EQ(error.attribute, "forward-axis");
    EXPECT_STREQ(error.what(), "forward-axis must be perpendicular to normal-axis");
  }
}

}  // namespace
}  // namespace tactus::test
