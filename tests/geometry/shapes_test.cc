// Every shape, of random measures, keeps the laws that plugins' shapes are held to, and its distances are those to the
// nearest of dense points of its surface, which are made from its measures alone.  A broken shape for each law shows
// that the laws see it.

#include "tests/geometry/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "conformance/broken.h"
#include "conformance/shape_laws.h"
#include "framework/geometry/primitives.h"

namespace tactus::geometry_test {
namespace {

using Eigen::Vector3d;
using namespace geometry;

constexpr double spacing = 4e-3;

/// "" when the law is kept or not asked.
std::string broken(const conformance::ShapeLaw& law, const Shape& shape) {
  try {
    law.check(shape);
  } catch (const conformance::Broken& found) {
    return std::string(law.name) + ": " + found.message;
  } catch (const conformance::NotAsked&) {
  }
  return "";
}

const conformance::ShapeLaw& lawNamed(const std::string& name) {
  const auto& laws = conformance::shapeLaws();
  return *std::find_if(laws.begin(), laws.end(), [&](const auto& law) { return law.name == name; });
}

TEST(Shapes, KeepTheLaws) {
  Random random(1);
  for (int trial = 0; trial < 6; ++trial)
    for (const Specimen& specimen : exactShapes(random, 0.05))
      for (const conformance::ShapeLaw& law : conformance::shapeLaws())
        EXPECT_EQ(broken(law, *specimen.shape), "") << specimen.name << ", trial " << trial;
}

double toNearest(const std::vector<Vector3d>& points, const Vector3d& p) {
  double squared = 1e300;
  for (const Vector3d& point : points) squared = std::min(squared, (point - p).squaredNorm());
  return std::sqrt(squared);
}

TEST(Shapes, DistancesAreThoseToTheNearestOfDensePoints) {
  Random random(2);
  int inside = 0;
  for (int trial = 0; trial < 4; ++trial)
    for (const Specimen& specimen : exactShapes(random, spacing)) {
      if (specimen.surface.empty()) continue;
      for (const Vector3d& p : specimen.surface)
        ASSERT_LE(p.norm(), specimen.shape->boundingRadius() + 1e-12) << specimen.name;
      for (int i = 0; i < 60; ++i) {
        const Vector3d p = random.inCube(0.2);
        const double distance = specimen.shape->distance(p).distance, nearest = toNearest(specimen.surface, p);
        inside += distance < 0;
        // No surface point is nearer than the distance, and one of the dense ones is at most a spacing from the
        // nearest.
        EXPECT_GE(nearest, std::abs(distance) - 1e-12) << specimen.name << " at " << p.transpose();
        if (specimen.depth_is_exact || distance > 0) {
          EXPECT_LE(nearest, std::abs(distance) + spacing) << specimen.name << " at " << p.transpose();
        }
      }
    }
  EXPECT_GT(inside, 300);
}

/// Distances of a ball of 0.1 m that `change` spoils.
class Spoiled final : public Shape {
 public:
  using Change = std::function<void(const Vector3d& p, SignedDistance& nearest)>;
  explicit Spoiled(Change change, double bounding_radius = 0.1, bool convex = true)
      : Shape(bounding_radius, convex), change_(std::move(change)) {}

 private:
  SignedDistance doDistance(const Vector3d& p) const override {
    SignedDistance nearest = Sphere(0.1).distance(p);
    change_(p, nearest);
    return nearest;
  }
  Change change_;
};

TEST(ShapeLaws, SeeWhatIsBroken) {
  int calls = 0;
  std::unique_ptr<Vector3d> kept;
  const std::vector<std::pair<std::string, Spoiled>> spoiled{
      {"finite", Spoiled([](const Vector3d& p, SignedDistance& d) { if (p.x() > 0.1) d.distance = NAN; })},
      {"finite", Spoiled([](const Vector3d& p, SignedDistance& d) { if (p.isZero()) d.gradient.setZero(); })},
      {"gradient", Spoiled([](const Vector3d&, SignedDistance& d) { d.gradient = -d.gradient; })},
      {"gradient", Spoiled([](const Vector3d&, SignedDistance& d) { d.distance *= 0.9; })},
      {"lipschitz", Spoiled([](const Vector3d&, SignedDistance& d) { d.distance *= 1.1; })},
      {"foot", Spoiled([](const Vector3d& p, SignedDistance& d) { if (p.x() < 0) d.distance *= 0.9; })},
      {"bounding", Spoiled([](const Vector3d&, SignedDistance&) {}, 0.09)},
      {"support", Spoiled([](const Vector3d& p, SignedDistance& d) { if (p.norm() > 1e3) d.gradient = {1, 0, 0}; })},
      {"convex", Spoiled([](const Vector3d&, SignedDistance& d) { d.distance = -d.distance; })},
      {"determinism", Spoiled([&](const Vector3d&, SignedDistance& d) { d.distance += 1e-15 * (++calls % 7); })},
      {"allocation", Spoiled([&](const Vector3d& p, SignedDistance&) { kept = std::make_unique<Vector3d>(p); })}};
  for (const auto& [name, shape] : spoiled) EXPECT_NE(broken(lawNamed(name), shape), "") << name;
  const Spoiled sound([](const Vector3d&, SignedDistance&) {});
  for (const conformance::ShapeLaw& law : conformance::shapeLaws()) EXPECT_EQ(broken(law, sound), "");
}

TEST(ShapeLaws, SeeAJump) {
  const Spoiled jumps([](const Vector3d& p, SignedDistance& d) { if (p.x() > 0.0123) d.distance += 1e-3; });
  EXPECT_NE(broken(lawNamed("lipschitz"), jumps), "");
}

TEST(Support, IsFoundWhereTheShapeLeavesItToTheBaseClass) {
  const Spoiled ball([](const Vector3d&, SignedDistance&) {});     // has no support of its own
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vector3d n = random.inCube(1).normalized();
    EXPECT_LT((*ball.support(n) - 0.1 * n).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace tactus::geometry_test
