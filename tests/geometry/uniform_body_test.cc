// Volume, centre and inertia of solids from their distances alone, against what books say.

#include "framework/geometry/uniform_body.h"

#include <gtest/gtest.h>

#include <numbers>

#include "framework/geometry/primitives.h"

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

UniformBody bodyOf(const Shape& shape) {
  return uniformBody([&](const Vector3d& p) { return shape.distance(p).distance; }, Vector3d::Zero(),
                     shape.boundingRadius());
}

void expectMoments(const Shape& shape, double volume, const Vector3d& inertia_per_volume) {
  const UniformBody body = bodyOf(shape);
  EXPECT_NEAR(body.volume, volume, 0.005 * volume);
  EXPECT_LT(body.centre.norm(), 1e-3 * shape.boundingRadius());
  const Vector3d inertia = volume * inertia_per_volume;
  EXPECT_LT((body.inertia.diagonal() - inertia).norm(), 0.01 * inertia.norm());
  EXPECT_LT((body.inertia - Eigen::Matrix3d(body.inertia.diagonal().asDiagonal())).norm(), 1e-3 * inertia.norm());
}

TEST(UniformBody, OfABall) {
  const double r = 0.03;
  expectMoments(Sphere(r), 4.0 / 3 * std::numbers::pi * r * r * r, Vector3d::Constant(0.4 * r * r));
}

TEST(UniformBody, OfABox) {
  const Vector3d size(0.1, 0.06, 0.04), squares = size.cwiseAbs2();
  expectMoments(Box(size), size.prod(),
                Vector3d(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()) / 12);
}

TEST(UniformBody, OfACan) {
  const double r = 0.03, h = 0.1, across = (3 * r * r + h * h) / 12;
  expectMoments(Cylinder(r, h), std::numbers::pi * r * r * h, {across, across, r * r / 2});
}

TEST(UniformBody, OfTwoThingsAsOne) {
  const Sphere ball(0.02);
  const Vector3d aside(0.1, 0, 0);
  const UniformBody pair = uniformBody(
      [&](const Vector3d& p) { return std::min(ball.distance(p).distance, ball.distance(p - aside).distance); },
      aside / 2, 0.07);
  const double volume = 8.0 / 3 * std::numbers::pi * 8e-6;
  EXPECT_NEAR(pair.volume, volume, 0.02 * volume);
  EXPECT_LT((pair.centre - aside / 2).norm(), 1e-4);
  EXPECT_NEAR(pair.inertia(1, 1), volume * (0.4 * 4e-4 + 0.05 * 0.05), 0.03 * pair.inertia(1, 1));
}

TEST(UniformBody, OfNothingIsNothing) {
  EXPECT_EQ(uniformBody([](const Vector3d&) { return 1.0; }, Vector3d::Zero(), 1).volume, 0);
}

}  // namespace
}  // namespace tactus::geometry
