// Meshes against the solids that they tessellate, and the interpolated distances against the exact search, which itself
// is held to brute force over all triangles.

#include "framework/geometry/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "conformance/broken.h"
#include "conformance/shape_laws.h"
#include "framework/geometry/extrusion.h"
#include "framework/geometry/heights.h"
#include "framework/geometry/primitives.h"
#include "tests/geometry/shapes.h"

namespace tactus::geometry_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace geometry;
using testing::HasSubstr;

/// A block with a notch: not convex, with sharp edges both ways.
const std::vector<Vector2d> notched{{-0.06, -0.05}, {0.06, -0.05}, {0.06, 0.05}, {0.02, 0.05},
                                    {0.01, -0.01},  {-0.03, 0.05}, {-0.06, 0.05}};

/// The same as triangles.
TriangleMesh notchedMesh(double length) {
  TriangleMesh mesh;
  const int n = static_cast<int>(notched.size());
  for (const double z : {-0.5 * length, 0.5 * length})
    for (const Vector2d& corner : notched) mesh.vertices.emplace_back(corner.x(), corner.y(), z);
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
  }
  for (const auto& [a, b, c] : {std::array{0, 1, 4}, {1, 2, 3}, {1, 3, 4}, {0, 4, 5}, {0, 5, 6}}) {
    mesh.triangles.push_back({n + a, n + b, n + c});
    mesh.triangles.push_back({c, b, a});
  }
  return mesh;
}

TriangleMesh hills() {
  Eigen::MatrixXd heights(7, 9);
  for (int i = 0; i < 7; ++i)
    for (int j = 0; j < 9; ++j) heights(i, j) = 0.03 + 0.02 * std::sin(0.9 * i) * std::cos(1.3 * j);
  return heightMesh(heights, {0.02, 0.03}, -0.01);
}

struct Case {
  std::string name;
  TriangleMesh mesh;
};

std::vector<Case> cases() {
  return {{"ball", ballMesh(0.07, 12)}, {"box", boxMesh({0.05, 0.12, 0.08})}, {"notched block", notchedMesh(0.08)},
          {"plate", boxMesh({0.3, 0.2, 0.01})}, {"hills", hills()}};
}

double extent(const Case& one) {
  double farthest = 0;
  for (const Vector3d& vertex : one.mesh.vertices) farthest = std::max(farthest, vertex.norm());
  return farthest;
}

/// Nearest of points spread over each triangle.
double bruteForce(const TriangleMesh& mesh, const Vector3d& p, int n) {
  double nearest = 1e300;
  for (const auto& [a, b, c] : mesh.triangles)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; i + j <= n; ++j) {
        const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
        const Vector3d q = (1 - u - v) * mesh.vertices[a] + u * mesh.vertices[b] + v * mesh.vertices[c];
        nearest = std::min(nearest, (q - p).norm());
      }
  return nearest;
}

TEST(TriangleSearch, FindsTheNearestOfAllTriangles) {
  Random random(1);
  for (const Case& one : cases()) {
    const TriangleSearch search(one.mesh);
    const double R = extent(one);
    double longest = 0;
    for (const auto& [a, b, c] : one.mesh.triangles)
      longest = std::max({longest, (one.mesh.vertices[b] - one.mesh.vertices[a]).norm(),
                          (one.mesh.vertices[c] - one.mesh.vertices[b]).norm(),
                          (one.mesh.vertices[a] - one.mesh.vertices[c]).norm()});
    for (int i = 0; i < 60; ++i) {
      const Vector3d p = random.inCube(1.2 * R);
      const SignedDistance found = search.distance(p);
      const double nearest = bruteForce(one.mesh, p, 40);
      EXPECT_GE(nearest, std::abs(found.distance) - 1e-12) << one.name;
      EXPECT_LE(nearest, std::abs(found.distance) + longest / 40) << one.name;
      const SignedDistance again = search.distance(p, std::abs(found.distance));
      EXPECT_EQ(again.distance, found.distance) << "a bound changes nothing";
      EXPECT_EQ(again.gradient, found.gradient);
    }
  }
}

TEST(TriangleSearch, OfABoxAndAPrismIsTheSolidsOwnDistance) {
  Random random(2);
  const Vector3d size(0.05, 0.12, 0.08);
  const Box box(size);
  const TriangleSearch box_search(boxMesh(size));
  const Extrusion block(notched, 0.08);
  const TriangleSearch block_search(notchedMesh(0.08));
  for (int i = 0; i < 20000; ++i) {
    const Vector3d p = random.inCube(0.15);
    EXPECT_NEAR(box_search.distance(p).distance, box.distance(p).distance, 1e-14);
    EXPECT_NEAR(block_search.distance(p).distance, block.distance(p).distance, 1e-14);
  }
  // Nearest to edges and corners, where one triangle's own normal would not tell the side.
  for (const Vector3d& corner : boxMesh(size).vertices)
    for (int i = 0; i < 200; ++i) {
      const Vector3d p = corner + random.inCube(0.01);
      EXPECT_NEAR(box_search.distance(p).distance, box.distance(p).distance, 1e-14);
    }
}

