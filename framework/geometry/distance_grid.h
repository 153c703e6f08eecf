#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

#include "framework/geometry/shape.h"

namespace tactus::geometry {

/// A distance on a grid of cubes, tricubic between the nodes: distance and gradient are right at the nodes, continuous
/// everywhere, and the gradient is that of the distance as it is given.
///
/// Hermite's form: each node holds f, its derivatives and its mixed second derivatives by differences of neighbours'
/// gradients (f_xyz, whose share is at most 1/512 of it, is left out).  Numbers are kept as float, 1e-7 of the
/// distance.
class DistanceGrid {
 public:
  using Distance = std::function<SignedDistance(const Eigen::Vector3d& p, double within)>;

  /// Nodes at low + cell · (i, j, k), 0 ≤ (i, j, k) < nodes, at least 2 each.  `distance` is asked from node to
  /// neighbour, each time with a length within which there is some of the surface.
  DistanceGrid(const Eigen::Vector3d& low, const Eigen::Array3i& nodes, double cell, const Distance& distance);

  double cell() const { return cell_; }
  const Eigen::Vector3d& low() const { return low_; }
  Eigen::Vector3d high() const { return low_ + cell_ * (nodes_ - 1).cast<double>().matrix(); }

  /// The value and its gradient, which is not of unit length, at p within the grid.
  struct Sample {
    double value;
    Eigen::Vector3d gradient;
  };
  Sample at(const Eigen::Vector3d& p) const;

  /// How far p is within: 1 a cell or more from the grid's border, 0 on it and outside, smooth between.
  Sample weight(const Eigen::Vector3d& p) const;

 private:
  struct Node {
    float f, x, y, z, xy, xz, yz, unused;                          // each times cell, once a derivative
  };
  int index(int i, int j, int k) const { return i + nodes_[0] * (j + nodes_[1] * k); }
  void mix();

  Eigen::Vector3d low_;
  Eigen::Array3i nodes_;
  double cell_;
  std::vector<Node> values_;
};

}  // namespace tactus::geometry
