#include "framework/geometry/cone.h"

#include <algorithm>
#include <cmath>

#include "framework/geometry/lengths.h"
#include "framework/geometry/surface.h"

namespace tactus::geometry {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double level = 1e-9;                                     ///< components of a direction below it count as 0

double boundingRadius(double bottom, double top, double length) {
  if (!(bottom >= 0) || !(top >= 0)) throw std::invalid_argument("the radii of a cone are finite and ≥ 0");
  return std::hypot(positive("the larger radius of a cone", std::max(bottom, top)),
                    0.5 * positive("the length of a cone", length));
}

}  // namespace

Cone::Cone(double bottom_radius, double top_radius, double length)
    : Shape(geometry::boundingRadius(bottom_radius, top_radius, length), true),
      bottom_radius_(bottom_radius),
      top_radius_(top_radius),
      length_(length),
      slant_(Vector2d(top_radius - bottom_radius, length).normalized()) {}

SignedDistance Cone::doDistance(const Vector3d& p) const {
  const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const Vector3d radial = rho > 0 ? Vector3d(p.x() / rho, p.y() / rho, 0) : Vector3d::UnitX();
  const auto inSpace = [&](double distance, double outward, double up) -> SignedDistance {
    return {distance, outward * radial + up * Vector3d::UnitZ()};
  };
  const double half = 0.5 * length_;
  const Vector2d bottom(bottom_radius_, -half), top(top_radius_, half), q(rho, p.z());
  const Vector2d normal(slant_.y(), -slant_.x());
  const double beyond_side = (q - bottom).dot(normal);
  const double below = -half - q.y(), above = q.y() - half;
  if (beyond_side <= 0 && below <= 0 && above <= 0) {
    if (beyond_side >= std::max(below, above)) return inSpace(beyond_side, normal.x(), normal.y());
    return below > above ? inSpace(below, 0, -1) : inSpace(above, 0, 1);
  }
  if (below > 0 && rho <= bottom_radius_) return inSpace(below, 0, -1);
  if (above > 0 && rho <= top_radius_) return inSpace(above, 0, 1);
  const double along = (q - bottom).dot(slant_), slant_length = (top - bottom).dot(slant_);
  if (along > 0 && along < slant_length) return inSpace(beyond_side, normal.x(), normal.y());
  const Vector2d offset = q - (along > 0 ? top : bottom);          // nearest to a rim or the tip
  const double distance = offset.norm();
  if (distance == 0) return inSpace(0, normal.x(), normal.y());
  return inSpace(distance, offset.x() / distance, offset.y() / distance);
}

std::optional<Vector3d> Cone::doSupport(const Vector3d& n) const {
  const double sideways = n.head<2>().norm();
  if (sideways < level) return Vector3d(0, 0, std::copysign(0.5 * length_, n.z()));
  const double at_top = top_radius_ * sideways + 0.5 * length_ * n.z();
  const double at_bottom = bottom_radius_ * sideways - 0.5 * length_ * n.z();
  const double radius = at_top > at_bottom ? top_radius_ : bottom_radius_;
  return Vector3d(radius / sideways * n.x(), radius / sideways * n.y(), (at_top > at_bottom ? 0.5 : -0.5) * length_);
}

TriangleMesh Cone::doSurface() const {
  const double half = 0.5 * length_;
  return lathe({{0, -half}, {bottom_radius_, -half}, {top_radius_, half}, {0, half}});
}

}  // namespace tactus::geometry
