#include "framework/geometry/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace tactus::geometry {

using Eigen::Vector2d;
using Eigen::Vector3d;

TriangleMesh lathe(const std::vector<Vector2d>& profile) {
  const int count = static_cast<int>(profile.size());
  TriangleMesh mesh;
  for (int step = 0; step < steps_a_turn; ++step) {
    const double turn = 2 * std::numbers::pi * step / steps_a_turn;
    for (const Vector2d& point : profile) {
      const bool on_axis = std::abs(point.x()) < 1e-12;
      mesh.vertices.emplace_back(on_axis ? 0 : point.x() * std::cos(turn), on_axis ? 0 : point.x() * std::sin(turn),
                                 point.y());
    }
  }
  for (int step = 0; step < steps_a_turn; ++step) {
    const int here = step * count, next = (step + 1) % steps_a_turn * count;
    for (int i = 0; i < count; ++i) {
      const int j = (i + 1) % count;
      mesh.triangles.push_back({here + i, next + i, next + j});
      mesh.triangles.push_back({here + i, next + j, here + j});
    }
  }
  return welded(mesh);
}

std::vector<Vector2d> arc(const Vector2d& centre, double radius, double from, double to) {
  const int steps =
      std::max(1, static_cast<int>(std::ceil(std::abs(to - from) / (2 * std::numbers::pi) * steps_a_turn - 1e-9)));
  std::vector<Vector2d> points;
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    points.push_back(centre + radius * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

namespace {

/// The distances at the corners of cubes that hold the shape with a cell to spare.
struct Samples {
  Vector3d low;
  Eigen::Array3i nodes;
  double cell;
  std::vector<double> distance;

  int index(int i, int j, int k) const { return i + nodes[0] * (j + nodes[1] * k); }
  Vector3d at(int i, int j, int k) const { return low + cell * Vector3d(i, j, k); }
};

Samples sampled(const Shape& shape, int cells) {
  Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    high[axis] = (*shape.support(Vector3d::Unit(axis)))[axis];
    low[axis] = (*shape.support(-Vector3d::Unit(axis)))[axis];
  }
  Samples samples;
  samples.cell = (high - low).maxCoeff() / (cells - 0.5);              // no node on the outermost faces
  samples.nodes = ((high - low).array() / samples.cell).ceil().cast<int>() + 3;
  samples.low = 0.5 * (low + high) - 0.5 * samples.cell * (samples.nodes - 1).cast<double>().matrix();
  for (int k = 0; k < samples.nodes[2]; ++k)
    for (int j = 0; j < samples.nodes[1]; ++j)
      for (int i = 0; i < samples.nodes[0]; ++i)
        samples.distance.push_back(shape.distance(samples.at(i, j, k)).distance);
  return samples;
}

/// The middle of where the surface crosses the cell's edges, moved onto the surface.
Vector3d vertexIn(const Shape& shape, const Samples& samples, const Eigen::Array3i& cell) {
  Vector3d sum = Vector3d::Zero();
  int crossings = 0;
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      const Eigen::Array3i from = cell + Eigen::Array3i(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
      Eigen::Array3i to = from;
      ++to[axis];
      const double a = samples.distance[samples.index(from[0], from[1], from[2])];
      const double b = samples.distance[samples.index(to[0], to[1], to[2])];
      if ((a < 0) == (b < 0)) continue;
      sum += samples.at(from[0], from[1], from[2]) + samples.cell * a / (a - b) * Vector3d::Unit(axis);
      ++crossings;
    }
  Vector3d p = sum / crossings;
  for (int i = 0; i < 2; ++i) {
    const SignedDistance nearest = shape.distance(p);
    if (std::abs(nearest.distance) < samples.cell) p -= nearest.distance * nearest.gradient;
  }
  return p;
}

}  // namespace

TriangleMesh surfaceNets(const Shape& shape, int cells) {
  const Samples samples = sampled(shape, cells);
  const Eigen::Array3i& nodes = samples.nodes;
  TriangleMesh mesh;
  std::vector<int> vertex(samples.distance.size(), -1);            // of the cell whose lowest corner it is
  const auto vertexOf = [&](const Eigen::Array3i& cell) {
    int& index = vertex[samples.index(cell[0], cell[1], cell[2])];
    if (index < 0) {
      index = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(vertexIn(shape, samples, cell));
    }
    return index;
  };
  // An edge between a corner inside and one outside is crossed by the quadrangle of the four cells around it.
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    Eigen::Array3i at;
    for (at[axis] = 0; at[axis] < nodes[axis] - 1; ++at[axis])
      for (at[u] = 1; at[u] < nodes[u] - 1; ++at[u])
        for (at[v] = 1; at[v] < nodes[v] - 1; ++at[v]) {
          Eigen::Array3i end = at;
          ++end[axis];
          const bool inside = samples.distance[samples.index(at[0], at[1], at[2])] < 0;
          if (inside == (samples.distance[samples.index(end[0], end[1], end[2])] < 0)) continue;
          std::array<int, 4> corners;                              // counter-clockwise when looked at from the end
          constexpr int around[4][2] = {{-1, -1}, {0, -1}, {0, 0}, {-1, 0}};
          for (int i = 0; i < 4; ++i) {
            Eigen::Array3i cell = at;
            cell[u] += around[i][0];
            cell[v] += around[i][1];
            corners[i] = vertexOf(cell);
          }
          if (!inside) std::reverse(corners.begin(), corners.end());
          mesh.triangles.push_back({corners[0], corners[1], corners[2]});
          mesh.triangles.push_back({corners[0], corners[2], corners[3]});
        }
  }
  return mesh;
}

TriangleMesh surfaceOf(const std::vector<PosedShape>& parts) {
  TriangleMesh whole;
  for (const PosedShape& part : parts) {
    const TriangleMesh mesh = part.shape->surface();
    const int first = static_cast<int>(whole.vertices.size());
    for (const Vector3d& vertex : mesh.vertices) whole.vertices.push_back(part.pose * vertex);
    for (const auto& [a, b, c] : mesh.triangles) whole.triangles.push_back({first + a, first + b, first + c});
  }
  return whole;
}

}  // namespace tactus::geometry
