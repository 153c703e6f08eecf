#include "framework/geometry/triangle_search.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace tactus::geometry {

using Eigen::Vector3d;

namespace {

constexpr int leaf_size = 4;

double angleBetween(const Vector3d& u, const Vector3d& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); }

}  // namespace

/// The nearest point so far, and whether it lies in a face, on an edge or is a vertex.
struct TriangleSearch::Nearest {
  double squared;
  Vector3d point = Vector3d::Zero();
  Vector3d normal = Vector3d::UnitZ();                             // pseudonormal
  bool in_face = false;
};

TriangleSearch::TriangleSearch(const TriangleMesh& mesh) {
  requireClosed(mesh);
  const int n = static_cast<int>(mesh.triangles.size());
  std::vector<Vector3d> middles(n);
  for (int i = 0; i < n; ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    middles[i] = (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
  }
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  boxes_.reserve(4 * n / leaf_size + 2);
  build(mesh, order, middles, 0, n);

  vertex_normals_.assign(mesh.vertices.size(), Vector3d::Zero());
  std::vector<std::pair<std::uint64_t, int>> sides;                // (edge, 3 · triangle + side)
  for (int k = 0; k < n; ++k) {
    const auto& corner = mesh.triangles[order[k]];
    const Vector3d &a = mesh.vertices[corner[0]], &b = mesh.vertices[corner[1]], &c = mesh.vertices[corner[2]];
    const Vector3d across = (b - a).cross(c - a);
    const double twice_area = across.norm();
    const bool flat = twice_area <= 1e-14 * std::max((b - a).squaredNorm(), (c - a).squaredNorm());
    const Vector3d normal = flat ? Vector3d::Zero() : Vector3d(across / twice_area);
    triangles_.push_back({a, b - a, c - a, normal, {corner[0], corner[1], corner[2]}, {}});
    vertex_normals_[corner[0]] += angleBetween(b - a, c - a) * normal;
    vertex_normals_[corner[1]] += angleBetween(c - b, a - b) * normal;
    vertex_normals_[corner[2]] += angleBetween(a - c, b - c) * normal;
    for (int i = 0; i < 3; ++i) {
      const auto u = static_cast<std::uint64_t>(corner[i]), v = static_cast<std::uint64_t>(corner[(i + 1) % 3]);
      sides.push_back({std::min(u, v) << 32 | std::max(u, v), 3 * k + i});
    }
  }
  std::sort(sides.begin(), sides.end());
  for (std::size_t i = 0; i < sides.size(); i += 2) {              // closed: each edge is there twice
    const int one = sides[i].second, other = sides[i + 1].second;
    triangles_[one / 3].edge[one % 3] = triangles_[other / 3].edge[other % 3] = static_cast<int>(edge_normals_.size());
    edge_normals_.push_back(triangles_[one / 3].normal + triangles_[other / 3].normal);
  }
}

double TriangleSearch::Box::squaredDistance(const Vector3d& p) const {
  return ((axes * p - middle).cwiseAbs() - half_size).cwiseMax(0).squaredNorm();
}

/// Along the principal axes of the corners.
TriangleSearch::Box TriangleSearch::boxOf(const TriangleMesh& mesh, const std::vector<int>& order, int begin, int end) {
  const auto forCorners = [&](auto use) {
    for (int i = begin; i < end; ++i)
      for (const int vertex : mesh.triangles[order[i]]) use(mesh.vertices[vertex]);
  };
  Vector3d mean = Vector3d::Zero();
  forCorners([&](const Vector3d& corner) { mean += corner / (3.0 * (end - begin)); });
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  forCorners([&](const Vector3d& corner) { spread += (corner - mean) * (corner - mean).transpose(); });
  Box box;
  box.axes = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().transpose();
  Vector3d low = box.axes * mean, high = low;
  forCorners([&](const Vector3d& corner) {
    low = low.cwiseMin(box.axes * corner);
    high = high.cwiseMax(box.axes * corner);
  });
  box.middle = 0.5 * (low + high);
  const double rounding = 1e-14 * low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
  box.half_size = 0.5 * (high - low) + rounding * Vector3d::Ones();
  box.first = begin;
  box.count = end - begin;
  return box;
}

void TriangleSearch::build(const TriangleMesh& mesh, std::vector<int>& order, const std::vector<Vector3d>& middles,
                           int begin, int end) {
  const auto at = static_cast<int>(boxes_.size());
  boxes_.push_back(boxOf(mesh, order, begin, end));
  if (end - begin <= leaf_size) return;
  Vector3d lowest = middles[order[begin]], highest = lowest;
  for (int i = begin; i < end; ++i) {
    lowest = lowest.cwiseMin(middles[order[i]]);
    highest = highest.cwiseMax(middles[order[i]]);
  }
  int axis = 0;
  (highest - lowest).maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int i, int j) {
    return middles[i][axis] != middles[j][axis] ? middles[i][axis] < middles[j][axis] : i < j;
  });
  boxes_[at].count = 0;
  build(mesh, order, middles, begin, middle);
  boxes_[at].first = static_cast<int>(boxes_.size());
  build(mesh, order, middles, middle, end);
}

