#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace tactus::geometry {

/// A convex set of the plane: a polygon, counter-clockwise, a segment or a point, by its corners.
class ConvexSet {
 public:
  explicit ConvexSet(std::vector<Eigen::Vector2d> corners) : corners_(std::move(corners)) {}
  const std::vector<Eigen::Vector2d>& corners() const { return corners_; }

  /// From the nearest point of the set to p, m; 0 where p lies in it.
  Eigen::Vector2d offset(const Eigen::Vector2d& p) const;

 private:
  std::vector<Eigen::Vector2d> corners_;
};

/// A polygon cut into convex ones along diagonals.
struct ConvexParts {
  struct Cut {
    ConvexSet diagonal;
    std::array<int, 2> between;                                    ///< indices of the two parts that share it
  };
  std::vector<ConvexSet> parts;
  std::vector<Cut> cuts;                                           ///< one fewer
};

/// Of the corners of an Outline: simple, counter-clockwise.  Each step takes the shortest diagonal that leaves no hollow
/// at the corner where it begins, or, where there is none such, the shortest.
ConvexParts convexParts(const std::vector<Eigen::Vector2d>& corners);

}  // namespace tactus::geometry
