#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/description/robot.h"

namespace tactus::plugins {

/// A place on a link's surface, link axes.
struct SurfacePoint {
  Eigen::Vector3d position_L = Eigen::Vector3d::Zero();            ///< m
  Eigen::Vector3d normal_L = Eigen::Vector3d::UnitZ();             ///< unit, out of the link
};

/// A piece of it.
struct SurfaceCell : SurfacePoint {
  double area = 0;                                                 ///< m²
  int shape = 0;                                                   ///< index into the link's shapes
  int piece = 0;                                                   ///< of the pieces before they are cut further
};

/// The surface of a link: of the union of its shapes.
///
/// `cells` cuts it into pieces of about `pitch` by `pitch`, always the same ones, their areas exact:
/// - a capsule, of radius r and length l, into rings across its axis, which follow each other from pole to pole at
///   (l + πr)/n, n = round((l + πr)/pitch), and each ring of radius ρ into round(2πρ/pitch) equal pieces, at least one;
///   a ring's area is 2πr times its height along the axis (Archimedes);
/// - a box into equal rectangles on each face.
/// With `cuts` each piece is cut further into cuts by cuts cells.  Cells whose middle lies inside another shape of the
/// link are left out.
class Surface {
 public:
  explicit Surface(const description::Link& link) : shapes_(link.shapes) {}

  bool empty() const { return shapes_.empty(); }
  const std::vector<description::LinkShape>& shapes() const { return shapes_; }
  /// The place of the surface that is nearest to a point, of the shape whose surface is nearest to it.
  SurfacePoint nearest(const Eigen::Vector3d& point_L) const;
  std::vector<SurfaceCell> cells(double pitch, int cuts = 1) const;
  /// m, how round it is there: the capsule's radius, a quarter of a box's shortest edge.
  double radiusNear(const Eigen::Vector3d& point_L) const;

 private:
  int shapeNear(const Eigen::Vector3d& point_L) const;

  std::vector<description::LinkShape> shapes_;
};

/// Columns x, y, z of a capsule: z from `from` to `to`, the link's z for a sphere; x, y as description::planeFrame.
Eigen::Matrix3d capsuleAxes(const description::CapsuleShape& capsule);

}  // namespace tactus::plugins
