// When a task takes part: windows, ports and switches, its share from tick to tick, and rows that do not flicker.

#include "framework/control/activation.h"

#include <gtest/gtest.h>

namespace tactus::control {
namespace {

constexpr double dt = 0.001;

/// Ticks from `first` to `last`, both included; how often rows came or went.
int run(Activation& activation, int first, int last) {
  int changes = 0;
  for (int k = first; k <= last; ++k) changes += activation.advance(dt * k, dt);
  return changes;
}

TEST(Activation, WhatIsActiveFromTheFirstTickHasItsWholeShare) {
  Activation activation;
  EXPECT_EQ(run(activation, 0, 0), 0);
  EXPECT_TRUE(activation.stands());
  EXPECT_EQ(activation.share(), 1);
  EXPECT_FALSE(activation.isConditional());
}

TEST(Activation, FollowsItsWindowOverTheRamp) {
  ActiveWhen when;
  when.from = 0.1;
  when.until = 0.3;
  when.ramp = 0.02;
  Activation activation(when);
  EXPECT_TRUE(activation.isConditional());
  EXPECT_EQ(run(activation, 0, 99), 0);
  EXPECT_FALSE(activation.stands());
  EXPECT_EQ(activation.share(), 0);
  EXPECT_EQ(run(activation, 100, 100), 1);
  EXPECT_TRUE(activation.stands());
  EXPECT_NEAR(activation.share(), 0.05, 1e-12);
  EXPECT_EQ(run(activation, 101, 109), 0);
  EXPECT_NEAR(activation.share(), 0.5, 1e-12);
  run(activation, 110, 299);
  EXPECT_EQ(activation.share(), 1);
  run(activation, 300, 309);
  EXPECT_NEAR(activation.share(), 0.5, 1e-12);
  EXPECT_EQ(run(activation, 310, 318), 0);
  EXPECT_TRUE(activation.stands());
  EXPECT_EQ(run(activation, 319, 319), 1);
  EXPECT_FALSE(activation.stands());
  EXPECT_EQ(activation.share(), 0);
}

TEST(Activation, AllConditionsMustHold) {
  double port = 0.4;
  ActiveWhen when;
  when.on = &port;
  when.ramp = 0;
  Activation activation(when);
  run(activation, 0, 0);
  EXPECT_FALSE(activation.stands());
  port = 0.6;
  EXPECT_EQ(run(activation, 1, 1), 1);
  EXPECT_EQ(activation.share(), 1) << "without a ramp at once";
  activation.setActive(false);
  EXPECT_EQ(run(activation, 2, 2), 1);
  EXPECT_FALSE(activation.stands());
  activation.setActive(true);
  port = 0;
  EXPECT_EQ(run(activation, 3, 3), 0);
  EXPECT_FALSE(activation.stands());
}

TEST(Activation, AConditionThatFlickersLeavesTheRowsStanding) {
  double port = 0;
  ActiveWhen when;
  when.on = &port;
  when.ramp = 0.02;
  Activation activation(when);
  int changes = 0;
  for (int k = 0; k < 1000; ++k) {
    port = k % 2;
    changes += activation.advance(dt * k, dt);
  }
  EXPECT_EQ(changes, 1) << "they come once and stay";
  port = 0;
  EXPECT_EQ(run(activation, 1000, 1018), 0);
  EXPECT_EQ(run(activation, 1019, 1100), 1);
}

}  // namespace
}  // namespace tactus::control
