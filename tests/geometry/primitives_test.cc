#include "framework/geometry/primitives.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

TEST(Distance, SignsAndFacesByHand) {
  const Box box({0.2, 0.4, 0.6});
  EXPECT_DOUBLE_EQ(box.distance(Vector3d(0.15, 0, 0)).distance, 0.05);
  EXPECT_DOUBLE_EQ(box.distance(Vector3d(-0.09, 0.01, 0.02)).distance, -0.1 + 0.09);
  EXPECT_EQ(box.distance(Vector3d(-0.09, 0.01, 0.02)).gradient, Vector3d(-1, 0, 0));
  EXPECT_NEAR(box.distance(Vector3d(0.13, 0.24, 0)).distance, 0.05, 1e-15);
  EXPECT_DOUBLE_EQ(Plane().distance(Vector3d(3, 4, -0.5)).distance, -0.5);
  EXPECT_DOUBLE_EQ(Sphere(0.03).distance(Vector3d(0, 0.04, 0.03)).distance, 0.02);
  EXPECT_DOUBLE_EQ(Sphere(0.03).distance(Vector3d::Zero()).distance, -0.03);
  EXPECT_DOUBLE_EQ(Cylinder(0.1, 0.2).distance(Vector3d(0.13, 0, 0.14)).distance, 0.05);
  EXPECT_DOUBLE_EQ(Cylinder(0.1, 0.2).distance(Vector3d::Zero()).distance, -0.1);
  EXPECT_DOUBLE_EQ(Capsule(0.1, 0.2).distance(Vector3d(0, 0, 0.25)).distance, 0.05);
  EXPECT_DOUBLE_EQ(Capsule(0.1, 0.2).distance(Vector3d(0, 0.2, 0.05)).distance, 0.1);
}

TEST(Support, OfAFlatTopIsItsMiddle) {
  EXPECT_EQ(*Box({0.2, 0.4, 0.6}).support(Vector3d::UnitZ()), Vector3d(0, 0, 0.3));
  EXPECT_EQ(*Cylinder(0.1, 0.6).support(-Vector3d::UnitZ()), Vector3d(0, 0, -0.3));
}

TEST(Shapes, RefuseLengthsThatAreNone) {
  EXPECT_THROW(Box({0.1, 0, 0.1}), std::invalid_argument);
  EXPECT_THROW(Box({0.1, -1, 0.1}), std::invalid_argument);
  EXPECT_THROW(Sphere(0), std::invalid_argument);
  EXPECT_THROW(Sphere(std::nan("")), std::invalid_argument);
  EXPECT_THROW(Cylinder(0.1, -0.1), std::invalid_argument);
  EXPECT_THROW(Capsule(INFINITY, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::geometry
