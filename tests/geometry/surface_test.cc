// The triangles of a shape are its surface: corners on it, closed, looking outwards, around the right volume.

#include "framework/geometry/surface.h"

#include <gtest/gtest.h>

#include "framework/geometry/mesh.h"
#include "framework/geometry/primitives.h"
#include "framework/geometry/uniform_body.h"
#include "tests/geometry/shapes.h"

namespace tactus::geometry_test {
namespace {

using Eigen::Vector3d;
using namespace geometry;

double volumeOf(const Shape& shape) {
  return uniformBody([&](const Vector3d& p) { return shape.distance(p).distance; }, Vector3d::Zero(),
                     shape.boundingRadius())
      .volume;
}

double farthestOff(const TriangleMesh& mesh, const Shape& shape) {
  double farthest = 0;
  for (const Vector3d& vertex : mesh.vertices)
    farthest = std::max(farthest, std::abs(shape.distance(vertex).distance));
  return farthest;
}

TEST(Surface, OfEveryShapeLiesOnItAndHoldsItsVolume) {
  Random random(5);
  for (const Specimen& specimen : exactShapes(random, 0.05)) {
    const TriangleMesh mesh = specimen.shape->surface();
    ASSERT_FALSE(mesh.triangles.empty()) << specimen.name;
    if (!specimen.depth_is_exact) continue;                        // parts lie within others
    EXPECT_LT(farthestOff(mesh, *specimen.shape), 1e-6) << specimen.name;
    if (std::isinf(specimen.shape->boundingRadius())) continue;
    EXPECT_NO_THROW(requireClosed(mesh)) << specimen.name;
    const double volume = volumeOf(*specimen.shape);
    EXPECT_NEAR(mesh.volume(), volume, 0.03 * volume) << specimen.name;
  }
}

TEST(Surface, ByTheDistanceAloneToo) {
  Random random(6);
  for (const Specimen& specimen : exactShapes(random, 0.05)) {
    if (!specimen.depth_is_exact || std::isinf(specimen.shape->boundingRadius())) continue;
    const TriangleMesh mesh = surfaceNets(*specimen.shape);
    EXPECT_LT(farthestOff(mesh, *specimen.shape), 0.02 * specimen.shape->boundingRadius()) << specimen.name;
    const double volume = volumeOf(*specimen.shape);
    EXPECT_NEAR(mesh.volume(), volume, 0.05 * volume) << specimen.name;
  }
}

TEST(Surface, OfABoxIsItsTwelveTriangles) {
  const TriangleMesh mesh = Box({0.1, 0.2, 0.3}).surface();
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_NO_THROW(requireClosed(mesh));
  EXPECT_NEAR(mesh.volume(), 0.006, 1e-12);
}

TEST(Surface, OfAMeshIsTheMesh) {
  const TriangleMesh ball = ballMesh(0.1, 6);
  const TriangleMesh mesh = Mesh(ball, 0.02).surface();
  EXPECT_EQ(mesh.triangles, ball.triangles);
  EXPECT_EQ(mesh.vertices, ball.vertices);
}

TEST(Surface, OfPartsStandsWhereTheyDo) {
  Eigen::Isometry3d aside = Eigen::Isometry3d::Identity();
  aside.translation() = Vector3d(1, 2, 3);
  const TriangleMesh mesh = surfaceOf({{std::make_shared<Box>(Vector3d(0.2, 0.2, 0.2)), aside}});
  for (const Vector3d& vertex : mesh.vertices)
    EXPECT_NEAR((vertex - aside.translation()).cwiseAbs().maxCoeff(), 0.1, 1e-12);
}

}  // namespace
}  // namespace tactus::geometry_test