TEST(Mesh, KeepsTheLaws) {
  for (const Case& one : cases()) {
    const Mesh mesh(one.mesh);
    for (const conformance::ShapeLaw& law : conformance::shapeLaws()) {
      try {
        law.check(mesh);
      } catch (const conformance::Broken& broken) {
        ADD_FAILURE() << one.name << ", " << law.name << ": " << broken.message;
      } catch (const conformance::NotAsked&) {
      }
    }
  }
}

TEST(Mesh, IsOffByItsErrorAtMost) {
  Random random(3);
  for (const Case& one : cases()) {
    const Mesh mesh(one.mesh);
    const double R = extent(one);
    double worst = 0, worst_near = 0;
    for (int i = 0; i < 200000; ++i) {
      const Vector3d p = random.inCube(2 * R);
      const double exact = mesh.exactDistance(p).distance, off = std::abs(mesh.distance(p).distance - exact);
      worst = std::max(worst, off);
      if (std::abs(exact) < mesh.cell()) worst_near = std::max(worst_near, off);
    }
    EXPECT_LE(worst, mesh.error()) << one.name;
    EXPECT_LE(worst_near, mesh.surfaceError()) << one.name;
    EXPECT_LE(mesh.surfaceError(), mesh.error());
    EXPECT_GT(worst, 0.4 * mesh.error()) << one.name << ": the bound says nothing";
    EXPECT_LE(mesh.surfaceError(), 0.6 * mesh.cell()) << one.name;
    EXPECT_LE(mesh.error(), 0.1 * R) << one.name;
  }
}

TEST(Mesh, OfABallTendsToTheBall) {
  Random random(4);
  const Sphere ball(0.07);
  for (const int n : {8, 16, 32}) {
    const Mesh mesh(ballMesh(0.07, n));
    double worst = 0, turned = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vector3d p = random.inCube(0.12);
      if (p.norm() < 0.03 || p.norm() > 0.1) continue;             // ridges of the faceted ball meet in its middle
      const SignedDistance here = mesh.distance(p), exact = ball.distance(p);
      worst = std::max(worst, std::abs(here.distance - exact.distance));
      if (exact.distance > 0) turned = std::max(turned, (here.gradient - exact.gradient).norm());
    }
    EXPECT_LT(worst, 0.06 / (n * n)) << n;                         // facets cut h²/8r off
    EXPECT_LT(turned, 1.6 / n) << n;                               // twice the angle of a facet
  }
}

TEST(Mesh, GradientIsGoodOutsideFlatFaces) {
  const Vector3d size(0.05, 0.12, 0.08);
  const Mesh mesh(boxMesh(size));
  Random random(5);
  for (int i = 0; i < 5000; ++i) {
    Vector3d p = random.inCube(0.35).cwiseProduct(size);
    p.z() = 0.5 * size.z() + random.uniform(0, 3.5) * mesh.cell();
    ASSERT_NEAR(mesh.distance(p).distance, p.z() - 0.5 * size.z(), 1e-8);
    ASSERT_LT((mesh.distance(p).gradient - Vector3d::UnitZ()).norm(), 1e-5);
  }
}

TEST(Mesh, IsTheSameEachTimeItIsMade) {
  Random random(6);
  const Mesh one(hills()), other(hills());
  EXPECT_EQ(one.error(), other.error());
  for (int i = 0; i < 1000; ++i) {
    const Vector3d p = random.inCube(0.2);
    const double a = one.distance(p).distance, b = other.distance(p).distance;
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
  }
}

TEST(Mesh, GradientDoesNotJumpWhereCellsAndGridsMeet) {
  const Mesh mesh(ballMesh(0.07, 12));
  Random random(7);
  for (int line = 0; line < 50; ++line) {
    const Vector3d direction = random.inCube(1).normalized(), across = random.inCube(0.02);
    SignedDistance last = mesh.distance(across + 0.05 * direction);
    const double step = 1e-6;                                      // through all grids, and out of the last
    for (double at = 0.05; at < 0.07 + 0.15; at += step * (1 + 2000 * random.uniform(0, 1))) {
      last = mesh.distance(across + at * direction);
      const SignedDistance next = mesh.distance(across + (at + step) * direction);
      EXPECT_LT(std::abs(next.distance - last.distance), 1.6 * step);
      EXPECT_LT((next.gradient - last.gradient).norm(), 5e-3) << at;
    }
  }
}

