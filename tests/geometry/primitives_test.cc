// Distances are tested against their own finite differences and against brute force over points of the surface, on
// random points around and in random primitives.  Points nearer than a margin to the medial set, where the gradient
// jumps, are left out of the gradient's test only.

#include "framework/geometry/primitives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <typeinfo>
#include <vector>

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

class Random {
 public:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector3d inCube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

 private:
  std::mt19937_64 engine_{20240607};
};

using Shapes = std::vector<std::shared_ptr<const Shape>>;

Shapes randomShapes(Random& random) {
  const auto length = [&] { return random.uniform(0.02, 0.2); };
  const Vector3d size(length(), length(), length());
  return {std::make_shared<Plane>(), std::make_shared<Box>(size), std::make_shared<Sphere>(length()),
          std::make_shared<Cylinder>(length(), length()), std::make_shared<Capsule>(length(), length())};
}

Vector3d differences(const Shape& shape, const Vector3d& p, double step) {
  Vector3d gradient;
  for (int i = 0; i < 3; ++i) {
    const Vector3d d = step * Vector3d::Unit(i);
    gradient[i] = (shape.distance(p + d).distance - shape.distance(p - d).distance) / (2 * step);
  }
  return gradient;
}

TEST(Distance, GradientIsUnitAndMatchesDifferencesAwayFromRidges) {
  Random random;
  constexpr double step = 1e-6, margin = 1e-4;
  int tested = 0, ridges = 0;
  for (int trial = 0; trial < 400; ++trial)
    for (const auto& shape : randomShapes(random)) {
      const Vector3d p = random.inCube(0.3);
      const SignedDistance here = shape->distance(p);
      ASSERT_NEAR(here.gradient.norm(), 1, 1e-12);
      bool ridge = false;                                          // does the gradient turn sharply within the margin?
      for (int i = 0; i < 3; ++i)
        for (double side : {-margin, margin}) {
          const Vector3d near = shape->distance(p + side * Vector3d::Unit(i)).gradient;
          ridge = ridge || (near - here.gradient).norm() > 0.1;
        }
      ridges += ridge;
      if (ridge) continue;
      ++tested;
      EXPECT_LT((differences(*shape, p, step) - here.gradient).norm(), 1e-6)
          << typeid(*shape).name() << " at " << p.transpose();
    }
  EXPECT_GT(tested, 1900);
  EXPECT_LT(ridges, 40);
}

/// Points spread over the surface, at most about `spacing` apart.
std::vector<Vector3d> surfacePoints(const Shape& shape, double spacing) {
  std::vector<Vector3d> points;
  const auto steps = [spacing](double length) { return std::max(1, static_cast<int>(std::ceil(length / spacing))); };
  const auto ring = [&](double radius, double z) {
    const int n = steps(2 * std::numbers::pi * radius);
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  };
  const auto cap = [&](double radius, double z, double side) {     // a half sphere
    const int n = steps(0.5 * std::numbers::pi * radius);
    for (int i = 0; i <= n; ++i) {
      const double angle = 0.5 * std::numbers::pi * i / n;
      ring(radius * std::cos(angle), z + side * radius * std::sin(angle));
    }
  };
  const auto wall = [&](double radius, double half) {
    const int n = steps(2 * half);
    for (int i = 0; i <= n; ++i) ring(radius, -half + 2 * half * i / n);
  };
  if (const auto* box = dynamic_cast<const Box*>(&shape)) {
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const int nu = steps(box->size()[u]), nv = steps(box->size()[v]);
      for (int i = 0; i <= nu; ++i)
        for (int j = 0; j <= nv; ++j)
          for (double side : {-0.5, 0.5}) {
            Vector3d p;
            p[axis] = side * box->size()[axis];
            p[u] = (static_cast<double>(i) / nu - 0.5) * box->size()[u];
            p[v] = (static_cast<double>(j) / nv - 0.5) * box->size()[v];
            points.push_back(p);
          }
    }
  } else if (const auto* ball = dynamic_cast<const Sphere*>(&shape)) {
    cap(ball->radius(), 0, 1);
    cap(ball->radius(), 0, -1);
  } else if (const auto* cylinder = dynamic_cast<const Cylinder*>(&shape)) {
    wall(cylinder->radius(), 0.5 * cylinder->length());
    for (double side : {-0.5, 0.5})
      for (int i = 0; i <= steps(cylinder->radius()); ++i)
        ring(cylinder->radius() * i / steps(cylinder->radius()), side * cylinder->length());
  } else if (const auto* capsule = dynamic_cast<const Capsule*>(&shape)) {
    wall(capsule->radius(), 0.5 * capsule->length());
    cap(capsule->radius(), 0.5 * capsule->length(), 1);
    cap(capsule->radius(), -0.5 * capsule->length(), -1);
  }
  return points;
}

