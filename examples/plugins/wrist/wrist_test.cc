#include <gtest/gtest.h>

#include <cmath>

#include "conformance/bench.h"
#include "conformance/conformance.h"

namespace {

using tactus::conformance::Bench;

/// The stack's hand in mid-air, and a force that the test lets the world do to it.
class WristTest : public ::testing::Test {
 protected:
  int link(const char* name) const { return bench.robot().model().frameIndex(name); }
  /// One contact on the palm, that pushes the hand with `force_W`.
  void push(const Eigen::Vector3d& force_W) {
    bench.sense();
    tactus::control::ContactRecord contact;
    contact.link = link("palm");
    contact.object = 0;
    contact.point_W = bench.robot().framePose(contact.link).translation();
    contact.normal_W = -force_W.normalized();
    contact.force_N = force_W.norm();
    bench.sensed.contacts = {contact};
  }
  void tick(double seconds) {
    for (int k = 0; k < std::lround(seconds / bench.period()); ++k) bench.tick();
  }
  double column(const std::string& wanted) const {
    std::vector<tactus::control::LogColumn> columns;
    bench.task("press").columns(columns);
    bench.signal("ft").columns(columns);
    for (const auto& column : columns)
      if (column.name == wanted) return *column.value;
    return std::nan("");
  }

  Bench bench{STACK, {PLUGIN}};
};

TEST_F(WristTest, TheSensorFeelsWhatTheWorldDoesToTheHand) {
  push({0, 2, 0});
  tick(0.1);
  EXPECT_NEAR(column("force_y_N"), 2, 1e-6);
}

TEST_F(WristTest, WhatTouchesBeforeTheSensorIsNotFelt) {
  push({0, 2, 0});
  bench.sensed.contacts[0].link = link("lwr_3");
  tick(0.1);
  EXPECT_EQ(column("force_y_N"), 0);
}

TEST_F(WristTest, WhatTheHandDoesToItselfIsNotFeltButWhatItDoesToTheArmIs) {
  push({0, 2, 0});
  bench.sensed.contacts[0].object = -1;
  bench.sensed.contacts[0].other_link = link("thumb_distal");      // which the palm presses by −2 N
  tick(0.1);
  EXPECT_EQ(column("force_y_N"), 0);
  bench.sensed.contacts[0].other_link = link("lwr_3");
  tick(0.1);
  EXPECT_NEAR(column("force_y_N"), 2, 1e-6);
  std::swap(bench.sensed.contacts[0].link, bench.sensed.contacts[0].other_link);
  tick(0.1);
  EXPECT_NEAR(column("force_y_N"), -2, 1e-6) << "seen from the arm";
}

// K e = f, across the table; down, the wanted 5 N is met by the table's.
TEST_F(WristTest, AStiffAxisGivesWayByForceOverStiffness) {
  push({6, 0, 5});
  tick(6);
  EXPECT_NEAR(column("given_way_m"), 6.0 / 300, 2e-4);
}

TEST_F(WristTest, WithoutContactTheHandComesDownAtForceOverDamping) {
  tick(1);
  const double before = column("given_way_m");
  tick(1);
  EXPECT_NEAR(column("given_way_m") - before, 5.0 / 250, 1e-4);
}

TEST(Plugin, KeepsTheLaws) {
  const auto report = tactus::conformance::checkPlugin(PLUGIN, STACK);
  EXPECT_TRUE(report.conforms()) << report.text();
}

}  // namespace
