#include "framework/geometry/triangle_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

bool before(const Vector3d& a, const Vector3d& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

std::string edges(std::size_t count) { return count == 1 ? "1 edge" : std::to_string(count) + " edges"; }

/// An edge from its lower to its higher vertex, and whether a triangle runs along it that way.
struct Side {
  std::uint64_t edge;
  bool forward;
};

std::vector<Side> sidesByEdge(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (const auto& triangle : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const auto a = static_cast<std::uint64_t>(triangle[i]), b = static_cast<std::uint64_t>(triangle[(i + 1) % 3]);
      sides.push_back({std::min(a, b) << 32 | std::max(a, b), a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.edge < b.edge; });
  return sides;
}

}  // namespace

double TriangleMesh::volume() const {
  double six = 0;
  for (const auto& [a, b, c] : triangles)
    six += (vertices[a] - vertices[0]).dot((vertices[b] - vertices[0]).cross(vertices[c] - vertices[0]));
  return six / 6;
}

TriangleMesh welded(const TriangleMesh& mesh) {
  std::vector<int> order(mesh.vertices.size()), merged(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int i, int j) { return before(mesh.vertices[i], mesh.vertices[j]); });
  TriangleMesh result;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Vector3d& vertex = mesh.vertices[order[k]];
    if (k == 0 || result.vertices.back() != vertex) result.vertices.push_back(vertex);
    merged[order[k]] = static_cast<int>(result.vertices.size()) - 1;
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::array<int, 3> triangle{merged[a], merged[b], merged[c]};
    if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
      result.triangles.push_back(triangle);
  }
  return result;
}

void requireClosed(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) throw std::invalid_argument("the mesh has no triangles");
  for (const Vector3d& vertex : mesh.vertices)
    if (!vertex.allFinite()) throw std::invalid_argument("the vertices of a mesh are finite");
  for (const auto& triangle : mesh.triangles)
    for (const int index : triangle)
      if (index < 0 || index >= static_cast<int>(mesh.vertices.size()))
        throw std::invalid_argument("a triangle of the mesh names a vertex that there is not");

  const std::vector<Side> sides = sidesByEdge(mesh);
  std::size_t open = 0, crowded = 0, turned = 0;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i;
    int balance = 0;
    for (; end < sides.size() && sides[end].edge == sides[i].edge; ++end) balance += sides[end].forward ? 1 : -1;
    if (end - i == 1) ++open;
    if (end - i > 2) ++crowded;
    if (end - i == 2 && balance != 0) ++turned;
    i = end;
  }
  if (open > 0)
    throw std::invalid_argument("the mesh is not closed: " + edges(open) + (open == 1 ? " has" : " have") +
                                " a triangle on one side only");
  if (crowded > 0)
    throw std::invalid_argument("the mesh does not bound a solid: more than two triangles meet at " + edges(crowded));
  if (turned > 0)
    throw std::invalid_argument("the triangles do not agree which side is outside: at " + edges(turned) +
                                " one of two neighbours is turned over");
  if (!(mesh.volume() > 0))
    throw std::invalid_argument("the triangles of the mesh look inwards: turn all of them over");
}

}  // namespace tactus::geometry
