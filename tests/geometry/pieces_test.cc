// Pieces of shapes that are not convex: cuts of polygons, and the sum of springs over the pieces, which is that of the
// nearest point away from hollows, and once differentiable everywhere outside.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "framework/geometry/convex_parts.h"
#include "framework/geometry/distance_grid.h"
#include "framework/geometry/extrusion.h"
#include "framework/geometry/outline.h"
#include "framework/geometry/revolution.h"
#include "framework/geometry/torus.h"
#include "tests/geometry/shapes.h"

namespace tactus::geometry_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace geometry;
using Corners = std::vector<Vector2d>;

const Corners angle{{-0.1, -0.1}, {0.1, -0.1}, {0.1, -0.05}, {0, -0.05}, {0, 0.1}, {-0.1, 0.1}};
const Corners cup{{0, 0}, {0.05, 0}, {0.05, 0.1}, {0.046, 0.1}, {0.046, 0.006}, {0, 0.006}};
const Corners funnel{{0, 0}, {0.04, 0}, {0.08, 0.06}, {0.07, 0.06}, {0, 0.01}};
/// A hemisphere of 8 edges, hollow inside: obtuse hollows.
Corners bowl() {
  Corners corners;
  for (int i = 0; i <= 8; ++i) {
    const double a = 0.5 * std::numbers::pi * i / 8;
    corners.emplace_back(i == 0 ? 0 : 0.06 * std::sin(a), -0.06 * std::cos(a));
  }
  for (int i = 8; i >= 0; --i) {
    const double a = 0.5 * std::numbers::pi * i / 8;
    corners.emplace_back(i == 0 ? 0 : 0.05 * std::sin(a), -0.05 * std::cos(a));
  }
  return corners;
}

