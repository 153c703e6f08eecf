#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "framework/geometry/triangle_mesh.h"

/// What objects are made of: shapes as signed distances, for the plant, for estimators, for anybody who asks where a
/// surface is.
namespace tactus::geometry {

struct SignedDistance {
  double distance = 0;                                             ///< m, negative inside
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();             ///< unit, outward normal at the nearest surface point
  /// How fast the distance, as it is told, grows along it: 1 where it is exact, less where hollows are rounded.
  double steepness = 1;
};

/// A stretch of a shape's surface with which it feels for others: the points within `radius` of the segment from–to.
/// `from == to` is a sphere, radius 0 an edge or a corner.
struct Feeler {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();                  ///< m
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0;                                               ///< m
  bool ends = true;                                                ///< false: its ends are others' (edges of a box)
  double share = 1;                                                ///< of the stiffness, where several touch as one
};

struct Piece;

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

  /// With what it touches where it moves; none of a shape without end.
  std::vector<Feeler> feelers() const { return doFeelers(); }

  /// The pieces in which a ball touches it apart, in a hollow on each side; none: it is one piece.
  std::vector<Piece> pieces() const { return doPieces(); }

  /// Triangles that look outwards, for pictures: flat sides as they are, round ones in small steps; of a shape without
  /// end the part around its origin.
  TriangleMesh surface() const { return doSurface(); }

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

  /// As it stands: up to 120 points of the surface with an eighth of the stiffness each, of a convex shape those
  /// farthest in directions spread evenly over the sphere, of another those nearest to points around it.
  virtual std::vector<Feeler> doFeelers() const;
  virtual std::vector<Piece> doPieces() const;
  /// As it stands: by surfaceNets, which cuts edges off; of a shape without end, nothing.
  virtual TriangleMesh doSurface() const;

  double bounding_radius_;
  bool convex_;
  double error_;
};

/// A piece of a shape that is not convex, or what two of its pieces have in common.
///
/// Of a ball of radius r about p, let φ(d) be the energy of a spring that is bent by r − d.  The nearest point alone
/// gives φ(distance(p)), whose slope jumps where two sides of a hollow are equally near.  Instead
///
///     E(p) = Σ sign · φ(distance of the piece to p)
///
/// over the convex pieces (sign +1) and what neighbours have in common (sign −1).  Where two convex pieces make up a
/// convex one, their common border is as far as the farther of them, and E is φ of the nearer one, as if there were no
/// cut (distances of convex sets A, B with A ∪ B convex keep d(A ∪ B) = min, d(A ∩ B) = max); in a hollow both sides
/// count, and the common border only as far as the ball reaches into the corner itself.  Each distance to a convex set is
/// once differentiable outside, so E is, and −∇E is a force that is continuous and keeps energy.
///
/// Outside the piece its distance is the one to the piece; inside, that to the surface of the whole shape.
struct Piece {
  std::shared_ptr<const Shape> shape;                              ///< in the frame of the whole
  int sign = 1;
  std::array<int, 2> between = {-1, -1};                           ///< of what is in common: these two pieces
};

}  // namespace tactus::geometry
