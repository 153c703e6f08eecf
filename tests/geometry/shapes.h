#pragma once

#include <Eigen/Core>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "framework/geometry/shape.h"
#include "framework/geometry/triangle_mesh.h"

/// Shapes of random measures, and points of their surfaces that are made without asking for a distance.
namespace tactus::geometry_test {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  double length() { return uniform(0.02, 0.2); }
  Eigen::Vector3d inCube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

 private:
  std::mt19937_64 engine_;
};

struct Specimen {
  std::string name;
  std::shared_ptr<const geometry::Shape> shape;
  std::vector<Eigen::Vector3d> surface;                            ///< at most `spacing` apart; none of a plane
  double spacing = 0;
  bool depth_is_exact = true;                                      ///< else a lower bound
};

/// One of every kind that is exact.
std::vector<Specimen> exactShapes(Random& random, double spacing);

/// A ball as a mesh: a cube's faces cut into n² squares of two triangles, moved out onto the sphere.
geometry::TriangleMesh ballMesh(double radius, int n);
geometry::TriangleMesh boxMesh(const Eigen::Vector3d& size);

}  // namespace tactus::geometry_test