double area(const Corners& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % corners.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

/// Its corners at random lengths on the rays of a fan.
Corners star(Random& random) {
  const int count = 3 + static_cast<int>(random.uniform(0, 9));
  Corners corners;
  for (int i = 0; i < count; ++i) {
    const double a = 2 * std::numbers::pi * i / count;
    corners.emplace_back(random.length() * Vector2d(std::cos(a), std::sin(a)));
  }
  return corners;
}

TEST(ConvexParts, AreConvexMakeUpTheWholeAndMeetInTheCuts) {
  Random random(5);
  for (int trial = 0; trial < 300; ++trial) {
    const Corners corners = trial == 0 ? angle : trial == 1 ? cup : trial == 2 ? bowl() : star(random);
    const ConvexParts made = convexParts(corners);
    double sum = 0;
    for (const ConvexSet& part : made.parts) {
      ASSERT_GE(part.corners().size(), 3u);
      EXPECT_TRUE(Outline(part.corners()).isConvex()) << trial;
      sum += area(part.corners());
    }
    EXPECT_NEAR(sum, area(corners), 1e-15);
    EXPECT_EQ(made.cuts.size() + 1, made.parts.size());
    for (const auto& [diagonal, between] : made.cuts)
      for (const int part : between) {
        ASSERT_GE(part, 0);
        for (const Vector2d& end : diagonal.corners()) EXPECT_LT(made.parts[part].offset(end).norm(), 1e-15);
      }
  }
}

TEST(ConvexParts, OfACupAreItsWallAndItsBottom) {
  const ConvexParts made = convexParts(cup);
  ASSERT_EQ(made.parts.size(), 2u);
  EXPECT_EQ(made.cuts[0].diagonal.corners(), (Corners{{0.046, 0.006}, {0.05, 0}}));
}

struct Solid {
  const char* name;
  std::shared_ptr<const Shape> shape;
};

std::vector<Solid> solids() {
  Random random(8);
  std::vector<Solid> made{{"angle", std::make_shared<Extrusion>(angle, 0.05)},
                          {"cup", std::make_shared<Revolution>(cup)},
                          {"funnel", std::make_shared<Revolution>(funnel)},
                          {"bowl", std::make_shared<Revolution>(bowl())},
                          {"trough", std::make_shared<Extrusion>(bowl(), 0.1)},
                          {"ring", std::make_shared<Torus>(0.03, 0.012, 2 * std::numbers::pi)}};
  for (int i = 0; i < 10; ++i) made.push_back({"star", std::make_shared<Extrusion>(star(random), 0.05)});
  return made;
}

constexpr double radius = 0.015;

/// Energy of unit springs, and its gradient.
DistanceGrid::Sample energy(const std::vector<Piece>& pieces, const Vector3d& p) {
  DistanceGrid::Sample sum{0, Vector3d::Zero()};
  for (const Piece& piece : pieces) {
    const SignedDistance nearest = piece.shape->distance(p);
    const double depth = std::max(0.0, radius - nearest.distance);
    sum.value += 0.5 * piece.sign * depth * depth;
    sum.gradient -= piece.sign * depth * nearest.gradient;
  }
  return sum;
}

TEST(Pieces, AreTogetherAsNearAsTheWhole) {
  Random random(6);
  for (const Solid& solid : solids()) {
    const std::vector<Piece> pieces = solid.shape->pieces();
    if (solid.shape->isConvex()) continue;
    for (int i = 0; i < 1000; ++i) {
      const Vector3d p = random.inCube(0.15);
      double least = 1;
      int around = 0;
      for (const Piece& piece : pieces) {
        const double distance = piece.shape->distance(p).distance;
        if (piece.between[0] < 0) least = std::min(least, distance);
        if (distance <= 0) around += piece.sign;
      }
      EXPECT_NEAR(least, solid.shape->distance(p).distance, 1e-12) << solid.name;
      EXPECT_EQ(around, solid.shape->distance(p).distance <= 0 ? 1 : 0) << solid.name;
    }
  }
}

/// Along straight walks 5 mm or more off the surface, where no spring's slope turns faster than 10 mm/5 mm.  The nearest
/// point's alone jumps in hollows.
TEST(Pieces, GiveAnEnergyWhoseGradientIsContinuousAndRight) {
  Random random(7);
  int jumps_of_the_nearest = 0, shared = 0;
  for (const Solid& solid : solids()) {
    const std::vector<Piece> pieces = solid.shape->pieces();
    for (int walk = 0; walk < 100 && !pieces.empty(); ++walk) {
      const double step = 20e-6;
      const Vector3d from = random.inCube(0.1), stride = step * random.inCube(1).normalized();
      auto last = energy(pieces, from);
      SignedDistance last_nearest = solid.shape->distance(from);
      for (int i = 1; i < 2500; ++i) {
        const Vector3d p = from + i * stride;
        const auto here = energy(pieces, p);
        const SignedDistance nearest = solid.shape->distance(p);
        const bool off = std::min(nearest.distance, last_nearest.distance) > 5e-3;
        if (off && nearest.distance < radius) {
          const double bound = 2.0 * static_cast<double>(pieces.size()) * step;
          EXPECT_LT((here.gradient - last.gradient).norm(), bound) << solid.name << " at " << p.transpose();
          EXPECT_NEAR(here.value - last.value, 0.5 * (here.gradient + last.gradient).dot(stride), bound * step);
          const double depth = radius - nearest.distance, last_depth = radius - last_nearest.distance;
          jumps_of_the_nearest += (depth * nearest.gradient - last_depth * last_nearest.gradient).norm() > bound;
          shared += here.value > 1.0001 * 0.5 * depth * depth;
        }
        last = here;
        last_nearest = nearest;
      }
    }
  }
  EXPECT_GT(shared, 1000) << "balls that touch more than the nearest point";
  EXPECT_GT(jumps_of_the_nearest, 2) << "the walks pass hollows";
}

/// Left of and below the angle, and around the outside of a bowl and a cup: every cut is as far as a piece there.
TEST(Pieces, CancelAwayFromHollows) {
  Random random(9);
  int touching = 0;
  for (const Solid& solid : solids()) {
    const bool is_angle = std::string(solid.name) == "angle";
    if (!is_angle && std::string(solid.name) != "bowl" && std::string(solid.name) != "cup") continue;
    const std::vector<Piece> pieces = solid.shape->pieces();
    for (int i = 0; i < 20000; ++i) {
      const Vector3d p = random.inCube(0.12);
      const double distance = solid.shape->distance(p).distance;
      if (distance <= 0 || distance > radius) continue;
      const bool outside = is_angle ? p.x() < -0.1 || p.y() < -0.1 : p.head<2>().norm() > 0.06 || p.z() < -0.05;
      if (!outside) continue;
      ++touching;
      EXPECT_NEAR(energy(pieces, p).value, 0.5 * std::pow(radius - distance, 2), 1e-15) << solid.name;
    }
  }
  EXPECT_GT(touching, 500);
}

TEST(Pieces, OfACornerPressOnBothItsSides) {
  const Extrusion shape(angle, 0.05);
  const Vector3d p(radius - 1e-3, -0.05 + radius - 2e-3, 0);
  EXPECT_LT((energy(shape.pieces(), p).gradient + Vector3d(1e-3, 2e-3, 0)).norm(), 1e-12);
}

TEST(Pieces, AcrossTheAxisHoldABallOnAMouthInTheMiddle) {
  const double ball = radius;                                      // wider than a narrow cup's mouth
  const Corners narrow{{0, 0}, {0.012, 0}, {0.012, 0.1}, {0.01, 0.1}, {0.01, 0.006}, {0, 0.006}};
  const Revolution tube(narrow);
  const double height = std::sqrt(ball * ball - 0.01 * 0.01) - 1e-3;
  const auto on_axis = energy(tube.pieces(), {0, 0, 0.1 + height});
  EXPECT_LT(on_axis.gradient.head<2>().norm(), 1e-15);
  EXPECT_LT(on_axis.gradient.z(), -1e-4);
  const auto aside = energy(tube.pieces(), {1e-6, 0, 0.1 + height});
  EXPECT_LT(aside.gradient.head<2>().norm(), 2e-6) << "no jump";
  EXPECT_GT(aside.gradient.x(), 0) << "back to the middle";
}

TEST(Pieces, OfConvexShapesAreNone) {
  EXPECT_TRUE(Extrusion({{0, 0}, {0.1, 0}, {0, 0.1}}, 0.1).pieces().empty());
  EXPECT_TRUE(Revolution({{0, 0}, {0.1, 0}, {0, 0.1}}).pieces().empty());
}

}  // namespace
}  // namespace tactus::geometry_test
