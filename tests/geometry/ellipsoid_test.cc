#include "framework/geometry/ellipsoid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "framework/geometry/primitives.h"

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

TEST(Ellipsoid, OfEqualRadiiIsASphere) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  const Ellipsoid ball({0.1, 0.1, 0.1});
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p(uniform(engine), uniform(engine), uniform(engine));
    EXPECT_NEAR(ball.distance(p).distance, p.norm() - 0.1, 1e-15);
    EXPECT_LT((ball.distance(p).gradient - p.normalized()).norm(), 1e-14);
  }
  EXPECT_DOUBLE_EQ(ball.distance(Vector3d::Zero()).distance, -0.1);
}

TEST(Ellipsoid, OnItsAxesByHand) {
  const Ellipsoid egg({0.1, 0.3, 0.2});
  EXPECT_NEAR(egg.distance({0.15, 0, 0}).distance, 0.05, 1e-15);
  EXPECT_NEAR(egg.distance({0, -0.35, 0}).distance, 0.05, 1e-15);
  EXPECT_EQ(egg.distance({0, -0.35, 0}).gradient, Vector3d(0, -1, 0));
  EXPECT_NEAR(egg.distance({0, 0, 0.26}).distance, 0.06, 1e-15);
  EXPECT_NEAR(egg.distance(Vector3d::Zero()).distance, -0.1, 1e-15);
  EXPECT_EQ(egg.distance(Vector3d::Zero()).gradient, Vector3d(1, 0, 0)) << "one of two that are equally near";
  EXPECT_NEAR(egg.distance({0.09, 0, 0}).distance, -0.01, 1e-15);
}

/// The nearest points of points that are made from points of the surface, along its normal, no deeper than the least
/// radius of curvature, c²/a.
TEST(Ellipsoid, GivesBackThePointsThatItsNormalsWereDrawnFrom) {
  std::mt19937_64 engine(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 5000; ++i) {
    const double scale = std::pow(10, 2 * unit(engine));
    const Vector3d radii = 0.1 * Vector3d(1, std::pow(scale, unit(engine)), std::pow(scale, unit(engine)));
    if (radii.maxCoeff() > 1000 * radii.minCoeff()) continue;
    const Vector3d direction = Vector3d(unit(engine), i % 7 ? unit(engine) : 0, i % 5 ? unit(engine) : 0).normalized();
    const Vector3d x = direction.cwiseProduct(radii), n = direction.cwiseQuotient(radii).normalized();
    const double curvature_radius = radii.minCoeff() * radii.minCoeff() / radii.maxCoeff();
    for (const double offset : {-0.9 * curvature_radius, 0.0, 0.3 * radii.maxCoeff(), 100 * radii.maxCoeff()}) {
      const SignedDistance found = Ellipsoid(radii).distance(x + offset * n);
      const double size = radii.maxCoeff() + std::abs(offset);
      EXPECT_NEAR(found.distance, offset, 1e-14 * size) << radii.transpose();
      EXPECT_LT((x + offset * n - found.distance * found.gradient - x).norm(), 1e-9 * size) << radii.transpose();
    }
  }
}

TEST(Ellipsoid, IsSteadyAcrossThePlaneWhereBothSidesAreEquallyNear) {
  const Ellipsoid disc({0.1, 0.08, 0.02});
  for (const double x : {0.0, 0.03, 0.06, 0.09, 0.0959, 0.096, 0.0961, 0.0999})
    for (const double y : {0.0, 0.01, 0.05}) {
      const double on = disc.distance({x, y, 0}).distance;
      for (const double z : {1e-300, 1e-30, 1e-17, 1e-12, 1e-9}) {
        EXPECT_NEAR(disc.distance({x, y, z}).distance, on, 1.01 * z + 1e-16) << x << " " << y << " " << z;
        EXPECT_NEAR(disc.distance({x, y, z}).gradient.norm(), 1, 1e-12);
      }
    }
}

TEST(Ellipsoid, RefusesRadiiThatAreNone) {
  EXPECT_THROW(Ellipsoid({0, 0.1, 0.1}), std::invalid_argument);
  EXPECT_THROW(Ellipsoid({0.1, -1, 0.1}), std::invalid_argument);
  EXPECT_THROW(Ellipsoid({0.1, 0.1, NAN}), std::invalid_argument);
  EXPECT_THROW(Ellipsoid({0.1, 101, 0.1}), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::geometry
