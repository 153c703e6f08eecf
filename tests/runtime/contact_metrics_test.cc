// Hand-made contact sequences whose figures are worked out by hand.  Links 0 and 1 are desired, link 2 is not.

#include "framework/runtime/contact_metrics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::runtime {
namespace {

using control::ContactRecord;

constexpr double dt = 0.001;

ContactRecord touch(int link, int object, double force_N) {
  ContactRecord record;
  record.link = link;
  record.object = object;
  record.force_N = force_N;
  return record;
}

class ContactMetricsTest : public ::testing::Test {
 protected:
  void ticks(int count, const std::vector<ContactRecord>& records) {
    for (int i = 0; i < count; ++i) metrics.update(records, dt);
  }
  double value(const std::string& name) const {
    for (const control::Metric& metric : metrics.metrics()) {
      if (metric.name == name) return metric.value;
    }
    ADD_FAILURE() << "no metric " << name;
    return 0;
  }

  ContactMetrics metrics{3, 2, {0, 1}};
};

TEST_F(ContactMetricsTest, NothingTouchedIsNotANumber) {
  ticks(10, {});
  EXPECT_TRUE(std::isnan(value("contact_force_mean_N")));
  EXPECT_TRUE(std::isnan(value("contact_force_max_mean_N")));
  EXPECT_TRUE(std::isnan(value("contact_force_peak_N")));
  EXPECT_TRUE(std::isnan(value("links_in_contact_mean")));
  EXPECT_TRUE(std::isnan(value("contact_switches_per_s")));
  EXPECT_EQ(value("undesired_force_peak_N"), 0);
}

TEST_F(ContactMetricsTest, ForcesOfATickAndOfTheRun) {
  ticks(3, {touch(0, 0, 0.4)});
  ticks(1, {touch(0, 0, 0.4), touch(1, 0, 0.8)});
  EXPECT_EQ(metrics.now().contacts, 2);
  EXPECT_DOUBLE_EQ(metrics.now().mean_N, 0.6);
  EXPECT_DOUBLE_EQ(metrics.now().max_N, 0.8);
  // Five contacts in four ticks: 4 × 0.4 + 0.8; largest of the ticks: 0.4, 0.4, 0.4, 0.8.
  EXPECT_DOUBLE_EQ(value("contact_force_mean_N"), 2.4 / 5);
  EXPECT_DOUBLE_EQ(value("contact_force_max_mean_N"), 2.0 / 4);
  EXPECT_DOUBLE_EQ(value("contact_force_peak_N"), 0.8);
}

TEST_F(ContactMetricsTest, RecordsOfOneLinkAndObjectAreSummed) {
  // Both ends and the inside of one capsule on one object, and another object beside it.
  ticks(1, {touch(0, 0, 0.1), touch(0, 0, 0.2), touch(0, 0, 0.3), touch(0, 1, 0.5)});
  EXPECT_EQ(metrics.now().contacts, 2);
  EXPECT_DOUBLE_EQ(value("contact_force_peak_N"), 0.6);
  EXPECT_DOUBLE_EQ(value("contact_force_mean_N"), 1.1 / 2);
}

TEST_F(ContactMetricsTest, TheRobotOnItselfIsNoContactOfTheWorld) {
  ContactRecord of_self = touch(0, -1, 5);
  of_self.other_link = 1;
  ticks(3, {of_self});
  EXPECT_FALSE(metrics.touched());
  EXPECT_EQ(metrics.now().self_max_N, 5);
  ticks(3, {touch(1, 0, 0.5), of_self});
  EXPECT_EQ(metrics.now().contacts, 1);
  EXPECT_DOUBLE_EQ(value("contact_force_peak_N"), 0.5);
  EXPECT_EQ(value("undesired_force_peak_N"), 0);
  for (const control::Metric& metric : metrics.metrics()) EXPECT_NE(metric.name, "self_force_peak_N") << "it cannot";
}

TEST_F(ContactMetricsTest, TheLargestForceOnItselfIsAFigureOfARobotThatCan) {
  metrics = ContactMetrics(3, 2, {0, 1}, true);
  ContactRecord of_self = touch(0, -1, 5);
  of_self.other_link = 1;
  EXPECT_EQ(value("self_force_peak_N"), 0);
  ticks(1, {of_self});
  ticks(1, {});
  EXPECT_EQ(metrics.now().self_max_N, 0);
  EXPECT_EQ(value("self_force_peak_N"), 5);
}

TEST_F(ContactMetricsTest, CountingBeginsWithTheFirstDesiredTouch) {
  ticks(100, {});
  ticks(100, {touch(2, 0, 3)});
  ticks(4, {touch(0, 0, 0.5)});
  ticks(4, {});
  // Ticks without contact after the first touch count for links, not for the mean of the largest force.
  EXPECT_DOUBLE_EQ(value("contact_force_mean_N"), 0.5);
  EXPECT_DOUBLE_EQ(value("contact_force_max_mean_N"), 0.5);
  EXPECT_DOUBLE_EQ(value("links_in_contact_mean"), 0);  // four ticks are shorter than the hold
}

TEST_F(ContactMetricsTest, UndesiredForcesAreToldApart) {
  ticks(1, {touch(2, 0, 7)});
  ticks(1, {touch(0, 0, 0.5), touch(2, 0, 1), touch(2, 0, 1.5), touch(2, 1, 2)});
  EXPECT_DOUBLE_EQ(metrics.now().undesired_max_N, 2.5);
  EXPECT_DOUBLE_EQ(value("undesired_force_peak_N"), 7);
  EXPECT_DOUBLE_EQ(value("contact_force_peak_N"), 0.5);
  EXPECT_EQ(metrics.now().contacts, 1);
}

TEST_F(ContactMetricsTest, LinksInContactAreHeldForFiveMilliseconds) {
  ticks(10, {touch(0, 0, 0.5)});  // on in the fifth tick: counts in 6 of 10
  EXPECT_EQ(metrics.now().links, 1);
  EXPECT_DOUBLE_EQ(value("links_in_contact_mean"), 0.6);
  ticks(10, {touch(0, 0, 0.25), touch(0, 1, 0.25), touch(1, 0, 0.5)});  // one link is one link, on two objects too
  EXPECT_EQ(metrics.now().links, 2);
  EXPECT_DOUBLE_EQ(value("links_in_contact_mean"), (6 + 10 + 6) / 20.0);
}

TEST_F(ContactMetricsTest, SwitchesOfDesiredLinksOverTheTimeCounted) {
  ticks(100, {touch(0, 0, 0.5)});                     // on
  ticks(4, {});                                       // too short to be off
  ticks(96, {touch(0, 0, 0.5)});
  ticks(100, {touch(2, 0, 0.5)});                     // off; link 2 is not desired
  ticks(100, {touch(0, 0, 0.5), touch(1, 0, 0.5)});   // two on
  EXPECT_NEAR(value("contact_switches_per_s"), 4 / 0.4, 1e-9);
}

TEST(TouchSwitch, HysteresisKeepsWhatLiesBetweenTheThresholds) {
  TouchSwitch link;
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(link.update(0.04, dt));
  EXPECT_FALSE(link.on());
  for (int i = 0; i < 5; ++i) link.update(0.05, dt);
  EXPECT_TRUE(link.on());
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(link.update(0.03, dt));
  EXPECT_TRUE(link.on());
  for (int i = 0; i < 5; ++i) link.update(0.02, dt);
  EXPECT_FALSE(link.on());
}

TEST(TouchSwitch, HoldStartsAnewAfterEveryBreak) {
  TouchSwitch link;
  for (int k = 0; k < 20; ++k) {
    for (int i = 0; i < 4; ++i) EXPECT_FALSE(link.update(1, dt));
    EXPECT_FALSE(link.update(0, dt));
  }
  EXPECT_FALSE(link.on());
}

TEST_F(ContactMetricsTest, WhatIsNotToCountLeavesNoFigure) {
  double counts = 0;
  metrics = ContactMetrics(3, 2, {0, 1}, true);
  metrics.countWhile(&counts);
  ContactRecord self = touch(0, -1, 3);
  self.other_link = 1;
  ticks(20, {touch(0, 0, 5), touch(2, 0, 4), self});
  EXPECT_EQ(metrics.now().max_N, 5);                               // the log has it all the same
  EXPECT_TRUE(std::isnan(value("contact_force_peak_N")));
  EXPECT_EQ(value("undesired_force_peak_N"), 0);
  EXPECT_EQ(value("self_force_peak_N"), 0);
  counts = 1;
  ticks(10, {});
  ticks(10, {touch(0, 0, 0.5)});
  counts = 0;
  ticks(10, {touch(0, 0, 7)});
  EXPECT_DOUBLE_EQ(value("contact_force_peak_N"), 0.5);
  EXPECT_DOUBLE_EQ(value("contact_force_mean_N"), 0.5);
  // Of 10 ticks the first five and the last are those of a link whose switch is off; it went off while nothing touched.
  EXPECT_NEAR(value("links_in_contact_mean"), 0.6, 1e-12);
}

}  // namespace
}  // namespace tactus::runtime
