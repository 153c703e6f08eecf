#include "framework/geometry/revolution.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

/// A cup of 100 mm, its outer radius 50 mm, wall 4 mm and bottom 6 mm thick.
Revolution cup() { return Revolution({{0, 0}, {0.05, 0}, {0.05, 0.1}, {0.046, 0.1}, {0.046, 0.006}, {0, 0.006}}); }

TEST(Revolution, ACupByHand) {
  EXPECT_NEAR(cup().distance({0.07, 0, 0.05}).distance, 0.02, 1e-16);           // outside the wall
  EXPECT_NEAR(cup().distance({0, -0.036, 0.05}).distance, 0.01, 1e-16);         // inside the cup
  EXPECT_LT((cup().distance({0, -0.036, 0.05}).gradient - Vector3d(0, 1, 0)).norm(), 1e-15);
  EXPECT_NEAR(cup().distance({0.049, 0, 0.05}).distance, -0.001, 1e-16);        // in the wall, nearer to the outside
  EXPECT_NEAR(cup().distance({0.047, 0, 0.05}).distance, -0.001, 1e-16);        // in the wall, nearer to the inside
  EXPECT_LT((cup().distance({0.047, 0, 0.05}).gradient - Vector3d(-1, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(cup().distance({0, 0, 0.016}).distance, 0.01, 1e-16);             // over the bottom
  EXPECT_NEAR(cup().distance({0, 0, 0.002}).distance, -0.002, 1e-16);           // in the bottom, on the axis
  EXPECT_NEAR(cup().distance({0, 0, -0.01}).distance, 0.01, 1e-16);             // under it
  EXPECT_NEAR(cup().distance({0.048, 0, 0.11}).distance, 0.01, 1e-16);          // over the rim
  EXPECT_NEAR(cup().distance({0.053, 0, 0.104}).distance, 0.005, 1e-15);        // off the rim's outer edge
  EXPECT_NEAR(cup().distance({0, 0, 0.1}).distance, 0.046, 1e-16);              // in the middle of the mouth
  EXPECT_NEAR(cup().distance({0.051, 0.004, 0.005}).distance, std::hypot(0.051, 0.004) - 0.05, 1e-16);
  EXPECT_FALSE(cup().isConvex());
  EXPECT_DOUBLE_EQ(cup().boundingRadius(), std::hypot(0.05, 0.1));
}

TEST(Revolution, SupportOfALevelTopIsAPointOfIt) {
  EXPECT_EQ(*cup().support(Vector3d::UnitZ()), Vector3d(0.046, 0, 0.1)) << "the mouth is no part of it";
  EXPECT_EQ(*cup().support(-Vector3d::UnitZ()), Vector3d(0, 0, 0));
}

TEST(Revolution, RefusesAProfileAcrossTheAxisOrThroughItself) {
  EXPECT_THROW(Revolution({{-0.01, 0}, {0.1, 0}, {0.1, 0.1}}), std::invalid_argument);
  EXPECT_THROW(Revolution({{0, 0}, {0.1, 0.1}, {0.1, 0}, {0, 0.1}}), std::invalid_argument);
  EXPECT_THROW(Revolution({{0, 0}, {0.1, 0.1}}), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::geometry