/// What requireClosed says of a box whose triangles `change` spoils.
template <class Change>
std::string refusal(Change change) {
  TriangleMesh mesh = boxMesh({0.1, 0.1, 0.1});
  change(mesh);
  try {
    const Mesh made(mesh);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Mesh, RefusesWhatBoundsNoSolid) {
  EXPECT_EQ(refusal([](TriangleMesh& mesh) { mesh.triangles.pop_back(); }),
            "the mesh is not closed: 3 edges have a triangle on one side only");
  EXPECT_EQ(refusal([](TriangleMesh& mesh) { std::swap(mesh.triangles[3][0], mesh.triangles[3][1]); }),
            "the triangles do not agree which side is outside: at 3 edges one of two neighbours is turned over");
  EXPECT_EQ(refusal([](TriangleMesh& mesh) { mesh.triangles.push_back(mesh.triangles[0]); }),
            "the mesh does not bound a solid: more than two triangles meet at 3 edges");
  EXPECT_EQ(refusal([](TriangleMesh& mesh) {
              for (auto& triangle : mesh.triangles) std::swap(triangle[0], triangle[1]);
            }),
            "the triangles of the mesh look inwards: turn all of them over");
  EXPECT_EQ(refusal([](TriangleMesh& mesh) { mesh.triangles.clear(); }), "the mesh has no triangles");
  EXPECT_EQ(refusal([](TriangleMesh& mesh) { mesh.vertices[2].x() = NAN; }), "the vertices of a mesh are finite");
  EXPECT_EQ(refusal([](TriangleMesh& mesh) { mesh.triangles[2][1] = 8; }),
            "a triangle of the mesh names a vertex that there is not");
  EXPECT_EQ(refusal([](TriangleMesh&) {}), "accepted");
}

TEST(Mesh, RefusesCellsThatMakeNoSense) {
  const TriangleMesh box = boxMesh({0.1, 0.1, 0.1});
  EXPECT_THROW(Mesh(box, -1), std::invalid_argument);
  EXPECT_THROW(Mesh(box, NAN), std::invalid_argument);
  EXPECT_THROW(Mesh(box, 1e-9), std::invalid_argument);
  EXPECT_DOUBLE_EQ(Mesh(box, 0.01).cell(), 0.01);
}

TEST(Welded, JoinsWhatFilesRepeat) {
  const TriangleMesh box = boxMesh({0.1, 0.2, 0.3});
  TriangleMesh soup;
  for (const auto& triangle : box.triangles) {
    const int first = static_cast<int>(soup.vertices.size());
    for (const int vertex : triangle) soup.vertices.push_back(box.vertices[vertex]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.triangles.push_back({0, 0, 1});
  const TriangleMesh whole = welded(soup);
  EXPECT_EQ(whole.vertices.size(), 8u);
  EXPECT_EQ(whole.triangles.size(), 12u);
  EXPECT_NO_THROW(requireClosed(whole));
  EXPECT_NEAR(whole.volume(), 0.006, 1e-15);
}

TEST(Heights, ByHand) {
  Eigen::MatrixXd heights(2, 3);
  heights << 0.01, 0.01, 0.03, 0.01, 0.01, 0.03;
  const TriangleMesh mesh = heightMesh(heights, {0.1, 0.2}, 0);
  EXPECT_NO_THROW(requireClosed(mesh));
  EXPECT_NEAR(mesh.volume(), 0.2 * (0.1 * 0.01 + 0.1 * 0.02), 1e-15);
  const TriangleSearch search(mesh);
  EXPECT_NEAR(search.distance({-0.05, 0.03, 0.05}).distance, 0.04, 1e-15);  // over the level half
  EXPECT_NEAR(search.distance({0.1 + 0.02, 0, 0.01}).distance, 0.02, 1e-15);  // beside the wall
  EXPECT_NEAR(search.distance({-0.08, 0, -0.03}).distance, 0.03, 1e-15);      // below the base
  EXPECT_LT(search.distance({0.09, 0, 0.02}).distance, 0);
  EXPECT_GT(search.distance({0.01, 0, 0.02}).distance, 0);
}

TEST(Heights, RefuseFieldsThatAreNone) {
  const Eigen::MatrixXd flat = Eigen::MatrixXd::Constant(3, 3, 0.1);
  EXPECT_THROW(heightMesh(flat.topRows(1), {0.1, 0.1}, 0), std::invalid_argument);
  EXPECT_THROW(heightMesh(flat.leftCols(1), {0.1, 0.1}, 0), std::invalid_argument);
  EXPECT_THROW(heightMesh(flat, {0, 0.1}, 0), std::invalid_argument);
  EXPECT_THROW(heightMesh(flat, {0.1, 0.1}, 0.1), std::invalid_argument);
  EXPECT_THROW(heightMesh(flat * NAN, {0.1, 0.1}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::geometry_test
