#pragma once

#include <vector>

#include "framework/geometry/distance_grid.h"
#include "framework/geometry/shape.h"
#include "framework/geometry/triangle_mesh.h"
#include "framework/geometry/triangle_search.h"

namespace tactus::geometry {

/// The solid that a closed mesh bounds.  Distances come from grids that are filled from the exact ones when it is made:
/// the finest holds the solid and five cells around it; each further one has cells twice as large, as many around the
/// one before, until they reach half the solid's length; beyond them the exact search answers.  Over the outermost cell
/// of each grid its answer passes smoothly into the next one's.
///
/// So the distance is once differentiable wherever it is asked of a grid, and its gradient is the given one up to its
/// length.  It is least right where the exact gradient jumps, along ridges of the distance inside the solid and in its
/// hollows; ridges are rounded over about a cell.  `error()` is measured: of random points in a quarter of the cells of
/// every grid the farthest off, and half of that more; so is `surfaceError()`, of points within a cell of the surface.
class Mesh final : public Shape {
 public:
  /// `cell`: edge length of the finest grid's cells, m; 0 = as fine as 300 000 nodes allow.  Throws
  /// std::invalid_argument where requireClosed does, and for a cell below 0 or so small that it asks for more than
  /// 4 million nodes.
  explicit Mesh(const TriangleMesh& triangles, double cell = 0);

  double cell() const { return grids_.front().cell(); }
  double surfaceError() const { return errors_.surface; }
  /// What the grids were filled from; slower.
  SignedDistance exactDistance(const Eigen::Vector3d& p) const { return search_.distance(p); }

 private:
  struct Errors {
    double everywhere = 0;
    double surface = 0;
  };
  struct Parts;
  explicit Mesh(Parts parts);
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;

  TriangleMesh triangles_;
  TriangleSearch search_;
  std::vector<DistanceGrid> grids_;                                // from the finest
  Errors errors_;
};

}  // namespace tactus::geometry