TEST(Distance, EqualsBruteForceOverTheSurface) {
  Random random;
  constexpr double spacing = 2e-3;
  for (int trial = 0; trial < 4; ++trial) {
    const Shapes shapes = randomShapes(random);
    for (size_t s = 1; s < shapes.size(); ++s) {                   // a plane has no end to its surface
      const std::vector<Vector3d> surface = surfacePoints(*shapes[s], spacing);
      for (int i = 0; i < 60; ++i) {
        const Vector3d p = random.inCube(0.25);
        double nearest = 1;
        for (const Vector3d& point : surface) nearest = std::min(nearest, (point - p).norm());
        const SignedDistance exact = shapes[s]->distance(p);
        // No surface point is nearer than the distance, and the sample has one at most a spacing from the nearest.
        EXPECT_GE(nearest, std::abs(exact.distance) - 1e-12);
        EXPECT_LE(nearest, std::abs(exact.distance) + spacing);
        const Vector3d foot = p - exact.distance * exact.gradient;
        EXPECT_NEAR(shapes[s]->distance(foot).distance, 0, 1e-12) << "the foot lies on the surface";
      }
    }
  }
}

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

TEST(Distance, IsConvexAlongEveryLine) {
  Random random;
  for (int trial = 0; trial < 2000; ++trial)
    for (const auto& shape : randomShapes(random)) {
      const Vector3d a = random.inCube(0.2), b = random.inCube(0.2);
      const double ends = 0.5 * (shape->distance(a).distance + shape->distance(b).distance);
      EXPECT_LE(shape->distance(0.5 * (a + b)).distance, ends + 1e-15);
    }
}

TEST(Distance, BoundingRadiusHoldsTheSurface) {
  Random random;
  for (const auto& shape : randomShapes(random)) {
    const double radius = shape->boundingRadius();
    double farthest = 0;
    for (const Vector3d& p : surfacePoints(*shape, 2e-3)) farthest = std::max(farthest, p.norm());
    EXPECT_LE(farthest, radius + 1e-12);
    const bool is_plane = std::isinf(radius);
    EXPECT_TRUE(is_plane || farthest > radius - 1e-4);
  }
}

/// A shape that leaves the search for its support point to the base class.
class Bare final : public Shape {
 public:
  explicit Bare(std::shared_ptr<const Shape> shape) : Shape(shape->boundingRadius(), true), shape_(std::move(shape)) {}

 private:
  SignedDistance doDistance(const Vector3d& p) const override { return shape_->distance(p); }
  std::shared_ptr<const Shape> shape_;
};

TEST(Support, IsThePointFarthestAlongADirection) {
  Random random;
  for (int trial = 0; trial < 20; ++trial)
    for (const auto& shape : randomShapes(random)) {
      const Vector3d n = random.inCube(1).normalized();
      const auto point = shape->support(n);
      ASSERT_EQ(point.has_value(), std::isfinite(shape->boundingRadius()));
      if (!point) continue;
      EXPECT_NEAR(shape->distance(*point).distance, 0, 1e-12);
      for (const Vector3d& p : surfacePoints(*shape, 5e-3)) EXPECT_LE(p.dot(n), point->dot(n) + 1e-12);
      EXPECT_NEAR(Bare(shape).support(n)->dot(n), point->dot(n), 1e-6 * shape->boundingRadius());
    }
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
