#include "framework/geometry/torus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;
constexpr double pi = std::numbers::pi;

TEST(Torus, RingByHand) {
  const Torus ring(0.1, 0.02, 2 * pi);
  EXPECT_NEAR(ring.distance(Vector3d::Zero()).distance, 0.08, 1e-16);
  EXPECT_NEAR(ring.distance({-0.15, 0, 0}).distance, 0.03, 1e-16);
  EXPECT_NEAR(ring.distance({0, 0.1, 0}).distance, -0.02, 1e-16);
  EXPECT_NEAR(ring.distance({0, 0.1 + 0.03, 0.04}).distance, 0.03, 1e-16);
}

TEST(Torus, HalfRingHasRoundEnds) {
  const Torus half(0.1, 0.02, pi);                                 // ends at (0, ±0.1, 0)
  EXPECT_NEAR(half.distance({0.15, 0, 0}).distance, 0.03, 1e-16);
  EXPECT_NEAR(half.distance({-0.05, 0.1, 0}).distance, 0.03, 1e-16);
  EXPECT_NEAR(half.distance({-0.05, -0.1, 0}).distance, 0.03, 1e-16);
  EXPECT_LT((half.distance({-0.05, -0.1, 0}).gradient - Vector3d(-1, 0, 0)).norm(), 1e-14);
  EXPECT_NEAR(half.distance({-0.1, 0, 0}).distance, std::sqrt(0.02) - 0.02, 1e-16);
  EXPECT_EQ(half.distance({-0.1, 0, 0}).gradient, half.distance({-0.1, 0, 0}).gradient);
}

TEST(Torus, SupportByHand) {
  EXPECT_LT((*Torus(0.1, 0.02, pi).support(-Vector3d::UnitX()) - Vector3d(-0.02, 0.1, 0)).norm(), 1e-15);
  EXPECT_EQ(*Torus(0.1, 0.02, pi).support(Vector3d::UnitZ()), Vector3d(0.1, 0, 0.02));
}

TEST(Torus, RefusesWhatIsNone) {
  EXPECT_THROW(Torus(0, 0.02, pi), std::invalid_argument);
  EXPECT_THROW(Torus(0.1, 0, pi), std::invalid_argument);
  EXPECT_THROW(Torus(0.1, 0.02, 0), std::invalid_argument);
  EXPECT_THROW(Torus(0.1, 0.02, 7), std::invalid_argument);
  EXPECT_THROW(Torus(0.1, 0.11, pi), std::invalid_argument);
  EXPECT_THROW(Torus(0.1, 0.02, NAN), std::invalid_argument);
  EXPECT_THROW(Torus(0.1, 0.02, 6.1), std::invalid_argument) << "the ends would overlap";
  EXPECT_NO_THROW(Torus(0.1, 0.02, 2 * pi));
  EXPECT_NO_THROW(Torus(0.1, 0.02, 6.2832));
  EXPECT_NO_THROW(Torus(0.1, 0.1, 2 * pi));
}

}  // namespace
}  // namespace tactus::geometry
