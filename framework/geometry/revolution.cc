#include "framework/geometry/revolution.h"

#include <algorithm>
#include <cmath>

namespace tactus::geometry {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double level = 1e-9;                                     ///< directions this near to the axis are taken as it

double farthestCorner(const Outline& outline) {
  double farthest = 0;
  for (const Vector2d& corner : outline.corners()) farthest = std::max(farthest, corner.norm());
  return farthest;
}

}  // namespace

Revolution::Revolution(std::vector<Vector2d> profile) : Revolution(Outline::rightHalf(std::move(profile))) {}

Revolution::Revolution(Outline profile)
    : Shape(farthestCorner(profile), profile.isConvex()), profile_(std::move(profile)) {}

SignedDistance Revolution::doDistance(const Vector3d& p) const {
  const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const PlanarDistance nearest = profile_.distance({rho, p.z()});
  const Vector2d radial = rho > 0 ? Vector2d(p.head<2>() / rho) : Vector2d::UnitX();
  return {nearest.distance,
          {nearest.gradient.x() * radial.x(), nearest.gradient.x() * radial.y(), nearest.gradient.y()}};
}

std::optional<Vector3d> Revolution::doSupport(const Vector3d& n) const {
  const double sideways = n.head<2>().norm();
  const Vector2d in_plane(sideways > level ? sideways : 0, n.z());
  const Vector2d* farthest = nullptr;
  for (const Vector2d& corner : profile_.corners()) {
    const double ahead = farthest ? (corner - *farthest).dot(in_plane) : 1;
    if (ahead > 0 || (ahead == 0 && corner.x() < farthest->x())) farthest = &corner;
  }
  const Vector2d radial = sideways > level ? Vector2d(n.head<2>() / sideways) : Vector2d::UnitX();
  return Vector3d(farthest->x() * radial.x(), farthest->x() * radial.y(), farthest->y());
}

}  // namespace tactus::geometry
