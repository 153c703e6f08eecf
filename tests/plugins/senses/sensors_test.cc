// The sensors on a finger, told what there is: what they make of it, to the tick.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/plugins/senses/finger.h"

namespace tactus::testing {
namespace {

using control::ContactRecord;
using control::ElementError;

constexpr int kNear = 1, kFar = 2;                                 // links

/// On the upper side of a link, `along` it, as the finger stands in the sensor's truth.
ContactRecord touch(const SensorOnFinger& on, int link, double along, double force) {
  const Eigen::Isometry3d X_WL = on.pose(link, on.truth.q);
  ContactRecord record;
  record.link = link;
  record.object = 0;
  record.point_W = X_WL * Eigen::Vector3d(along, 0, 0.01);
  record.normal_W = X_WL.linear() * Eigen::Vector3d::UnitZ();
  record.force_N = force;
  record.depth = force / 2000;
  record.friction_W = {0.1, 0, 0};
  return record;
}

TEST(Skin, TellsAContactByItsTaxels) {
  SensorOnFinger on("skin", {{"links", "far"}});
  on.truth.q << 0.4, -0.7;
  on.truth.contacts = {touch(on, kNear, 0.03, 2), touch(on, kFar, 0.037, 0.5)};
  on.tick();
  ASSERT_EQ(on.told.contacts.size(), 2u);
  EXPECT_EQ(on.told.contacts[0].force_N, 2) << "there is no skin";
  const ContactRecord& felt = on.told.contacts[1];
  EXPECT_EQ(felt.link, kFar);
  EXPECT_EQ(felt.object, -1);
  EXPECT_LT((felt.point_W - on.truth.contacts[1].point_W).norm(), 0.002);
  EXPECT_GT(felt.normal_W.dot(on.truth.contacts[1].normal_W), std::cos(0.2));
  EXPECT_NEAR(felt.force_N, 0.5, 0.02) << "all but what is below the threshold";
  EXPECT_EQ(felt.friction_W.norm(), 0);
  EXPECT_NEAR(on.readings()[0], felt.force_N, 1e-12);
  EXPECT_EQ(on.readings()[1], (on.readings().tail(on.readings().size() - 2).array() > 0).count());
}

TEST(Skin, ThatIsPerfectLeavesContactsAsTheyAre) {
  SensorOnFinger on("skin", {{"links", "far"}, {"perfect", "true"}});
  on.truth.contacts = {touch(on, kFar, 0.037, 0.5)};
  on.tick();
  ASSERT_EQ(on.told.contacts.size(), 1u);
  EXPECT_EQ(on.told.contacts[0].point_W, on.truth.contacts[0].point_W);
  EXPECT_EQ(on.told.contacts[0].friction_W, on.truth.contacts[0].friction_W);
  EXPECT_GT(on.readings()[0], 0.4);
}

TEST(Skin, PutsContactsWhereTheFeltJointsHaveTheLink) {
  SensorOnFinger on("skin", {{"links", "far"}});
  on.truth.contacts = {touch(on, kFar, 0.05, 1)};
  on.felt_q = Eigen::Vector2d(0.1, 0.2);
  on.tick();
  ASSERT_EQ(on.told.contacts.size(), 1u);
  const Eigen::Vector3d expected = on.pose(kFar, on.felt_q) * Eigen::Vector3d(0.05, 0, 0.01);
  EXPECT_LT((on.told.contacts[0].point_W - expected).norm(), 0.002);
  EXPECT_GT((on.told.contacts[0].point_W - on.truth.contacts[0].point_W).norm(), 0.01);
}

TEST(Skin, KeepsWhatAnotherSkinReadOnItsLink) {
  SensorOnFinger on("skin", {{"links", "far"}, {"facing", "0 0 -1"}});
  on.truth.contacts = {touch(on, kFar, 0.05, 1)};
  on.felt_before = {touch(on, kFar, 0.05, 0.9)};
  on.felt_before[0].object = -1;
  on.tick();
  ASSERT_EQ(on.told.contacts.size(), 1u) << "this one covers the other side";
  EXPECT_EQ(on.told.contacts[0].force_N, 0.9);
}

/// A finger with a ball on its base, which the far link can touch.
description::Robot fingerWithBall() {
  description::Robot robot = finger();
  robot.links[0].shapes = {description::CapsuleShape{{0.2, 0, 0.03}, {0.2, 0, 0.03}, 0.02}};
  robot.self_contact = {{0, kFar}};
  return robot;
}

TEST(Skin, TellsWhereTheRobotTouchesItself) {
  SensorOnFinger on("skin", {{"links", "far"}}, 1, {}, fingerWithBall());
  ContactRecord of_self = touch(on, kFar, 0.2 - 0.12, 2);          // right below the ball
  of_self.object = -1;
  of_self.other_link = 0;
  on.truth.contacts = {of_self, touch(on, kFar, 0.01, 1)};
  on.tick();
  EXPECT_NEAR(on.readings()[0], 3, 0.1) << "taxels do not ask what presses them";
  ASSERT_EQ(on.told.contacts.size(), 2u) << "none of the true ones";
  EXPECT_EQ(on.told.contacts[0].other_link, -1);
  EXPECT_NEAR(on.told.contacts[0].force_N, 1, 0.05);
  EXPECT_EQ(on.told.contacts[1].other_link, 0);
  EXPECT_NEAR(on.told.contacts[1].force_N, 2, 0.05);

  // Where the felt joints have the finger elsewhere, the robot takes it for the world.
  on.felt_q = Eigen::Vector2d(0.3, 0);
  on.tick();
  ASSERT_EQ(on.told.contacts.size(), 2u);
  EXPECT_EQ(on.told.contacts[1].other_link, -1);
}

TEST(Skin, FeelsAlsoTheLinkThatTouchesItsOwn) {
  description::Robot robot = fingerWithBall();
  robot.links[0].shapes = {
      description::BoxShape{Eigen::Isometry3d(Eigen::Translation3d(0.2, 0, 0.03)), {0.04, 0.04, 0.04}}};
  SensorOnFinger on("skin", {{"links", "far"}}, 1, {}, robot);
  ContactRecord of_self = touch(on, kFar, 0.08, 2);                // seen from the base
  of_self.object = -1;
  of_self.link = 0;
  of_self.other_link = kFar;
  on.truth.contacts = {of_self};
  on.tick();
  ASSERT_EQ(on.told.contacts.size(), 1u);
  EXPECT_EQ(on.told.contacts[0].link, kFar);
  EXPECT_EQ(on.told.contacts[0].other_link, 0);
}

TEST(Fault, OfALinkStrikesWhereAnotherOneTouchesIt) {
  SensorOnFinger on("fault", {{"kind", "dropped"}, {"links", "far"}});
  ContactRecord of_self = touch(on, kNear, 0.08, 2);
  of_self.object = -1;
  of_self.other_link = kFar;
  on.truth.contacts = {of_self, touch(on, kNear, 0.02, 1)};
  on.tick();
  ASSERT_EQ(on.told.contacts.size(), 1u);
  EXPECT_EQ(on.told.contacts[0].force_N, 1);
}

TEST(Skin, OrdersContactsByLinkAndTaxel) {
  SensorOnFinger on("skin", {{"links", "near far"}});
  on.truth.contacts = {touch(on, kFar, 0.09, 1), touch(on, kFar, 0.01, 2), touch(on, kNear, 0.05, 3)};
  on.tick();
  ASSERT_EQ(on.told.contacts.size(), 3u);
  EXPECT_NEAR(on.told.contacts[0].force_N, 3, 0.1);
  EXPECT_NEAR(on.told.contacts[1].force_N, 2, 0.1);
  EXPECT_NEAR(on.told.contacts[2].force_N, 1, 0.1);
}

TEST(Skin, OfSixNodesTellsEveryFiftiethTick) {
  SensorOnFinger on("skin", {{"links", "far"}, {"layout", "six-node"}, {"facing", "0 0 1"}});
  for (int k = 0; k < 120; ++k) {
    on.truth.contacts.clear();
    if (k >= 10) on.truth.contacts = {touch(on, kFar, 0.0083 + 0.0167, 1)};
    on.tick();
    EXPECT_EQ(on.told.contacts.size(), k >= 50 ? 1u : 0u) << k;
  }
}

TEST(Skin, IsLateToTheTick) {
  SensorOnFinger on("skin", {{"links", "far"}, {"delay", "0.013"}});
  for (int k = 0; k < 60; ++k) {
    on.truth.contacts.clear();
    if (k >= 20 && k < 25) on.truth.contacts = {touch(on, kFar, 0.05, 1)};
    on.tick();
    EXPECT_EQ(on.told.contacts.size(), k >= 33 && k < 38 ? 1u : 0u) << k;
  }
}

TEST(Skin, OfAFingertipTellsCountsUpTo255) {
  SensorOnFinger on("skin", {{"links", "far"}, {"layout", "icub-fingertip"}, {"noise", "0.01"}});
  for (const double force : {0.3, 40.0}) {
    ContactRecord record = touch(on, kFar, 0.1, force);
    record.point_W = on.pose(kFar, on.truth.q) * Eigen::Vector3d(0.11, 0, 0);
    on.truth.contacts = {record};
    on.tick();
    const Eigen::VectorXd counts = on.readings().tail(12);
    for (const double count : counts) EXPECT_NEAR(count, std::round(count), 1e-9);
    EXPECT_GT(counts.sum(), 10);
    EXPECT_LE(counts.maxCoeff(), 255 + 1e-9);
  }
  EXPECT_NEAR(on.readings().tail(12).maxCoeff(), 255, 1e-9);
}

TEST(Skin, RefusesWhatCannotBe) {
  const auto skin = [](std::map<std::string, std::string> attributes) {
    attributes.emplace("links", "far");
    return SensorOnFinger("skin", attributes);
  };
  EXPECT_THROW(skin({{"links", "base"}}), ElementError) << "no shape";
  EXPECT_THROW(skin({{"levels", "10"}}), ElementError);
  EXPECT_THROW(skin({{"values", "counts"}}), ElementError);
  EXPECT_THROW(skin({{"dead-taxels", "5 100000"}}), ElementError);
  EXPECT_THROW(skin({{"layout", "icub-fingertip"}, {"pitch", "0.002"}}), ElementError);
  EXPECT_THROW(skin({{"facing", "0 0 0"}}), ElementError);
}

TEST(Encoders, TellStepsOfTheResolution) {
  SensorOnFinger on("encoders", {{"joints", "far"}, {"resolution", "0.01"}, {"velocity-cutoff", "0"}});
  for (int k = 0; k < 100; ++k) {
    on.truth.q << 0.777, 0.003 * k;
    on.truth.qd << 5, 3;
    on.tick();
    EXPECT_NEAR(on.told.q[1] / 0.01, std::round(on.told.q[1] / 0.01), 1e-9);
    EXPECT_LE(std::abs(on.told.q[1] - on.truth.q[1]), 0.005 + 1e-12);
    EXPECT_EQ(on.told.q[0], 0.777) << "not one of its joints";
    EXPECT_EQ(on.told.qd[0], 5);
    EXPECT_EQ(on.readings()[0], on.told.q[1]);
  }
}

TEST(Encoders, FilterDifferencesToTheFirstOrder) {
  const double cutoff = 30, rate = 2;
  SensorOnFinger on("encoders", {{"joints", "far"}, {"resolution", "0"}, {"velocity-cutoff", "30"}});
  for (int k = 0; k < 200; ++k) {
    on.truth.q[1] = rate * k * kPeriod;
    on.tick();
    EXPECT_NEAR(on.told.qd[1], rate * (1 - std::exp(-2 * std::numbers::pi * cutoff * k * kPeriod)), 1e-9) << k;
  }
}

TEST(Encoders, HaveTheNoiseThatTheySayAndAreLate) {
  SensorOnFinger on("encoders", {{"joints", "near far"}, {"resolution", "0"}, {"noise", "0.01"}, {"delay", "0.004"}});
  double squares = 0;
  for (int k = 0; k < 20000; ++k) {
    on.truth.q << 0.5 * k, -0.5 * k;
    on.tick();
    if (k >= 4) squares += (on.told.q - Eigen::Vector2d(0.5, -0.5) * (k - 4)).squaredNorm();
  }
  EXPECT_NEAR(std::sqrt(squares / 40000), 0.01, 0.0003);
}

Eigen::VectorXd wrenchTold(SensorOnFinger& on, const Eigen::Vector3d& force, const Eigen::Vector3d& moment) {
  on.truth.wrenches = {{kNear, Eigen::Vector3d::Constant(77), Eigen::Vector3d::Zero()}, {kFar, force, moment}};
  on.tick();
  return on.readings();
}

TEST(ForceTorque, AsksForItsLinkAndTellsItsWrench) {
  SensorOnFinger on("force-torque", {{"link", "far"}, {"force-bias", "0 0 1"}});
  EXPECT_EQ(on.sensor().wrenchLinks(), std::vector<int>{kFar});
  on.tick();
  EXPECT_TRUE(on.readings().array().isNaN().all()) << "there is none yet";
  const Eigen::VectorXd told = wrenchTold(on, {3, 0, 3}, {0, 2, 0});
  Eigen::VectorXd expected(8);
  expected << 3, 0, 4, 0, 2, 0, 5, 2;
  EXPECT_LT((told - expected).norm(), 1e-12);
  EXPECT_THROW(SensorOnFinger("force-torque", {{"link", "base"}}), ElementError);
}

TEST(ForceTorque, FiltersToTheFirstOrderAndSaturates) {
  SensorOnFinger on("force-torque", {{"link", "far"}, {"cutoff", "20"}, {"force-range", "8"}, {"moment-range", "0.5"}});
  wrenchTold(on, {0, 0, 0}, {0, 0, 0});
  for (int k = 1; k < 300; ++k) {
    const Eigen::VectorXd told = wrenchTold(on, {4, -20, 0}, {0, 0, 9});
    const double share = 1 - std::exp(-2 * std::numbers::pi * 20 * k * kPeriod);
    EXPECT_NEAR(told[0], 4 * share, 1e-9);
    EXPECT_NEAR(told[1], std::max(-8.0, -20 * share), 1e-9);
    EXPECT_NEAR(told[5], std::min(0.5, 9 * share), 1e-9);
  }
}

TEST(ForceTorque, HasTheNoiseThatItSaysAndABoundedDrift) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  SensorOnFinger noisy("force-torque", {{"link", "far"}, {"force-noise", "0.2"}, {"moment-noise", "0.01"}});
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(6);
  for (int k = 0; k < 20000; ++k) squares += wrenchTold(noisy, none, none).head<6>().cwiseAbs2();
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(std::sqrt(squares[i] / 20000), i < 3 ? 0.2 : 0.01, i < 3 ? 0.005 : 0.0003);