/// C. Ericson, *Real-Time Collision Detection* (2005), 5.1.5: regions of a triangle.
void TriangleSearch::look(const Triangle& triangle, const Vector3d& p, Nearest& nearest) const {
  const auto take = [&](const Vector3d& point, const Vector3d& normal, bool in_face) {
    const double squared = (p - point).squaredNorm();
    if (squared < nearest.squared) nearest = {squared, point, normal, in_face};
  };
  const Vector3d &a = triangle.a, &ab = triangle.ab, &ac = triangle.ac;
  const Vector3d ap = p - a;
  if (triangle.normal.isZero()) return;                            // its neighbours hold all of its points
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return take(a, vertex_normals_[triangle.vertex[0]], false);
  const Vector3d bp = ap - ab;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return take(a + ab, vertex_normals_[triangle.vertex[1]], false);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return take(a + d1 / (d1 - d3) * ab, edge_normals_[triangle.edge[0]], false);
  const Vector3d cp = ap - ac;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return take(a + ac, vertex_normals_[triangle.vertex[2]], false);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return take(a + d2 / (d2 - d6) * ac, edge_normals_[triangle.edge[2]], false);
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6)
    return take(a + ab + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (ac - ab), edge_normals_[triangle.edge[1]], false);
  take(p - ap.dot(triangle.normal) * triangle.normal, triangle.normal, true);
}

SignedDistance TriangleSearch::distance(const Vector3d& p, double within) const {
  // A little more than the bound, that its own surface point is found.
  Nearest nearest{within * within * (1 + 1e-9) + 1e-30};
  struct Waiting {
    int box;
    double squared;
  } stack[64];
  int waiting = 0;
  stack[waiting++] = {0, boxes_[0].squaredDistance(p)};
  while (waiting > 0) {
    const Waiting next = stack[--waiting];
    if (next.squared >= nearest.squared) continue;
    const Box& box = boxes_[next.box];
    if (box.count > 0) {
      for (int i = box.first; i < box.first + box.count; ++i) look(triangles_[i], p, nearest);
      continue;
    }
    Waiting one{next.box + 1, 0}, other{box.first, 0};
    one.squared = boxes_[one.box].squaredDistance(p);
    other.squared = boxes_[other.box].squaredDistance(p);
    if (one.squared < other.squared) std::swap(one, other);        // the nearer is looked at first
    if (one.squared < nearest.squared) stack[waiting++] = one;
    if (other.squared < nearest.squared) stack[waiting++] = other;
  }
  const Vector3d offset = p - nearest.point;
  const double sign = offset.dot(nearest.normal) < 0 ? -1 : 1;
  const double length = std::sqrt(nearest.squared);
  if (nearest.in_face) return {sign * length, nearest.normal};
  // So near to an edge the offset is rounding, and says nothing of the direction.
  if (length <= 1e-10 * boxes_[0].half_size.maxCoeff()) return {sign * length, nearest.normal.normalized()};
  return {sign * length, sign / length * offset};
}

}  // namespace tactus::geometry
