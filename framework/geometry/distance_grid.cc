#include "framework/geometry/distance_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

/// Hermite's cubics at t of [0, 1] and their slopes: value and derivative at 0, value and derivative at 1.
struct Cubics {
  explicit Cubics(double t) {
    const double s = 1 - t;
    value[0] = (1 + 2 * t) * s * s;
    value[1] = t * s * s;
    value[2] = t * t * (3 - 2 * t);
    value[3] = -t * t * s;
    slope[0] = -6 * t * s;
    slope[1] = s * (1 - 3 * t);
    slope[2] = 6 * t * s;
    slope[3] = t * (3 * t - 2);
  }
  double value[4], slope[4];
};

double smooth(double x) { return x * x * (3 - 2 * x); }

}  // namespace

DistanceGrid::DistanceGrid(const Vector3d& low, const Eigen::Array3i& nodes, double cell, const Distance& distance)
    : low_(low), nodes_(nodes), cell_(cell), values_(static_cast<std::size_t>(nodes[0]) * nodes[1] * nodes[2]) {
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  for (int k = 0; k < nodes[2]; ++k)
    for (int j = 0; j < nodes[1]; ++j) {
      Vector3d foot = Vector3d::Constant(anywhere);                // of the last node of the row
      for (int i = 0; i < nodes[0]; ++i) {
        const Vector3d p = low + cell * Vector3d(i, j, k);
        const SignedDistance here = distance(p, (p - foot).norm());
        foot = p - here.distance * here.gradient;
        const Vector3d slope = cell * here.gradient;
        values_[index(i, j, k)] = {static_cast<float>(here.distance), static_cast<float>(slope.x()),
                                   static_cast<float>(slope.y()),     static_cast<float>(slope.z()), 0, 0, 0, 0};
      }
    }
  mix();
}

/// Mixed derivatives: of the two ways round, the mean.
void DistanceGrid::mix() {
  const auto difference = [&](int i, int j, int k, int axis, float Node::* member) {
    int ahead[3] = {i, j, k}, behind[3] = {i, j, k};
    ahead[axis] = std::min(ahead[axis] + 1, nodes_[axis] - 1);
    behind[axis] = std::max(behind[axis] - 1, 0);
    const float above = values_[index(ahead[0], ahead[1], ahead[2])].*member;
    const float below = values_[index(behind[0], behind[1], behind[2])].*member;
    return (above - below) / static_cast<float>(ahead[axis] - behind[axis]);
  };
  for (int k = 0; k < nodes_[2]; ++k)
    for (int j = 0; j < nodes_[1]; ++j)
      for (int i = 0; i < nodes_[0]; ++i) {
        Node& node = values_[index(i, j, k)];
        node.xy = 0.5f * (difference(i, j, k, 1, &Node::x) + difference(i, j, k, 0, &Node::y));
        node.xz = 0.5f * (difference(i, j, k, 2, &Node::x) + difference(i, j, k, 0, &Node::z));
        node.yz = 0.5f * (difference(i, j, k, 2, &Node::y) + difference(i, j, k, 1, &Node::z));
      }
}

DistanceGrid::Sample DistanceGrid::at(const Vector3d& p) const {
  int first[3];
  double t[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double place = (p[axis] - low_[axis]) / cell_;
    first[axis] = std::clamp(static_cast<int>(place), 0, nodes_[axis] - 2);
    t[axis] = place - first[axis];
  }
  const Cubics X(t[0]), Y(t[1]), Z(t[2]);
  double f = 0, f_x = 0, f_y = 0, f_z = 0;
  for (int c = 0; c < 2; ++c) {
    const double z = Z.value[2 * c], zd = Z.value[2 * c + 1], slope_z = Z.slope[2 * c], slope_zd = Z.slope[2 * c + 1];
    for (int b = 0; b < 2; ++b) {
      const double y = Y.value[2 * b], yd = Y.value[2 * b + 1], slope_y = Y.slope[2 * b], slope_yd = Y.slope[2 * b + 1];
      const Node* node = &values_[index(first[0], first[1] + b, first[2] + c)];
      for (int a = 0; a < 2; ++a) {
        const Node& n = node[a];
        const double x = X.value[2 * a], xd = X.value[2 * a + 1];
        const double slope_x = X.slope[2 * a], slope_xd = X.slope[2 * a + 1];
        // Along x: the value and what multiplies the derivatives along y, z and both.
        const double v = x * n.f + xd * n.x, vy = x * n.y + xd * n.xy, vz = x * n.z + xd * n.xz, vyz = x * n.yz;
        const double along_y = y * v + yd * vy, along_y_z = y * vz + yd * vyz;
        f += z * along_y + zd * along_y_z;
        f_z += slope_z * along_y + slope_zd * along_y_z;
        f_y += z * (slope_y * v + slope_yd * vy) + zd * (slope_y * vz + slope_yd * vyz);
        f_x += z * (y * (slope_x * n.f + slope_xd * n.x) + yd * (slope_x * n.y + slope_xd * n.xy)) +
               zd * (y * (slope_x * n.z + slope_xd * n.xz) + yd * slope_x * n.yz);
      }
    }
  }
  return {f, Vector3d(f_x, f_y, f_z) / cell_};
}

DistanceGrid::Sample DistanceGrid::weight(const Vector3d& p) const {
  const Eigen::Array3d depth =                                     // cells from the nearer border
      ((p - low_).cwiseMin(high() - p) / cell_).array();
  if ((depth >= 1).all()) return {1, Vector3d::Zero()};
  if ((depth <= 0).any()) return {0, Vector3d::Zero()};
  const Vector3d middle = 0.5 * (low_ + high());
  Vector3d factor, slope;
  for (int axis = 0; axis < 3; ++axis) {
    const double x = std::min(depth[axis], 1.0), inwards = p[axis] < middle[axis] ? 1 : -1;
    factor[axis] = smooth(x);
    slope[axis] = inwards * 6 * x * (1 - x) / cell_;
  }
  return {factor.prod(), {slope.x() * factor.y() * factor.z(), factor.x() * slope.y() * factor.z(),
                          factor.x() * factor.y() * slope.z()}};
}

}  // namespace tactus::geometry