  SensorOnFinger drifting("force-torque", {{"link", "far"}, {"force-drift", "0.5"}, {"force-drift-limit", "0.3"}});
  double largest = 0;
  for (int k = 0; k < 20000; ++k)
    largest = std::max(largest, wrenchTold(drifting, none, none).head<3>().cwiseAbs().maxCoeff());
  EXPECT_LE(largest, 0.3);
  EXPECT_GT(largest, 0.25);
}

const std::vector<control::ReadingRow> kBefore = {
    {"skin", "force", 1, true}, {"skin", "taxels", 2, false}, {"wrist", "wrench", 3, false}};

/// A fault with readings before it, in tick k of a finger that swings and touches.
SensorOnFinger fault(std::map<std::string, std::string> attributes) {
  attributes.emplace("from", "0.01");
  attributes.emplace("until", "0.02");
  return SensorOnFinger("fault", attributes, 1, kBefore);
}
void set(SensorOnFinger& on, int k) {
  on.truth.q << 0.01 * k, -0.02 * k;
  on.truth.qd << 10, -20;
  on.truth.contacts = {touch(on, kNear, 0.05, 1 + k), touch(on, kFar, 0.05, 2 + k)};
  on.given = Eigen::VectorXd::LinSpaced(6, k, k + 5);
}
bool strikes(int k) { return k >= 10 && k < 20; }

TEST(Fault, OfADroppedPatchLeavesNothing) {
  SensorOnFinger on = fault({{"kind", "dropped"}, {"links", "far"}, {"of", "skin"}});
  for (int k = 0; k < 30; ++k) {
    set(on, k);
    on.tick();
    EXPECT_EQ(on.told.contacts.size(), strikes(k) ? 1u : 2u);
    EXPECT_EQ(on.told.contacts[0].link, kNear);
    EXPECT_EQ(on.told.readings.head(3).norm() == 0, strikes(k)) << k;
    EXPECT_EQ(on.told.readings[4], k + 4) << "of another sensor";
    EXPECT_EQ(on.readings()[0], strikes(k));
  }
}

TEST(Fault, OfAStuckPatchAndJointKeepsWhatWasFeltLast) {
  SensorOnFinger on = fault({{"kind", "stuck"}, {"links", "far"}, {"joints", "near"}, {"of", "wrist"}});
  for (int k = 0; k < 30; ++k) {
    set(on, k);
    on.tick();
    const int last = strikes(k) ? 9 : k;
    EXPECT_DOUBLE_EQ(on.told.q[0], 0.01 * last);
    EXPECT_EQ(on.told.qd[0], strikes(k) ? 0 : 10);
    EXPECT_DOUBLE_EQ(on.told.q[1], -0.02 * k);
    ASSERT_EQ(on.told.contacts.size(), 2u);
    EXPECT_EQ(on.told.contacts[0].force_N, 1 + k);
    EXPECT_EQ(on.told.contacts[1].force_N, 2 + last);
    EXPECT_LT((on.told.contacts[1].point_W - on.pose(kFar, on.told.q) * Eigen::Vector3d(0.05, 0, 0.01)).norm(), 1e-12)
        << "it moves with its link";
    EXPECT_EQ(on.told.readings[5], 5 + last);
    EXPECT_EQ(on.told.readings[0], k);
  }
}

TEST(Fault, OfLostNumbersIsNan) {
  SensorOnFinger on = fault({{"kind", "nan"}, {"links", "far"}, {"joints", "far"}, {"of", "skin wrist"}});
  for (int k = 0; k < 30; ++k) {
    set(on, k);
    on.tick();
    EXPECT_EQ(std::isnan(on.told.q[1]), strikes(k));
    EXPECT_EQ(std::isnan(on.told.qd[1]), strikes(k));
    EXPECT_FALSE(std::isnan(on.told.q[0]));
    EXPECT_EQ(on.told.readings.head(6).array().isNaN().all(), strikes(k));
    EXPECT_EQ(on.told.contacts[1].point_W.array().isNaN().all(), strikes(k));
    EXPECT_FALSE(std::isnan(on.told.contacts[0].force_N));
  }
}

TEST(Fault, OfAnEncoderThatJumpsIsAnOffset) {
  SensorOnFinger on = fault({{"kind", "jump"}, {"joints", "far"}, {"offset", "0.3"}});
  for (int k = 0; k < 30; ++k) {
    set(on, k);
    on.tick();
    EXPECT_DOUBLE_EQ(on.told.q[1], -0.02 * k + (strikes(k) ? 0.3 : 0));
    EXPECT_DOUBLE_EQ(on.told.q[0], 0.01 * k);
    EXPECT_EQ(on.told.qd[1], -20);
  }
}

TEST(Fault, ThatIsLateTellsEverythingThatOld) {
  SensorOnFinger on = fault({{"kind", "late"}, {"delay", "0.007"}});
  for (int k = 0; k < 30; ++k) {
    set(on, k);
    on.tick();
    const int when = strikes(k) ? k - 7 : k;
    EXPECT_DOUBLE_EQ(on.told.q[0], 0.01 * when);
    EXPECT_EQ(on.told.contacts[1].force_N, 2 + when);
    EXPECT_EQ(on.told.readings[0], when);
    EXPECT_DOUBLE_EQ(on.told.time, 0.001 * k) << "the clock is not a sense";
  }
}

TEST(Fault, FromTheStartOnHasADefinedState) {
  SensorOnFinger stuck("fault", {{"kind", "stuck"}, {"joints", "far"}});
  SensorOnFinger late("fault", {{"kind", "late"}, {"delay", "0.005"}});
  for (int k = 0; k < 20; ++k) {
    for (SensorOnFinger* on : {&stuck, &late}) {
      on->truth.q << 0, 1 + k;
      on->tick();
    }
    EXPECT_EQ(stuck.told.q[1], 1);
    EXPECT_EQ(late.told.q[1], 1 + std::max(0, k - 5));
  }
}

TEST(Fault, RefusesWhatMeansNothing) {
  EXPECT_THROW(fault({{"kind", "stuck"}}), ElementError);
  EXPECT_THROW(fault({{"kind", "dropped"}, {"joints", "far"}}), ElementError);
  EXPECT_THROW(fault({{"kind", "jump"}, {"links", "far"}}), ElementError);
  EXPECT_THROW(fault({{"kind", "late"}, {"links", "far"}}), ElementError);
  EXPECT_THROW(fault({{"kind", "nan"}, {"of", "skni"}}), ElementError);
  EXPECT_THROW(fault({{"kind", "nan"}, {"links", "far"}, {"until", "0.001"}}), ElementError);
}

}  // namespace
}  // namespace tactus::testing
