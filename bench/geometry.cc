// Distances: ns a query of each shape, at random points up to a tenth of its size off its surface, as contacts ask;
// what meshes are off by, as they measure it; and poses/s of twelve capsules' axes against an object of six primitives, three points an axis.
// docs/benchmarks.md says how to read it.

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <random>

#include "framework/geometry/compound.h"
#include "framework/geometry/cone.h"
#include "framework/geometry/ellipsoid.h"
#include "framework/geometry/extrusion.h"
#include "framework/geometry/heights.h"
#include "framework/geometry/mesh.h"
#include "framework/geometry/primitives.h"
#include "framework/geometry/revolution.h"
#include "framework/geometry/torus.h"
#include "tests/geometry/shapes.h"

namespace {

using namespace tactus::geometry;
using Eigen::Vector2d;
using Eigen::Vector3d;
using tactus::geometry_test::Random;
using ShapePointer = std::shared_ptr<const Shape>;

constexpr double pi = std::numbers::pi;

std::vector<Vector2d> ngon(int corners) {
  std::vector<Vector2d> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * pi * i / corners, reach = 0.1 * (i % 2 ? 0.8 : 1);
    outline.emplace_back(reach * std::cos(angle), reach * std::sin(angle));
  }
  return outline;
}

TriangleMesh hills() {
  Eigen::MatrixXd heights(64, 64);
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) heights(i, j) = 0.03 + 0.01 * std::sin(0.3 * i) * std::cos(0.2 * j);
  return heightMesh(heights, {0.005, 0.005}, 0);
}

/// A pot with a foot, a lid and a handle.
ShapePointer sixPrimitives() {
  std::vector<PosedShape> parts;
  const auto put = [&](ShapePointer shape, const Vector3d& at) {
    PosedShape part{std::move(shape)};
    part.pose.translation() = at;
    parts.push_back(part);
  };
  put(std::make_shared<Cylinder>(0.04, 0.1), {0, 0, 0});
  put(std::make_shared<Box>(Vector3d(0.1, 0.1, 0.01)), {0, 0, -0.05});
  put(std::make_shared<Sphere>(0.035), {0, 0, 0.06});
  put(std::make_shared<Capsule>(0.008, 0.06), {0.06, 0, 0});
  put(std::make_shared<Box>(Vector3d(0.03, 0.015, 0.015)), {0.05, 0, 0.03});
  put(std::make_shared<Box>(Vector3d(0.03, 0.015, 0.015)), {0.05, 0, -0.03});
  return std::make_shared<Compound>(parts);
}

std::map<std::string, std::function<ShapePointer()>> makers() {
  return {{"plane", [] { return std::make_shared<Plane>(); }},
          {"box", [] { return std::make_shared<Box>(Vector3d(0.1, 0.2, 0.05)); }},
          {"sphere", [] { return std::make_shared<Sphere>(0.1); }},
          {"cylinder", [] { return std::make_shared<Cylinder>(0.05, 0.2); }},
          {"capsule", [] { return std::make_shared<Capsule>(0.05, 0.2); }},
          {"cone", [] { return std::make_shared<Cone>(0.1, 0.05, 0.2); }},
          {"ellipsoid", [] { return std::make_shared<Ellipsoid>(Vector3d(0.1, 0.06, 0.03)); }},
          {"torus", [] { return std::make_shared<Torus>(0.1, 0.02, 2 * pi); }},
          {"torus, a third of a turn", [] { return std::make_shared<Torus>(0.1, 0.02, 2.1); }},
          {"extrusion of 8 corners", [] { return std::make_shared<Extrusion>(ngon(8), 0.1); }},
          {"extrusion of 100 corners", [] { return std::make_shared<Extrusion>(ngon(100), 0.1); }},
          {"revolution of 6 corners",
           [] {
             return std::make_shared<Revolution>(
                 std::vector<Vector2d>{{0, 0}, {0.05, 0}, {0.05, 0.1}, {0.046, 0.1}, {0.046, 0.006}, {0, 0.006}});
           }},
          {"heights, 64 x 64", [] { return std::make_shared<Mesh>(hills()); }},
          {"mesh, a box", [] { return std::make_shared<Mesh>(tactus::geometry_test::boxMesh({0.05, 0.12, 0.08})); }},
          {"mesh, 49152 triangles", [] { return std::make_shared<Mesh>(tactus::geometry_test::ballMesh(0.1, 64)); }},
          {"union of six primitives", [] { return sixPrimitives(); }}};
}

std::vector<Vector3d> pointsNear(const Shape& shape, double off) {
  Random random(1);
  const double size = std::isfinite(shape.boundingRadius()) ? shape.boundingRadius() : 0.1;
  std::vector<Vector3d> points;
  while (points.size() < 4096) {
    const Vector3d p = random.inCube(1.2 * size);
    const SignedDistance nearest = shape.distance(p);
    points.push_back(p + (random.uniform(-off, off) * size - nearest.distance) * nearest.gradient);
  }
  return points;
}

template <class Distance>
void query(benchmark::State& state, const std::vector<Vector3d>& points, Distance distance) {
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(distance(points[i]));
    i = (i + 1) % points.size();
  }
}

/// Each of twelve capsules about the object, in 256 poses.
void poses(benchmark::State& state, const Shape& shape) {
  Random random(2);
  std::vector<std::array<Vector3d, 2>> axes;
  for (int i = 0; i < 12 * 256; ++i) {
    const Vector3d from = random.inCube(0.12);
    axes.push_back({from, from + 0.04 * random.inCube(1).normalized()});
  }
  std::size_t first = 0;
  for (auto _ : state) {
    double least = 1;
    for (std::size_t i = first; i < first + 12; ++i)
      for (const double t : {0.0, 0.5, 1.0})
        least = std::min(least, shape.distance(axes[i][0] + t * (axes[i][1] - axes[i][0])).distance);
    benchmark::DoNotOptimize(least);
    first = (first + 12) % axes.size();
  }
  state.SetItemsProcessed(state.iterations());
}

}  // namespace

int main(int argc, char** argv) {
  for (const auto& [name, make] : makers()) {
    const ShapePointer shape = make();
    benchmark::RegisterBenchmark(("distance/" + name).c_str(), [shape](benchmark::State& state) {
      query(state, pointsNear(*shape, 0.1), [&](const Vector3d& p) { return shape->distance(p); });
    });
    if (const auto mesh = std::dynamic_pointer_cast<const Mesh>(shape)) {
      benchmark::RegisterBenchmark(("exact search/" + name).c_str(), [mesh](benchmark::State& state) {
        query(state, pointsNear(*mesh, 0.1), [&](const Vector3d& p) { return mesh->exactDistance(p); });
      });
      benchmark::RegisterBenchmark(("making/" + name).c_str(), [make = make](benchmark::State& state) {
        ShapePointer made;
        for (auto _ : state) made = make();
        const auto& mesh = dynamic_cast<const Mesh&>(*made);
        state.counters["cell_mm"] = 1e3 * mesh.cell();
        state.counters["error_mm"] = 1e3 * mesh.error();
        state.counters["surface_error_mm"] = 1e3 * mesh.surfaceError();
      })->Unit(benchmark::kMillisecond);
    }
  }
  const ShapePointer object = sixPrimitives();
  benchmark::RegisterBenchmark("poses/12 capsule axes, six primitives",
                               [object](benchmark::State& state) { poses(state, *object); });
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
