#include <cmath>
#include <random>

#include "conformance/allocation_count.h"
#include "conformance/laws.h"

namespace tactus::conformance {
namespace {

using Eigen::Vector3d;
using geometry::Shape;
using geometry::SignedDistance;

constexpr int kPoints = 4000;
constexpr double kRounding = 1e-9;                                 // of the shape's size

using Pointer = std::shared_ptr<const Shape>;

std::string text(const Vector3d& p) {
  return "(" + control::formatNumber(p.x()) + ", " + control::formatNumber(p.y()) + ", " + control::formatNumber(p.z()) +
         ")";
}

/// Random points in and around the shape; of one without end about its origin, 1 m wide.
class Points {
 public:
  explicit Points(const Shape& shape, unsigned seed = 1)
      : reach_(std::isfinite(shape.boundingRadius()) ? shape.boundingRadius() : 1), random_(seed) {}

  Vector3d next() {
    std::uniform_real_distribution<double> along(-1.5 * reach_, 1.5 * reach_);
    const double x = along(random_), y = along(random_), z = along(random_);
    return {x, y, z};
  }
  double reach() const { return reach_; }

 private:
  double reach_;
  std::mt19937 random_;
};

void checkDistance(const Shape& shape) {
  Points points(shape);
  const double slack = 2 * shape.error() + kRounding * points.reach();
  for (int k = 0; k < kPoints; ++k) {
    const Vector3d p = points.next(), q = points.next();
    const SignedDistance a = shape.distance(p), b = shape.distance(q);
    if (!std::isfinite(a.distance)) throw Broken{"its distance from " + text(p) + " is not finite"};
    if (std::abs(a.distance - b.distance) > (p - q).norm() + slack)
      throw Broken{"between " + text(p) + " and " + text(q) + " its distance changes by more than their distance"};
    if (p.norm() - shape.boundingRadius() > a.distance + slack)
      throw Broken{"it reaches beyond its bounding radius: it is " + control::formatNumber(a.distance) + " m from " +
                   text(p)};
  }
}

void checkGradient(const Shape& shape) {
  Points points(shape, 2);
  const double slack = 2 * shape.error() + kRounding * points.reach();
  for (int k = 0; k < kPoints; ++k) {
    const Vector3d p = points.next();
    const SignedDistance here = shape.distance(p);
    if (!(std::abs(here.gradient.norm() - 1) < 1e-9)) throw Broken{"its gradient at " + text(p) + " is no unit vector"};
    const Vector3d foot = p - here.distance * here.gradient;
    const double off = shape.distance(foot).distance;
    if (!(std::abs(off) <= slack))
      throw Broken{"from " + text(p) + " distance and gradient lead to " + text(foot) + ", which is " +
                   control::formatNumber(off) + " m from the surface"};
  }
}

void checkConvexity(const Shape& shape) {
  if (!shape.isConvex()) throw NotAsked{"it does not say that it is convex"};
  Points points(shape, 3);
  const double slack = 2 * shape.error() + kRounding * points.reach();
  for (int k = 0; k < kPoints; ++k) {
    const Vector3d p = points.next(), q = points.next();
    const double ends = 0.5 * (shape.distance(p).distance + shape.distance(q).distance);
    if (shape.distance(0.5 * (p + q)).distance > ends + slack)
      throw Broken{"it says that it is convex, but between " + text(p) + " and " + text(q) + " it is not"};
  }
}

void checkSupport(const Shape& shape) {
  Points points(shape, 4);
  const double slack = 2 * shape.error() + 1e-6 * points.reach();
  for (int k = 0; k < kPoints / 10; ++k) {
    const Vector3d n = points.next().normalized();
    const auto farthest = shape.support(n);
    if (!farthest) {
      if (std::isfinite(shape.boundingRadius())) throw Broken{"it has no support point along " + text(n)};
      continue;
    }
    if (std::abs(shape.distance(*farthest).distance) > slack)
      throw Broken{"its support point along " + text(n) + " does not lie on its surface"};
    for (int i = 0; i < 20; ++i) {
      const Vector3d p = points.next();
      const SignedDistance nearest = shape.distance(p);
      const Vector3d foot = p - nearest.distance * nearest.gradient;
      if (foot.dot(n) > farthest->dot(n) + slack)
        throw Broken{text(foot) + " lies farther along " + text(n) + " than its support point"};
    }
  }
}

void checkAllocation(const Shape& shape) {
  Points points(shape, 5);
  shape.distance(points.next());
  for (int k = 0; k < kPoints; ++k) {
    const Vector3d p = points.next();
    const long before = allocationCount();
    shape.distance(p);
    if (allocationCount() != before) throw Broken{"its distance took memory"};
  }
}

void checkDeterminism(const Shape& one, const Shape& other) {
  Points points(one, 6);
  for (int k = 0; k < kPoints; ++k) {
    const Vector3d p = points.next();
    const SignedDistance a = one.distance(p), b = other.distance(p);
    if (a.distance != b.distance || a.gradient != b.gradient)
      throw Broken{"a second instance gave another distance from " + text(p)};
  }
}

}  // namespace

void checkShape(const Subject& subject, const control::ElementValues& values, Report& report) {
  const Pointer shape = subject.registry.makeShape(values);
  judge(subject, "distance", report, [&] { checkDistance(*shape); });
  judge(subject, "gradient", report, [&] { checkGradient(*shape); });
  judge(subject, "convexity", report, [&] { checkConvexity(*shape); });
  const bool leads_to_surface = report.findings[report.findings.size() - 2].outcome == Outcome::kept;
  if (leads_to_surface) judge(subject, "support", report, [&] { checkSupport(*shape); });
  judge(subject, "allocation", report, [&] { checkAllocation(*shape); });
  judge(subject, "determinism", report, [&] { checkDeterminism(*shape, *subject.registry.makeShape(values)); });
}

}  // namespace tactus::conformance
