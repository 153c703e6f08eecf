#pragma once

#include <limits>
#include <vector>

#include "framework/geometry/shape.h"
#include "framework/geometry/triangle_mesh.h"

namespace tactus::geometry {

/// The exact signed distance to a closed mesh: the nearest triangle by a tree of boxes, the sign by angle-weighted
/// pseudonormals (J. A. Baerentzen, H. Aanaes, *Signed distance computation using the angle weighted pseudonormal*,
/// 2005).  A µs or some a query; ties go to the same triangle always.
class TriangleSearch {
 public:
  /// Throws what `requireClosed` throws.
  explicit TriangleSearch(const TriangleMesh& mesh);

  /// `within`: a distance (m) in which the caller knows that there is some of the surface; spares time, changes
  /// nothing.
  SignedDistance distance(const Eigen::Vector3d& p, double within = std::numeric_limits<double>::infinity()) const;

 private:
  struct Triangle {
    Eigen::Vector3d a, ab, ac;
    Eigen::Vector3d normal;                                        // unit; 0 of one without area
    int vertex[3];
    int edge[3];                                                   // ab, bc, ca
  };
  /// Turned as its triangles lie: patches of a surface are flat.
  struct Box {
    Eigen::Matrix3d axes;                                          // rows
    Eigen::Vector3d middle, half_size;                             // the middle along the axes
    int first = 0;                                                 // of a leaf's triangles; of a node, its second child
    int count = 0;                                                 // 0 = node, whose first child follows it

    double squaredDistance(const Eigen::Vector3d& p) const;
  };
  struct Nearest;
  static Box boxOf(const TriangleMesh& mesh, const std::vector<int>& order, int begin, int end);
  void build(const TriangleMesh& mesh, std::vector<int>& order, const std::vector<Eigen::Vector3d>& middles, int begin,
             int end);
  void look(const Triangle& triangle, const Eigen::Vector3d& p, Nearest& nearest) const;

  std::vector<Triangle> triangles_;                                // in the order of the leaves
  std::vector<Box> boxes_;
  std::vector<Eigen::Vector3d> edge_normals_;                      // not of unit length
  std::vector<Eigen::Vector3d> vertex_normals_;
};

}  // namespace tactus::geometry
