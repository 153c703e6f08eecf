#pragma once

#include <Eigen/Core>
#include <vector>

namespace tactus::geometry {

struct PlanarDistance {
  double distance = 0;                                             ///< m, negative inside
  Eigen::Vector2d gradient = Eigen::Vector2d::UnitY();             ///< unit, outward normal at the nearest border point
};

/// The border of a region of the plane: a simple polygon, convex or not.  Distances are exact and take time in
/// proportion to the number of edges; where several border points are equally near, the one on the earliest edge is
/// taken.
///
/// Which side a point is on is told by the edge that it is nearest to, or, where that is a corner, by the sum of the
/// normals of both edges, which no point outside looks at from behind (Baerentzen & Aanaes 2005, in the plane).
class Outline {
 public:
  /// Corners one after another, either way round, the last joined to the first.  Throws std::invalid_argument unless
  /// they are three or more, finite, and the edges meet in the corners only.
  explicit Outline(std::vector<Eigen::Vector2d> corners);

  /// The right half, x ≥ 0, of a region that is symmetric about x = 0: edges on that axis are no border.  Throws
  /// std::invalid_argument also for a corner left of the axis.
  static Outline rightHalf(std::vector<Eigen::Vector2d> corners);

  PlanarDistance distance(const Eigen::Vector2d& p) const;

  /// Counter-clockwise.
  const std::vector<Eigen::Vector2d>& corners() const { return corners_; }
  /// Of the region; for a right half, of the whole.
  bool isConvex() const;
  /// m, of the corners.
  Eigen::Vector2d centroid() const;

 private:
  struct Edge {
    Eigen::Vector2d start, end;
    Eigen::Vector2d direction;                                     // unit
    Eigen::Vector2d normal;                                        // unit, outward
    Eigen::Vector2d start_normal, end_normal;                      // unit, of the corners
    double length;
  };
  Outline(std::vector<Eigen::Vector2d> corners, bool right_half);

  std::vector<Eigen::Vector2d> corners_;
  std::vector<Edge> edges_;
  bool right_half_;
};

}  // namespace tactus::geometry
