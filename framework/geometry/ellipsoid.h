#pragma once

#include <array>

#include "framework/geometry/shape.h"

namespace tactus::geometry {

/// Half axes along x y z about the origin.  Distances are exact to rounding: D. Eberly, *Distance from a point to an
/// ellipse, an ellipsoid, or a hyperellipsoid* (2013), with Newton's method inside his bracket and bisection where that
/// does not halve it.
class Ellipsoid final : public Shape {
 public:
  /// m.  Throws std::invalid_argument unless each is finite and above 0, the longest at most 1000 times the shortest.
  explicit Ellipsoid(const Eigen::Vector3d& radii);
  const Eigen::Vector3d& radii() const { return radii_; }

 private:
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;

  Eigen::Vector3d radii_;
  std::array<int, 3> axis_;                                        // from the longest to the shortest
  Eigen::Vector3d sorted_;                                         // e, in that order
  Eigen::Vector3d gap_;                                            // (eᵢ² − e₂²)/e₂²
};

}  // namespace tactus::geometry
