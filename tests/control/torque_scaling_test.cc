#include "framework/control/torque_scaling.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace tactus::control {
namespace {

TorqueLimits limits(std::initializer_list<double> lower, std::initializer_list<double> upper) {
  TorqueLimits result;
  result.lower = Eigen::Map<const Eigen::VectorXd>(lower.begin(), lower.size());
  result.upper = Eigen::Map<const Eigen::VectorXd>(upper.begin(), upper.size());
  return result;
}

TEST(TorqueScaling, TakesTheLargestFactorThatFits) {
  std::mt19937 random(1);
  std::normal_distribution<> normal;
  int cut = 0;
  for (int k = 0; k < 300; ++k) {
    TorqueLimits box{Eigen::VectorXd(4), Eigen::VectorXd(4), {}};
    Eigen::VectorXd torque(4);
    for (int i = 0; i < 4; ++i) {
      box.lower[i] = -std::abs(normal(random));
      box.upper[i] = std::abs(normal(random));
      torque[i] = normal(random);
    }
    const Eigen::VectorXd before = torque;
    const TorqueScaling scaling = scaleIntoLimits(box, torque);
    EXPECT_TRUE(scaling.possible);
    EXPECT_LE((torque - scaling.scale * before).norm(), 1e-15 * before.norm());
    EXPECT_TRUE((torque.array() <= box.upper.array()).all() && (torque.array() >= box.lower.array()).all());
    if (scaling.scale == 1) continue;
    ++cut;
    const Eigen::VectorXd more = 1.001 * torque;
    EXPECT_TRUE((more.array() > box.upper.array()).any() || (more.array() < box.lower.array()).any());
  }
  EXPECT_GE(cut, 100);
}

TEST(TorqueScaling, InfiniteLimitsDoNotBind) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Eigen::VectorXd torque = Eigen::Vector2d(1e9, -1e9);
  EXPECT_EQ(scaleIntoLimits(limits({-infinity, -infinity}, {infinity, infinity}), torque).scale, 1);
  EXPECT_EQ(torque, Eigen::Vector2d(1e9, -1e9));
}

TEST(TorqueScaling, LimitsThatLeaveOutZeroCanStillBeMet) {
  Eigen::VectorXd torque = Eigen::Vector2d(4, 2);
  const TorqueScaling scaling = scaleIntoLimits(limits({1, 0}, {2, 9}), torque);
  EXPECT_TRUE(scaling.possible);
  EXPECT_EQ(torque, Eigen::Vector2d(2, 1));
}

TEST(TorqueScaling, WhereNoFactorFitsEachJointIsCut) {
  Eigen::VectorXd torque = Eigen::Vector2d(4, -2);
  EXPECT_FALSE(scaleIntoLimits(limits({1, 1}, {2, 3}), torque).possible);
  EXPECT_EQ(torque, Eigen::Vector2d(2, 1));
  torque = Eigen::Vector2d::Zero();
  EXPECT_FALSE(scaleIntoLimits(limits({-1, 1}, {2, 3}), torque).possible);
  EXPECT_EQ(torque, Eigen::Vector2d(0, 1));
}

}  // namespace
}  // namespace tactus::control
