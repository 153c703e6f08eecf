#include "framework/geometry/cone.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

TEST(Cone, ByHand) {
  const Cone cone(0.3, 0, 0.4);                                    // side of slope 3-4-5
  EXPECT_NEAR(cone.distance({0, 0, 0.25}).distance, 0.05, 1e-15);
  EXPECT_NEAR(cone.distance({0, 0, -0.25}).distance, 0.05, 1e-15);
  EXPECT_NEAR(cone.distance({0.15 + 0.08, 0, 0.06}).distance, 0.1, 1e-15);
  EXPECT_LT((cone.distance({0.15 + 0.08, 0, 0.06}).gradient - Vector3d(0.8, 0, 0.6)).norm(), 1e-14);
  EXPECT_NEAR(cone.distance({0, 0, 0}).distance, -0.12, 1e-15);
  EXPECT_NEAR(cone.distance({0, 0, -0.15}).distance, -0.05, 1e-15);
  EXPECT_NEAR(cone.distance({0.33, 0, -0.24}).distance, 0.05, 1e-15);  // off the rim
  EXPECT_EQ(cone.distance({0, 0, 0.2}).distance, 0);
  EXPECT_NEAR(Cone(0.1, 0.1, 0.4).distance({0.15, 0, 0}).distance, 0.05, 1e-15);
}

TEST(Cone, SupportIsItsTipOrTheMiddleOfAnEnd) {
  EXPECT_EQ(*Cone(0.3, 0, 0.4).support(Vector3d::UnitZ()), Vector3d(0, 0, 0.2));
  EXPECT_EQ(*Cone(0.3, 0.1, 0.4).support(-Vector3d::UnitZ()), Vector3d(0, 0, -0.2));
  EXPECT_EQ(*Cone(0.3, 0.1, 0.4).support(Vector3d::UnitX()), Vector3d(0.3, 0, -0.2));
}

TEST(Cone, RefusesLengthsThatAreNone) {
  EXPECT_THROW(Cone(0, 0, 0.1), std::invalid_argument);
  EXPECT_THROW(Cone(-0.1, 0.1, 0.1), std::invalid_argument);
  EXPECT_THROW(Cone(0.1, -0.1, 0.1), std::invalid_argument);
  EXPECT_THROW(Cone(0.1, NAN, 0.1), std::invalid_argument);
  EXPECT_THROW(Cone(INFINITY, 0, 0.1), std::invalid_argument);
  EXPECT_THROW(Cone(0.1, 0, 0), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::geometry
