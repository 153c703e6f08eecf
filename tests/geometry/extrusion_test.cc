#include "framework/geometry/extrusion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

/// The letter U, 60 mm wide, its arms 20 mm thick.
Extrusion letter() {
  return Extrusion({{0, 0}, {0.06, 0}, {0.06, 0.08}, {0.04, 0.08}, {0.04, 0.02}, {0.02, 0.02}, {0.02, 0.08}, {0, 0.08}},
                   0.1);
}

TEST(Extrusion, ByHand) {
  EXPECT_NEAR(letter().distance({0.03, 0.06, 0}).distance, 0.01, 1e-16);         // between the arms
  EXPECT_NEAR(letter().distance({0.006, 0.05, 0.02}).distance, -0.006, 1e-16);   // in an arm
  EXPECT_NEAR(letter().distance({0.01, 0.05, 0.048}).distance, -0.002, 1e-16);   // in an arm, near its end face
  EXPECT_NEAR(letter().distance({0.01, 0.05, 0.07}).distance, 0.02, 1e-16);
  EXPECT_NEAR(letter().distance({-0.03, 0.05, 0.09}).distance, 0.05, 1e-15);     // off an edge
  EXPECT_LT((letter().distance({-0.03, 0.05, 0.09}).gradient - Vector3d(-0.6, 0, 0.8)).norm(), 1e-14);
  EXPECT_FALSE(letter().isConvex());
}

TEST(Extrusion, SupportOfALevelTopIsAPointOfIt) {
  EXPECT_EQ(*Extrusion({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}, 2).support(Vector3d::UnitZ()), Vector3d(0, 0, 1));
  EXPECT_NEAR(letter().distance(*letter().support(Vector3d::UnitZ())).distance, 0, 1e-16);
}

TEST(Extrusion, RefusesWhatIsNone) {
  EXPECT_THROW(Extrusion({{0, 0}, {1, 0}, {1, 1}}, 0), std::invalid_argument);
  EXPECT_THROW(Extrusion({{0, 0}, {1, 0}, {1, 1}}, INFINITY), std::invalid_argument);
  EXPECT_THROW(Extrusion({{0, 0}, {1, 1}, {1, 0}, {0, 1}}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::geometry
