#pragma once

#include <vector>

#include "framework/geometry/outline.h"
#include "framework/geometry/shape.h"

namespace tactus::geometry {

/// A prism over a simple polygon, convex or not, along z, its middle at z = 0.  Distances are exact; they take time in
/// proportion to the number of edges.
class Extrusion final : public Shape {
 public:
  /// Corners (x, y) of the outline, m, either way round; `length` is the full height, m.  Throws std::invalid_argument
  /// where Outline does, and for a length that is not finite and above 0.
  Extrusion(std::vector<Eigen::Vector2d> outline, double length);
  const Outline& outline() const { return outline_; }
  double length() const { return length_; }

 private:
  Extrusion(Outline outline, double length);
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;
  /// Prisms over the convex parts of its outline.
  std::vector<Piece> doPieces() const override;

  Outline outline_;
  double length_;
  Eigen::Vector2d middle_;                                         // of the outline: a point inside
};

}  // namespace tactus::geometry
