#pragma once

#include <Eigen/Core>
#include <optional>

/// What objects are made of: shapes as signed distances, for the plant, for estimators, for anybody who asks where a
/// surface is.
namespace tactus::geometry {

struct SignedDistance {
  double distance = 0;                                             ///< m, negative inside
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();             ///< unit, outward normal at the nearest surface point
};

/// A solid in a frame of its own, told by the signed distance to its surface: Euclidean outside and inside, so that
/// p − distance · gradient is the nearest point of the surface.  Where several are equally near (a box's inner
/// diagonal planes, a cylinder's axis), one of them is taken, always the same.
///
/// A class derived from it gives `doDistance`, which takes no memory, throws nothing and may be called from several
/// threads at once.
class Shape {
 public:
  virtual ~Shape() = default;

  /// From p, in the shape's frame (m).
  SignedDistance distance(const Eigen::Vector3d& p) const { return doDistance(p); }
  /// A point of the shape that lies farthest along the unit vector n; none where the shape has no end there.
  std::optional<Eigen::Vector3d> support(const Eigen::Vector3d& n) const { return doSupport(n); }

  /// Radius of a sphere about the shape's origin that holds all of it, m; infinite for one without end.
  double boundingRadius() const { return bounding_radius_; }
  /// Whether the segment between any two of its points lies inside: the distance is then a convex function of p.
  bool isConvex() const { return convex_; }
  /// How far a distance may be off, m; 0 = rounding alone.
  double error() const { return error_; }

 protected:
  /// Throws std::invalid_argument when the radius is not above, or the error below, 0.
  Shape(double bounding_radius, bool convex, double error = 0);

 private:
  virtual SignedDistance doDistance(const Eigen::Vector3d& p) const = 0;
  /// As it stands: what is nearest to a point far out along n, right to 1e-7 of the bounding radius.
  virtual std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const;

  double bounding_radius_;
  bool convex_;
  double error_;
};

}  // namespace tactus::geometry
