#pragma once

#include "framework/geometry/shape.h"

namespace tactus::geometry {

/// A cone along z about the middle of its axis, whole or truncated: its radius goes evenly from that at the bottom
/// (−length/2) to that at the top (+length/2).  Convex; distances are exact.
class Cone final : public Shape {
 public:
  /// m.  Throws std::invalid_argument unless all are finite, the length is above 0, no radius is below 0 and one is
  /// above.
  Cone(double bottom_radius, double top_radius, double length);
  double bottomRadius() const { return bottom_radius_; }
  double topRadius() const { return top_radius_; }
  double length() const { return length_; }

 private:
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;

  double bottom_radius_;
  double top_radius_;
  double length_;
  Eigen::Vector2d slant_;                                          // unit, (ρ, z), up the side
};

}  // namespace tactus::geometry
