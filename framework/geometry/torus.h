#pragma once

#include "framework/geometry/shape.h"

namespace tactus::geometry {

/// What a ball sweeps along an arc of a circle about z, in the plane z = 0, from −angle/2 to +angle/2 about +x: a ring
/// when the angle is 2π (to a thousandth), else a bent rod with round ends.  Distances are exact.
class Torus final : public Shape {
 public:
  /// `radius` of the circle and of the tube in m, `angle` in rad.  Throws std::invalid_argument unless all are finite
  /// and above 0, the angle is at most 2π, the tube no thicker than its circle, and the two ends keep clear of each
  /// other (what overlaps is not as deep as it looks).
  Torus(double radius, double tube_radius, double angle);
  double radius() const { return radius_; }
  double tubeRadius() const { return tube_radius_; }
  double angle() const { return angle_; }

 private:
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;
  /// Of a ring, its near side and the one across the axis: a ball sits in it.
  std::vector<Piece> doPieces() const override;
  /// The point of the arc that lies most in the direction of (x, y).
  Eigen::Vector3d onArc(double x, double y) const;

  double radius_;
  double tube_radius_;
  double angle_;
  Eigen::Vector2d end_;                                            // unit, towards the end with y ≥ 0
};

}  // namespace tactus::geometry
