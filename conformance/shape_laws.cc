#include "conformance/shape_laws.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <sstream>

#include "conformance/allocation_count.h"
#include "conformance/broken.h"

namespace tactus::conformance {
namespace {

using Eigen::Vector3d;
using geometry::Shape;
using geometry::SignedDistance;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector3d inCube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vector3d direction() {
    while (true) {
      const Vector3d v = inCube(1);
      if (v.norm() <= 1 && v.norm() > 1e-3) return v.normalized();
    }
  }

 private:
  std::mt19937_64 engine_;
};

double sizeOf(const Shape& shape) { return std::isfinite(shape.boundingRadius()) ? shape.boundingRadius() : 1; }

std::string at(const Vector3d& p) {
  std::ostringstream text;
  text.precision(17);
  text << " at (" << p.x() << ", " << p.y() << ", " << p.z() << ")";
  return text.str();
}

std::string shown(double number) {
  std::ostringstream text;
  text.precision(6);
  text << number;
  return text.str();
}

/// Half of the points anywhere, half near the surface.
std::vector<Vector3d> pointsAround(const Shape& shape, int count, unsigned seed) {
  Random random(seed);
  const double R = sizeOf(shape);
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    Vector3d p = random.inCube(1.3 * R);
    if (i % 2) {
      const SignedDistance nearest = shape.distance(p);
      p += (random.uniform(-0.05, 0.05) * R - nearest.distance) * nearest.gradient;
    }
    points.push_back(p);
  }
  return points;
}

/// Does the gradient turn within the margin?
bool isRidge(const Shape& shape, const Vector3d& p, double margin) {
  const Vector3d here = shape.distance(p).gradient;
  for (int i = 0; i < 3; ++i)
    for (const double side : {-margin, margin})
      if ((shape.distance(p + side * Vector3d::Unit(i)).gradient - here).norm() > 0.1) return true;
  return false;
}

void checkFinite(const Shape& shape) {
  const double R = sizeOf(shape);
  std::vector<Vector3d> points = pointsAround(shape, 400, 1);
  for (const double x : {-1000.0, -1.0, -0.5, 0.0, 0.5, 1.0, 1000.0})
    for (int axis = 0; axis < 3; ++axis) {
      points.push_back(R * x * Vector3d::Unit(axis));
      points.push_back(R * x * (Vector3d::Ones() - Vector3d::Unit(axis)));
    }
  for (int i = 0; i < 200; ++i) {
    const SignedDistance nearest = shape.distance(points[i]);
    points.push_back(points[i] - nearest.distance * nearest.gradient);
  }
  for (const Vector3d& p : points) {
    const SignedDistance nearest = shape.distance(p);
    if (!std::isfinite(nearest.distance)) throw Broken{"the distance is no number" + at(p)};
    if (!(std::abs(nearest.gradient.norm() - 1) < 1e-9))
      throw Broken{"the gradient has the length " + shown(nearest.gradient.norm()) + at(p)};
  }
}

void checkGradient(const Shape& shape) {
  const double R = sizeOf(shape), step = 1e-7 * R, margin = 1e-3 * R;
  int asked = 0;
  for (const Vector3d& p : pointsAround(shape, 1000, 2)) {
    if (isRidge(shape, p, margin)) continue;
    Vector3d differences;
    for (int i = 0; i < 3; ++i) {
      const Vector3d d = step * Vector3d::Unit(i);
      differences[i] = (shape.distance(p + d).distance - shape.distance(p - d).distance) / (2 * step);
    }
    const double length = differences.norm();
    if (shape.error() > 0 && length < 0.5) continue;               // a rounded ridge
    ++asked;
    const double turned = (differences / length - shape.distance(p).gradient).norm();
    if (!(turned < 1e-5)) throw Broken{"gradient and differences are " + shown(turned) + " apart" + at(p)};
    if (shape.error() == 0 && !(std::abs(length - 1) < 1e-5))
      throw Broken{"the distance changes by " + shown(length) + " per metre" + at(p)};
  }
  if (asked < 500) throw Broken{"the gradient turns almost everywhere"};
}

void checkLipschitz(const Shape& shape) {
  Random random(3);
  const double R = sizeOf(shape);
  for (const Vector3d& p : pointsAround(shape, 4000, 4)) {
    const double apart = R * std::pow(10, random.uniform(-4, 0));
    const Vector3d direction = random.direction(), q = p + apart * direction, close = p + 1e-7 * R * direction;
    const double here = shape.distance(p).distance;
    if (!(std::abs(shape.distance(q).distance - here) <= apart + 2 * shape.error() + 1e-12 * R))
      throw Broken{"the distance changes by more than that to a point " + shown(apart) + " m away" + at(p)};
    if (!(std::abs(shape.distance(close).distance - here) <= 4e-7 * R + 1e-12 * R))
      throw Broken{"the distance jumps" + at(p)};
  }
}

