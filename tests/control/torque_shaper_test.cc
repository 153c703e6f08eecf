// From the torque that is wanted to the one that is applied: limits, rate, transfer.

#include "framework/control/torque_shaper.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace tactus::control {
namespace {

using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr double dt = 0.001, none = std::numeric_limits<double>::infinity();

TEST(TorqueShaper, WithoutARateItCutsAtTheLimitsAlone) {
  TorqueShaper shaper(Vector2d(10, 1), none, dt);
  shaper.apply(Vector2d(-3, 0.5));
  EXPECT_EQ(shaper.torque(), Vector2d(-3, 0.5));
  EXPECT_FALSE(shaper.limited());
  shaper.apply(Vector2d(30, -0.5));
  EXPECT_EQ(shaper.torque(), Vector2d(10, -0.5));
  EXPECT_TRUE(shaper.limited());
  EXPECT_FALSE(shaper.rateLimited());
}

TEST(TorqueShaper, TheFirstTorqueIsFreeAndEveryOtherKeepsTheRate) {
  TorqueShaper shaper(Vector2d(10, 1), 20, dt);                    // 0.2 and 0.02 N m a tick
  shaper.apply(Vector2d(5, 1));
  EXPECT_EQ(shaper.torque(), Vector2d(5, 1));
  EXPECT_FALSE(shaper.rateLimited());
  shaper.apply(Vector2d(5.1, 0));
  EXPECT_TRUE(shaper.rateLimited());
  EXPECT_NEAR(shaper.torque()[0], 5.1, 1e-15) << "a joint that need not wait does not";
  EXPECT_NEAR(shaper.torque()[1], 0.98, 1e-15);
  for (int k = 0; k < 49; ++k) shaper.apply(Vector2d(5.1, 0));
  EXPECT_NEAR(shaper.torque()[1], 0, 1e-12);
}

TEST(TorqueShaper, ATransferGoesOnFromWhereTheTorqueWas) {
  TorqueShaper shaper(Vector2d(10, 10), none, dt);
  shaper.apply(Vector2d(4, 0));
  shaper.startTransfer(0.1);
  for (int k = 1; k <= 100; ++k) {
    shaper.apply(Vector2d(0, 2));
    EXPECT_NEAR(shaper.torque()[0], 4 * (1 - k / 100.0), 1e-9);
    EXPECT_NEAR(shaper.torque()[1], 2 * (k / 100.0), 1e-9);
  }
  EXPECT_FALSE(shaper.transfers());
  shaper.apply(Vector2d(1, 1));
  EXPECT_EQ(shaper.torque(), Vector2d(1, 1));
}

TEST(TorqueShaper, ATransferThatBeginsInAnotherOneTakesItOver) {
  TorqueShaper shaper(Vector2d(10, 10), none, dt);
  shaper.apply(Vector2d(4, 0));
  shaper.startTransfer(0.1);
  for (int k = 0; k < 50; ++k) shaper.apply(Vector2d(0, 0));
  const double before = shaper.torque()[0];
  shaper.startTransfer(0.1);
  shaper.apply(Vector2d(-4, 0));
  EXPECT_NEAR(shaper.torque()[0], before - 6 * 0.01, 1e-9);
}

TEST(TorqueShaper, WhateverIsWantedAndSwitchedLimitsAndRateHold) {
  std::mt19937 random(7);
  std::normal_distribution<> normal;
  const VectorXd effort = VectorXd::LinSpaced(6, 0, 5);            // a joint without a motor, too
  const double rate = 30;
  TorqueShaper shaper(effort, rate, dt);
  shaper.apply(VectorXd::Zero(6));
  for (int k = 0; k < 20000; ++k) {
    const VectorXd before = shaper.torque();
    if (random() % 50 == 0) shaper.startTransfer(0.001 * static_cast<double>(random() % 100));
    const double size = std::pow(10, normal(random));
    shaper.apply(VectorXd::NullaryExpr(6, [&] { return size * normal(random); }));
    ASSERT_TRUE((shaper.torque().cwiseAbs().array() <= effort.array()).all());
    ASSERT_TRUE(((shaper.torque() - before).cwiseAbs().array() <= rate * dt * effort.array() + 1e-12).all());
  }
}

}  // namespace
}  // namespace tactus::control
