// What a plant may send, and what of it the controller may use.

#include "framework/control/sensing_guard.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/dynamics/robots.h"

namespace tactus::control {
namespace {

const double nan = std::nan("");

Sensed good(double time, double q = 0.5) {
  Sensed sensed;
  sensed.time = time;
  sensed.q = Eigen::Vector2d(q, -q);
  sensed.qd = Eigen::Vector2d(1, 2);
  ContactRecord contact;
  contact.link = 1;
  contact.normal_W.setUnit(2);
  contact.force_N = 0.5;
  sensed.contacts = {contact, contact};
  return sensed;
}

TEST(SensingGuard, LetsGoodSensesThroughAsTheyAre) {
  SensingGuard guard(2, 3, 0.02, 0.001);
  const Sensed sensed = good(0.5);
  EXPECT_EQ(&guard.check(sensed), &sensed);
  EXPECT_EQ(guard.record().joints_held, 0);
  EXPECT_EQ(guard.record().contacts_ignored, 0);
  EXPECT_FALSE(guard.record().blind);
  EXPECT_TRUE(guard.knowsState());
}

TEST(SensingGuard, HoldsALostJointForAWhileAndIsBlindThen) {
  SensingGuard guard(2, 3, 0.02, 0.001);
  guard.check(good(0));
  for (int k = 1; k <= 20; ++k) {
    Sensed sensed = good(0.001 * k, 0.6);
    (k % 2 ? sensed.q : sensed.qd)[0] = k % 3 ? nan : INFINITY;
    const Sensed& used = guard.check(sensed);
    EXPECT_EQ(used.q, Eigen::Vector2d(0.5, -0.6));
    EXPECT_EQ(used.qd, Eigen::Vector2d(1, 2));
    EXPECT_EQ(used.contacts.size(), 2u);
    EXPECT_EQ(used.time, sensed.time);
    EXPECT_TRUE(guard.isLost(0));
    EXPECT_FALSE(guard.isLost(1));
    EXPECT_FALSE(guard.record().blind) << k;
  }
  Sensed sensed = good(0.021);
  sensed.q[0] = nan;
  EXPECT_EQ(guard.check(sensed).qd, Eigen::Vector2d(0, 0)) << "a velocity that old says nothing";
  EXPECT_TRUE(guard.record().blind);
  EXPECT_TRUE(guard.knowsState());
  guard.check(good(0.022));
  EXPECT_FALSE(guard.record().blind);
}

TEST(SensingGuard, AFloatingBaseIsLostAsAWhole) {
  const dynamics::Model model(test_robots::humanoid());
  ASSERT_EQ(model.positionCount(), model.dof() + 1);
  SensingGuard guard(model, 3, 0.02, 0.001);
  Sensed sensed;
  sensed.q = model.neutral();
  sensed.qd.setZero(model.dof());
  EXPECT_EQ(&guard.check(sensed), &sensed);
  EXPECT_TRUE(guard.knowsState());
  sensed.time = 0.001;
  sensed.q[3] = nan;                                               // of the quaternion
  const Sensed& used = guard.check(sensed);
  EXPECT_EQ(guard.record().joints_held, 6);
  EXPECT_EQ(used.q, model.neutral());
}

TEST(SensingGuard, AbsentJointsAreLostToo) {
  SensingGuard guard(2, 3, 0.02, 0.001);
  Sensed absent;
  guard.check(absent);
  EXPECT_TRUE(guard.record().blind) << "nothing to hold";
  EXPECT_FALSE(guard.knowsState());
  guard.check(good(0.001));
  EXPECT_TRUE(guard.knowsState());
  const Sensed& used = guard.check(absent);
  EXPECT_EQ(used.q, good(0).q);
  EXPECT_EQ(guard.record().joints_held, 2);
  EXPECT_FALSE(guard.record().blind);
}

TEST(SensingGuard, IgnoresContactsThatAreNoNumbers) {
  SensingGuard guard(2, 3, 0.02, 0.001);
  for (const int fault : {0, 1, 2, 3, 4, 5}) {
    Sensed sensed = good(0.001 * fault);
    ContactRecord& contact = sensed.contacts[0];
    if (fault == 0) contact.force_N = nan;
    if (fault == 1) contact.point_W.y() = nan;
    if (fault == 2) contact.normal_W.z() = -INFINITY;
    if (fault == 3) contact.force_N = 1e300;
    if (fault == 4) contact.link = 3;
    if (fault == 5) contact.link = -1;
    EXPECT_EQ(guard.check(sensed).contacts.size(), 1u) << fault;
    EXPECT_EQ(guard.record().contacts_ignored, 1);
    ASSERT_EQ(guard.ignoredLinks().size(), 1u);
    EXPECT_EQ(guard.ignoredLinks()[0], fault < 4 ? 1 : -1);
  }
}

TEST(SensingGuard, TimeGoesOnWhateverTheClockSays) {
  SensingGuard guard(2, 3, 0.02, 0.001);
  guard.check(good(0.5));
  EXPECT_NEAR(guard.check(good(nan)).time, 0.501, 1e-12);
  EXPECT_NEAR(guard.check(good(0.2)).time, 0.502, 1e-12);
  EXPECT_EQ(guard.check(good(0.503)).time, 0.503);
}

}  // namespace
}  // namespace tactus::control
