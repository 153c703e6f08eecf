#pragma once

#include <vector>

#include "framework/geometry/outline.h"
#include "framework/geometry/shape.h"

namespace tactus::geometry {

/// What a closed profile sweeps in a whole turn about z: cups, bowls, bottles.  Distances are exact, inside the wall
/// too; they take time in proportion to the number of the profile's edges.
class Revolution final : public Shape {
 public:
  /// Corners (ρ, z) of the profile, ρ ≥ 0 (m), either way round.  It may touch the axis; edges on it are no surface.
  /// Throws std::invalid_argument where Outline does.
  explicit Revolution(std::vector<Eigen::Vector2d> profile);
  const Outline& profile() const { return profile_; }

 private:
  explicit Revolution(Outline profile);
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;
  /// What the convex parts of its profile sweep.  One that is not convex as a solid (a ring, a funnel) is told twice, by
  /// its near side and by the one across the axis, so that a ball sits on the mouth of a cup.
  std::vector<Piece> doPieces() const override;

  Outline profile_;
};

}  // namespace tactus::geometry
