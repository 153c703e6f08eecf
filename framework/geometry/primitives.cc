#include "framework/geometry/primitives.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "framework/geometry/lengths.h"

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

/// Components of a direction smaller than this are taken as level: of an edge or face that is farthest as a whole, the
/// middle.
constexpr double level = 1e-9;

/// Sign of a component of a direction, 0 where it is level.
double side(double component) { return std::abs(component) < level ? 0 : std::copysign(1.0, component); }

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

Sphere::Sphere(double radius) : Shape(positive("the radius of a sphere", radius), true) {}

SignedDistance Sphere::doDistance(const Vector3d& p) const { return fromCentre(p, radius(), Vector3d::UnitZ()); }

std::optional<Vector3d> Sphere::doSupport(const Vector3d& n) const { return radius() * n; }

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

}  // namespace tactus::geometry
