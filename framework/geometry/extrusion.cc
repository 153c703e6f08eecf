#include "framework/geometry/extrusion.h"

#include <algorithm>
#include <cmath>

#include "framework/geometry/lengths.h"

namespace tactus::geometry {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double level = 1e-9;                                     ///< components of a direction below it count as 0

double farthestCorner(const Outline& outline, double length) {
  double farthest = 0;
  for (const Vector2d& corner : outline.corners()) farthest = std::max(farthest, corner.norm());
  return std::hypot(farthest, 0.5 * positive("the length of an extrusion", length));
}

}  // namespace

Extrusion::Extrusion(std::vector<Vector2d> outline, double length) : Extrusion(Outline(std::move(outline)), length) {}

Extrusion::Extrusion(Outline outline, double length)
    : Shape(farthestCorner(outline, length), outline.isConvex()),
      outline_(std::move(outline)),
      length_(length),
      middle_(outline_.centroid()) {
  if (outline_.distance(middle_).distance > 0) middle_ = outline_.corners().front();
}

SignedDistance Extrusion::doDistance(const Vector3d& p) const {
  const PlanarDistance side = outline_.distance(p.head<2>());
  const double beyond_end = std::abs(p.z()) - 0.5 * length_;
  const double axial = std::copysign(1.0, p.z());
  if (side.distance > 0 && beyond_end > 0) {                       // nearest to the rim
    const double length = std::sqrt(side.distance * side.distance + beyond_end * beyond_end);
    const Vector2d sideways = side.distance / length * side.gradient;
    return {length, {sideways.x(), sideways.y(), beyond_end / length * axial}};
  }
  if (side.distance > beyond_end) return {side.distance, {side.gradient.x(), side.gradient.y(), 0}};
  return {beyond_end, {0, 0, axial}};
}

std::optional<Vector3d> Extrusion::doSupport(const Vector3d& n) const {
  const double z = std::abs(n.z()) < level ? 0 : std::copysign(0.5 * length_, n.z());
  Vector2d farthest = middle_;
  if (n.head<2>().norm() > level) {
    const auto& corners = outline_.corners();
    farthest = *std::max_element(corners.begin(), corners.end(), [&](const Vector2d& a, const Vector2d& b) {
      return a.dot(n.head<2>()) < b.dot(n.head<2>());
    });
  }
  return Vector3d(farthest.x(), farthest.y(), z);
}

}  // namespace tactus::geometry