void checkFoot(const Shape& shape) {
  const double R = sizeOf(shape), slack = 1e-9 * R + 4 * shape.error();
  for (const Vector3d& p : pointsAround(shape, 2000, 5)) {
    const SignedDistance nearest = shape.distance(p);
    if (shape.error() > 0 && isRidge(shape, p, std::max(1e-3 * R, 2 * shape.error()))) continue;
    const double off = shape.distance(p - nearest.distance * nearest.gradient).distance;
    const double most = shape.error() > 0 ? slack + 0.3 * std::abs(nearest.distance) : slack;
    if (!(off <= most) || (nearest.distance > 0 && !(off >= -most)))
      throw Broken{"the foot is " + shown(off) + " m from the surface" + at(p)};
  }
}

void checkBounding(const Shape& shape) {
  if (std::isinf(shape.boundingRadius())) throw NotAsked{"it has no end"};
  Random random(6);
  const double R = shape.boundingRadius();
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = random.uniform(1, 5) * R * random.direction();
    const double nearer = p.norm() - R - shape.distance(p).distance;
    if (!(nearer <= shape.error() + 1e-9 * R))
      throw Broken{"it reaches " + shown(nearer) + " m out of its bounding sphere" + at(p)};
  }
}

void checkSupport(const Shape& shape) {
  Random random(7);
  const double R = sizeOf(shape), slack = 2e-7 * R + 2 * shape.error();
  std::vector<Vector3d> feet;
  for (const Vector3d& p : pointsAround(shape, 1000, 8)) {
    const SignedDistance nearest = shape.distance(p);
    const Vector3d foot = p - nearest.distance * nearest.gradient;
    if (shape.distance(foot).distance <= slack) feet.push_back(foot);
  }
  for (int i = 0; i < 306; ++i) {
    const Vector3d n = i < 6 ? Vector3d((i % 2 ? 1 : -1) * Vector3d::Unit(i / 2)) : random.direction();
    const auto point = shape.support(n);
    if (point.has_value() != std::isfinite(shape.boundingRadius()))
      throw Broken{"a support point and a finite bounding radius come together"};
    if (!point) continue;
    const double off = std::abs(shape.distance(*point).distance);
    if (!(off <= slack)) throw Broken{"the support point is " + shown(off) + " m off the surface, along" + at(n)};
    for (const Vector3d& foot : feet)
      if (foot.dot(n) - point->dot(n) > slack)
        throw Broken{"a point lies " + shown(foot.dot(n) - point->dot(n)) + " m farther out, along" + at(n)};
  }
}

void checkConvex(const Shape& shape) {
  if (!shape.isConvex()) throw NotAsked{"it does not claim to be convex"};
  const std::vector<Vector3d> points = pointsAround(shape, 4000, 9);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vector3d &a = points[i], &b = points[i + 1];
    const double mean = 0.5 * (shape.distance(a).distance + shape.distance(b).distance);
    const double above = shape.distance(0.5 * (a + b)).distance - mean;
    if (!(above <= 2 * shape.error() + 1e-12 * sizeOf(shape)))
      throw Broken{"half way between two points the distance is " + shown(above) + " m above the mean" +
                   at(0.5 * (a + b))};
  }
}

void checkDeterminism(const Shape& shape) {
  std::vector<Vector3d> points = pointsAround(shape, 500, 10);
  for (int axis = 0; axis < 3; ++axis) points.push_back(0.3 * sizeOf(shape) * Vector3d::Unit(axis));
  points.push_back(Vector3d::Zero());
  std::vector<SignedDistance> first;
  for (const Vector3d& p : points) first.push_back(shape.distance(p));
  for (std::size_t i = points.size(); i-- > 0;) {
    const SignedDistance again = shape.distance(points[i]);
    if (std::memcmp(&again.distance, &first[i].distance, sizeof again.distance) != 0 ||
        std::memcmp(again.gradient.data(), first[i].gradient.data(), 3 * sizeof(double)) != 0)
      throw Broken{"asked again, it answers otherwise" + at(points[i])};
  }
}

void checkAllocation(const Shape& shape) {
  const std::vector<Vector3d> points = pointsAround(shape, 500, 11);
  const long before = allocationCount();
  double sum = 0;
  for (const Vector3d& p : points) sum += shape.distance(p).distance;
  const long taken = allocationCount() - before;
  if (taken != 0 || std::isnan(sum)) throw Broken{"distances take memory, " + std::to_string(taken) + " times"};
}

}  // namespace

const std::vector<ShapeLaw>& shapeLaws() {
  static const std::vector<ShapeLaw> laws{
      {"finite", checkFinite},   {"gradient", checkGradient}, {"lipschitz", checkLipschitz},
      {"foot", checkFoot},       {"bounding", checkBounding}, {"support", checkSupport},
      {"convex", checkConvex},   {"determinism", checkDeterminism},
      {"allocation", checkAllocation}};
  return laws;
}

}  // namespace tactus::conformance
