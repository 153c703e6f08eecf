#include "framework/geometry/shape.h"

#include <cmath>
#include <stdexcept>

namespace tactus::geometry {

Shape::Shape(double bounding_radius, bool convex, double error)
    : bounding_radius_(bounding_radius), convex_(convex), error_(error) {
  if (!(bounding_radius > 0)) throw std::invalid_argument("the bounding radius of a shape is > 0");
  if (!(error >= 0) || !std::isfinite(error)) throw std::invalid_argument("the error of a shape is finite and ≥ 0");
}

std::optional<Eigen::Vector3d> Shape::doSupport(const Eigen::Vector3d& n) const {
  if (std::isinf(bounding_radius_)) return std::nullopt;
  constexpr double far = 1e7;  // bias R²/2far R and cancellation far·2⁻⁵³ are alike there
  const Eigen::Vector3d p = far * bounding_radius_ * n;
  const SignedDistance nearest = distance(p);
  return p - nearest.distance * nearest.gradient;
}

}  // namespace tactus::geometry
