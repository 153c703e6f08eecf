#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

namespace tactus::geometry {

/// Triangles as indices of vertices (m), counter-clockwise when looked at from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;

  /// m³; negative when the triangles look inwards.
  double volume() const;
};

/// One vertex for all of the same place; triangles that have a vertex twice are dropped.  For files that repeat a
/// vertex in each of its triangles.
TriangleMesh welded(const TriangleMesh& mesh);

/// Throws std::invalid_argument, with a sentence that counts what is wrong, unless the mesh bounds a solid: vertices
/// finite, indices within, every edge shared by two triangles that run along it in opposite ways, the volume above 0.
void requireClosed(const TriangleMesh& mesh);

}  // namespace tactus::geometry
