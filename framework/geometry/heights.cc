#include "framework/geometry/heights.h"

#include <cmath>

#include "framework/geometry/lengths.h"

namespace tactus::geometry {

using Eigen::Vector3d;

TriangleMesh heightMesh(const Eigen::MatrixXd& heights, const Eigen::Vector2d& spacing, double base) {
  const int rows = static_cast<int>(heights.rows()), columns = static_cast<int>(heights.cols());
  if (rows < 2 || columns < 2) throw std::invalid_argument("a field of heights has two rows and two columns or more");
  for (const double step : spacing) positive("the spacing of heights", step);
  if (!heights.allFinite() || !std::isfinite(base)) throw std::invalid_argument("heights are finite");
  if (!(heights.minCoeff() > base)) throw std::invalid_argument("every height lies above the base");

  TriangleMesh mesh;
  const auto top = [&](int i, int j) { return i * columns + j; };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      mesh.vertices.emplace_back((j - 0.5 * (columns - 1)) * spacing.x(), (i - 0.5 * (rows - 1)) * spacing.y(),
                                 heights(i, j));
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j + 1 < columns; ++j) {
      mesh.triangles.push_back({top(i, j), top(i, j + 1), top(i + 1, j + 1)});
      mesh.triangles.push_back({top(i, j), top(i + 1, j + 1), top(i + 1, j)});
    }

  std::vector<int> border;                                         // counter-clockwise from above
  for (int j = 0; j + 1 < columns; ++j) border.push_back(top(0, j));
  for (int i = 0; i + 1 < rows; ++i) border.push_back(top(i, columns - 1));
  for (int j = columns - 1; j > 0; --j) border.push_back(top(rows - 1, j));
  for (int i = rows - 1; i > 0; --i) border.push_back(top(i, 0));
  const int below = static_cast<int>(mesh.vertices.size()), n = static_cast<int>(border.size());
  for (const int vertex : border) {
    const Vector3d foot(mesh.vertices[vertex].x(), mesh.vertices[vertex].y(), base);
    mesh.vertices.push_back(foot);
  }
  const int middle = below + n;
  mesh.vertices.emplace_back(0, 0, base);
  for (int k = 0; k < n; ++k) {
    const int next = (k + 1) % n;
    mesh.triangles.push_back({border[k], below + k, below + next});
    mesh.triangles.push_back({border[k], below + next, border[next]});
    mesh.triangles.push_back({middle, below + next, below + k});
  }
  return mesh;
}

}  // namespace tactus::geometry
