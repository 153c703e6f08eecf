#include "framework/geometry/primitives.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "framework/geometry/lengths.h"
#include "framework/geometry/surface.h"

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

/// Components of a direction smaller than this are taken as level: of an edge or face that is farthest as a whole, the
/// middle.
constexpr double level = 1e-9;

/// Sign of a component of a direction, 0 where it is level.
double side(double component) { return std::abs(component) < level ? 0 : std::copysign(1.0, component); }

/// How far out the points inside a flat face lie, of the way to its border.
constexpr double inner = 0.6;

/// Distance to a sphere about the origin, with a fixed answer at its centre.
SignedDistance fromCentre(const Vector3d& offset, double radius, const Vector3d& normal_at_centre) {
  const double length = offset.norm();
  if (length == 0) return {-radius, normal_at_centre};
  return {length - radius, offset / length};
}

}  // namespace

Plane::Plane() : Shape(std::numeric_limits<double>::infinity(), true) {}

SignedDistance Plane::doDistance(const Vector3d& p) const { return {p.z(), Vector3d::UnitZ()}; }

std::optional<Vector3d> Plane::doSupport(const Vector3d&) const { return std::nullopt; }

Box::Box(const Vector3d& size) : Shape(positive("half the diagonal of a box", 0.5 * size.norm()), true), size_(size) {
  for (const double edge : size) positive("the edge of a box", edge);
}

SignedDistance Box::doDistance(const Vector3d& p) const {
  const Vector3d beyond = p.cwiseAbs() - 0.5 * size_;              // per axis: > 0 outside that pair of faces
  const Vector3d outside = beyond.cwiseMax(0);
  const double length = outside.norm();
  if (length > 0) {
    Vector3d normal = outside / length;
    for (int i = 0; i < 3; ++i) normal[i] = std::copysign(normal[i], p[i]);
    return {length, normal};
  }
  int face = 0;
  const double depth = beyond.maxCoeff(&face);
  Vector3d normal = Vector3d::Zero();
  normal[face] = std::copysign(1.0, p[face]);
  return {depth, normal};
}

std::optional<Vector3d> Box::doSupport(const Vector3d& n) const { return n.unaryExpr(&side).cwiseProduct(size_ / 2); }

std::vector<Feeler> Box::doFeelers() const {
  const Vector3d half = size_ / 2;
  std::vector<Feeler> feelers;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    feelers.push_back({half.cwiseProduct(side), half.cwiseProduct(side)});
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int edge = 0; edge < 4; ++edge) {
      Vector3d from = half;
      if (edge & 1) from[(axis + 1) % 3] *= -1;
      if (edge & 2) from[(axis + 2) % 3] *= -1;
      Vector3d to = from;
      to[axis] *= -1;
      feelers.push_back({from, to, 0, false});
    }
  for (int axis = 0; axis < 3; ++axis)
    for (int point = 0; point < 8; ++point) {
      Vector3d inside = inner * half;
      inside[axis] = half[axis];
      for (int i = 0; i < 3; ++i)
        if (point >> i & 1) inside[i] *= -1;
      feelers.push_back({inside, inside});
    }
  return feelers;
}

Sphere::Sphere(double radius) : Shape(positive("the radius of a sphere", radius), true) {}

SignedDistance Sphere::doDistance(const Vector3d& p) const { return fromCentre(p, radius(), Vector3d::UnitZ()); }

std::optional<Vector3d> Sphere::doSupport(const Vector3d& n) const { return radius() * n; }

std::vector<Feeler> Sphere::doFeelers() const { return {{Vector3d::Zero(), Vector3d::Zero(), radius()}}; }

Cylinder::Cylinder(double radius, double length)
    : Shape(std::hypot(positive("the radius of a cylinder", radius), 0.5 * positive("the length of a cylinder", length)),
            true),
      radius_(radius),
      length_(length) {}

SignedDistance Cylinder::doDistance(const Vector3d& p) const {
  const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const Vector3d radial = rho > 0 ? Vector3d(p.x() / rho, p.y() / rho, 0) : Vector3d::UnitX();
  const Vector3d axial(0, 0, std::copysign(1.0, p.z()));
  const double beyond_side = rho - radius_;
  const double beyond_end = std::abs(p.z()) - 0.5 * length_;
  if (beyond_side > 0 && beyond_end > 0) {                         // nearest to the rim
    const double length = std::sqrt(beyond_side * beyond_side + beyond_end * beyond_end);
    return {length, (beyond_side * radial + beyond_end * axial) / length};
  }
  if (beyond_side > beyond_end) return {beyond_side, radial};
  return {beyond_end, axial};
}

std::optional<Vector3d> Cylinder::doSupport(const Vector3d& n) const {
  Vector3d point(0, 0, side(n.z()) * length_ / 2);
  const double radial = n.head<2>().norm();
  if (radial > level) point.head<2>() = radius_ / radial * n.head<2>();
  return point;
}

std::vector<Feeler> Cylinder::doFeelers() const {
  constexpr int count = 24;
  std::vector<Feeler> feelers;
  for (const double z : {-length_ / 2, length_ / 2})
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      const Vector3d point(radius_ * std::cos(angle), radius_ * std::sin(angle), z);
      feelers.push_back({point, point, 0, true, 1.0 / 3});
      if (i % 4 != 0) continue;
      const Vector3d inside(inner * point.x(), inner * point.y(), z);
      feelers.push_back({inside, inside, 0, true, 1.0 / 3});
    }
  return feelers;
}

Capsule::Capsule(double radius, double length)
    : Shape(positive("the radius of a capsule", radius) + 0.5 * positive("the length of a capsule", length), true),
      radius_(radius),
      length_(length) {}

SignedDistance Capsule::doDistance(const Vector3d& p) const {
  const double half = 0.5 * length_;
  const Vector3d nearest_on_axis(0, 0, std::clamp(p.z(), -half, half));
  return fromCentre(p - nearest_on_axis, radius_, Vector3d::UnitX());
}

std::optional<Vector3d> Capsule::doSupport(const Vector3d& n) const {
  return Vector3d(Vector3d(0, 0, side(n.z()) * length_ / 2) + radius_ * n);
}

std::vector<Feeler> Capsule::doFeelers() const {
  const Vector3d half(0, 0, length_ / 2);
  return {{-half, half, radius_}};
}

TriangleMesh Plane::doSurface() const {
  constexpr double half = 2;
  return {{{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

TriangleMesh Box::doSurface() const {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.vertices.push_back(
        0.5 * size_.cwiseProduct(Vector3d(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2},
                                   {1, 3, 7, 5}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

TriangleMesh Sphere::doSurface() const {
  return lathe(arc(Eigen::Vector2d::Zero(), radius(), -std::numbers::pi / 2, std::numbers::pi / 2));
}

TriangleMesh Cylinder::doSurface() const {
  const double half = 0.5 * length_;
  return lathe({{0, -half}, {radius_, -half}, {radius_, half}, {0, half}});
}

TriangleMesh Capsule::doSurface() const {
  const double half = 0.5 * length_, quarter = std::numbers::pi / 2;
  std::vector<Eigen::Vector2d> profile = arc({0, -half}, radius_, -quarter, 0);
  const std::vector<Eigen::Vector2d> top = arc({0, half}, radius_, 0, quarter);
  profile.insert(profile.end(), top.begin(), top.end());
  return lathe(profile);
}

}  // namespace tactus::geometry
