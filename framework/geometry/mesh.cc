#include "framework/geometry/mesh.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace tactus::geometry {

using Eigen::Array3i;
using Eigen::Vector3d;

namespace {

constexpr double default_nodes = 300e3, most_nodes = 4e6;
constexpr int cells_around = 5;

using Grids = std::vector<DistanceGrid>;

struct Box {
  Vector3d low, high;
};

Box boxOf(const TriangleMesh& mesh) {
  Box box{mesh.vertices.front(), mesh.vertices.front()};
  for (const Vector3d& vertex : mesh.vertices) {
    box.low = box.low.cwiseMin(vertex);
    box.high = box.high.cwiseMax(vertex);
  }
  return box;
}

Eigen::Array3d cellsFor(const Vector3d& size, double cell, double around) {
  return (size.array() / cell + 2 * around).ceil();
}

double nodesFor(const Vector3d& size, double cell) { return (cellsFor(size, cell, cells_around) + 1).prod(); }

double finestCell(const Vector3d& size, double asked) {
  if (!(asked >= 0) || !std::isfinite(asked)) throw std::invalid_argument("the cell of a mesh is finite and ≥ 0");
  if (asked > 0 && nodesFor(size, asked) > most_nodes)
    throw std::invalid_argument("so small a cell asks for more than 4 million nodes");
  if (asked > 0) return std::min(asked, size.maxCoeff());
  double low = 1e-6 * size.maxCoeff(), high = size.maxCoeff();    // too many nodes, and few enough
  for (int i = 0; i < 60; ++i) (nodesFor(size, 0.5 * (low + high)) > default_nodes ? low : high) = 0.5 * (low + high);
  return high;
}

Grids gridsOver(const Box& box, double finest, const TriangleSearch& search) {
  const Vector3d size = box.high - box.low, middle = 0.5 * (box.low + box.high);
  const auto exact = [&](const Vector3d& p, double within) { return search.distance(p, within); };
  Grids grids;
  for (double cell = finest, around = cells_around;; cell *= 2) {
    const Eigen::Array3d cells = cellsFor(size, cell, around);
    grids.emplace_back(middle - 0.5 * cell * cells.matrix(), (cells + 1).cast<int>(), cell, exact);
    if (around * cell >= 0.5 * size.maxCoeff()) return grids;
  }
}

/// The grids' answer, of gradient not of unit length, or the exact one beyond them.
DistanceGrid::Sample sample(const Grids& grids, std::size_t finest, const TriangleSearch& search, const Vector3d& p) {
  for (std::size_t i = finest; i < grids.size(); ++i) {
    const DistanceGrid::Sample weight = grids[i].weight(p);
    if (weight.value == 0) continue;
    const DistanceGrid::Sample here = grids[i].at(p);
    if (weight.value == 1) return here;
    const DistanceGrid::Sample next = sample(grids, i + 1, search, p);
    return {next.value + weight.value * (here.value - next.value),
            next.gradient + weight.value * (here.gradient - next.gradient) +
                (here.value - next.value) * weight.gradient};
  }
  const SignedDistance exact = search.distance(p);
  return {exact.distance, exact.gradient};
}

}  // namespace

struct Mesh::Parts {
  Parts(const TriangleMesh& mesh, double cell) : triangles(mesh), search(mesh) {
    const Box box = boxOf(mesh);
    grids = gridsOver(box, finestCell(box.high - box.low, cell), search);
    measure();
    for (const Vector3d& vertex : mesh.vertices) radius = std::max(radius, vertex.norm());
  }

  void measure() {
    constexpr double slack = 1.5;                                  // for what lies between the points
    std::mt19937_64 random(1);
    const auto within = [&](double low, double high) {
      return low + (high - low) * 0x1p-64 * static_cast<double>(random());
    };
    const double finest = grids.front().cell();
    for (const DistanceGrid& grid : grids) {
      const Vector3d low = grid.low(), high = grid.high();
      const double cell = grid.cell();
      for (double z = low.z(); z < high.z() - 0.5 * cell; z += 2 * cell)
        for (double y = low.y(); y < high.y() - 0.5 * cell; y += 2 * cell) {
          Vector3d foot = Vector3d::Constant(std::numeric_limits<double>::infinity());
          for (double x = low.x(); x < high.x() - 0.5 * cell; x += cell) {
            const Vector3d p(within(x, x + cell), within(y, y + cell), within(z, z + cell));
            const SignedDistance exact = search.distance(p, (p - foot).norm());
            foot = p - exact.distance * exact.gradient;
            const double off = slack * std::abs(sample(grids, 0, search, p).value - exact.distance);
            errors.everywhere = std::max(errors.everywhere, off);
            if (std::abs(exact.distance) < finest) errors.surface = std::max(errors.surface, off);
          }
        }
    }
  }

  TriangleMesh triangles;
  TriangleSearch search;
  Grids grids;
  Errors errors;
  double radius = 0;
};

Mesh::Mesh(const TriangleMesh& triangles, double cell) : Mesh(Parts(triangles, cell)) {}

Mesh::Mesh(Parts parts)
    : Shape(parts.radius, false, parts.errors.everywhere),
      triangles_(std::move(parts.triangles)),
      search_(std::move(parts.search)),
      grids_(std::move(parts.grids)),
      errors_(parts.errors) {}

SignedDistance Mesh::doDistance(const Vector3d& p) const {
  const DistanceGrid::Sample here = sample(grids_, 0, search_, p);
  const double steepness = here.gradient.norm();
  if (steepness < 1e-9) return {here.value, Vector3d::UnitZ(), 0};  // the top of a rounded ridge
  return {here.value, here.gradient / steepness, steepness};
}

std::optional<Vector3d> Mesh::doSupport(const Vector3d& n) const {
  return *std::max_element(triangles_.vertices.begin(), triangles_.vertices.end(),
                           [&](const Vector3d& a, const Vector3d& b) { return a.dot(n) < b.dot(n); });
}

TriangleMesh Mesh::doSurface() const { return triangles_; }

}  // namespace tactus::geometry
