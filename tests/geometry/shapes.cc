#include "tests/geometry/shapes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "framework/geometry/compound.h"
#include "framework/geometry/cone.h"
#include "framework/geometry/ellipsoid.h"
#include "framework/geometry/extrusion.h"
#include "framework/geometry/primitives.h"
#include "framework/geometry/revolution.h"
#include "framework/geometry/torus.h"

namespace tactus::geometry_test {

using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace geometry;

namespace {

constexpr double pi = std::numbers::pi;
using Points = std::vector<Vector3d>;

/// Points of a patch p(u, v), u and v in [0, 1], whose edges are at most that long.
Points patch(double u_length, double v_length, double spacing, const std::function<Vector3d(double, double)>& p) {
  const int nu = std::max(1, static_cast<int>(std::ceil(u_length / spacing)));
  const int nv = std::max(1, static_cast<int>(std::ceil(v_length / spacing)));
  Points points;
  for (int i = 0; i <= nu; ++i)
    for (int j = 0; j <= nv; ++j) points.push_back(p(static_cast<double>(i) / nu, static_cast<double>(j) / nv));
  return points;
}

void add(Points& points, const Points& more) { points.insert(points.end(), more.begin(), more.end()); }

Points ballPoints(double radius, double spacing) {
  return patch(pi * radius, 2 * pi * radius, spacing, [=](double u, double v) -> Vector3d {
    return radius * Vector3d(std::sin(pi * u) * std::cos(2 * pi * v), std::sin(pi * u) * std::sin(2 * pi * v),
                             std::cos(pi * u));
  });
}

/// What an open or closed line (ρ, z) sweeps about z.
Points sweptPoints(const std::vector<Vector2d>& line, double spacing) {
  Points points;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Vector2d a = line[i], b = line[i + 1];
    if (a.x() == 0 && b.x() == 0) continue;
    add(points, patch((b - a).norm(), 2 * pi * std::max(a.x(), b.x()), spacing, [=](double u, double v) {
          const Vector2d q = a + u * (b - a);
          return Vector3d(q.x() * std::cos(2 * pi * v), q.x() * std::sin(2 * pi * v), q.y());
        }));
  }
  return points;
}

Points boxPoints(const Vector3d& size, double spacing) {
  Points points;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5}) {
      const int i = (axis + 1) % 3, j = (axis + 2) % 3;
      add(points, patch(size[i], size[j], spacing, [&](double u, double v) {
            Vector3d p;
            p[axis] = side * size[axis];
            p[i] = (u - 0.5) * size[i];
            p[j] = (v - 0.5) * size[j];
            return p;
          }));
    }
  return points;
}

bool isInside(const std::vector<Vector2d>& corners, const Vector2d& p) {
  bool inside = false;                                             // parity of the edges right of p
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Vector2d &a = corners[i], &b = corners[j];
    if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

Points extrusionPoints(const std::vector<Vector2d>& corners, double length, double spacing) {
  Points points;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d a = corners[i], b = corners[(i + 1) % corners.size()];
    add(points, patch((b - a).norm(), length, spacing, [=](double u, double v) {
          const Vector2d q = a + u * (b - a);
          return Vector3d(q.x(), q.y(), (v - 0.5) * length);
        }));
  }
  Vector2d low = corners[0], high = corners[0];
  for (const Vector2d& corner : corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  for (const Vector3d& p : patch(high.x() - low.x(), high.y() - low.y(), spacing, [&](double u, double v) {
         return Vector3d(low.x() + u * (high.x() - low.x()), low.y() + v * (high.y() - low.y()), 0.5 * length);
       }))
    if (isInside(corners, p.head<2>())) add(points, {p, Vector3d(p.x(), p.y(), -p.z())});
  return points;
}

Points capsulePoints(double radius, double length, double spacing) {
  Points points = sweptPoints({{radius, -0.5 * length}, {radius, 0.5 * length}}, spacing);
  for (const Vector3d& p : ballPoints(radius, spacing))
    points.push_back(p + Vector3d(0, 0, std::copysign(0.5 * length, p.z())));
  return points;
}

Points torusPoints(double radius, double tube, double angle, double spacing) {
  Points points = patch(angle * (radius + tube), 2 * pi * tube, spacing, [=](double u, double v) {
    const double turn = (u - 0.5) * angle, rho = radius + tube * std::cos(2 * pi * v);
    return Vector3d(rho * std::cos(turn), rho * std::sin(turn), tube * std::sin(2 * pi * v));
  });
  if (angle >= 2 * pi) return points;
  for (const double side : {-0.5, 0.5}) {
    const Vector2d radial(std::cos(side * angle), std::sin(side * angle)), onwards(-radial.y(), radial.x());
    for (const Vector3d& p : ballPoints(tube, spacing))
      if (2 * side * p.head<2>().dot(onwards) >= 0)
        points.push_back(p + radius * Vector3d(radial.x(), radial.y(), 0));
  }
  return points;
}

/// A star of random reach: simple, seldom convex.
std::vector<Vector2d> star(Random& random, int corners, const Vector2d& middle, double most) {
  std::vector<Vector2d> outline;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * pi * (i + random.uniform(0, 0.8)) / corners, reach = random.uniform(0.2, 1) * most;
    outline.push_back(middle + reach * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return outline;
}

std::vector<Vector2d> cup(Random& random) {
  const double wall = random.uniform(0.005, 0.02), bottom = random.uniform(0.005, 0.02);
  const double height = random.uniform(0.05, 0.15), top = random.uniform(0.04, 0.1), foot = 0.8 * top;
  return {{0, 0}, {foot, 0}, {top, height}, {top - wall, height}, {foot - wall, bottom}, {0, bottom}};
}

std::vector<Vector2d> closed(std::vector<Vector2d> line) {
  line.push_back(line.front());
  return line;
}

}  // namespace

std::vector<Specimen> exactShapes(Random& random, double spacing) {
  std::vector<Specimen> all;
  const auto put = [&](const std::string& name, std::shared_ptr<const Shape> shape, Points surface, bool exact = true) {
    all.push_back({name, std::move(shape), std::move(surface), spacing, exact});
  };
  put("plane", std::make_shared<Plane>(), {});
  const Vector3d size(random.length(), random.length(), random.length());
  put("box", std::make_shared<Box>(size), boxPoints(size, spacing));
  const double r = random.length(), s = random.length(), l = random.length();
  put("sphere", std::make_shared<Sphere>(r), ballPoints(r, spacing));
  put("cylinder", std::make_shared<Cylinder>(r, l),
      sweptPoints({{0, -l / 2}, {r, -l / 2}, {r, l / 2}, {0, l / 2}}, spacing));
  put("capsule", std::make_shared<Capsule>(r, l), capsulePoints(r, l, spacing));
  put("truncated cone", std::make_shared<Cone>(r, s, l),
      sweptPoints({{0, -l / 2}, {r, -l / 2}, {s, l / 2}, {0, l / 2}}, spacing));
  put("cone", std::make_shared<Cone>(r, 0, l), sweptPoints({{0, -l / 2}, {r, -l / 2}, {0, l / 2}}, spacing));
  put("cone on its tip", std::make_shared<Cone>(0, r, l), sweptPoints({{0, -l / 2}, {r, l / 2}, {0, l / 2}}, spacing));

  const Vector3d radii(random.length(), random.length(), random.length());
  Points skin = ballPoints(1, spacing / radii.maxCoeff());
  for (Vector3d& p : skin) p = p.cwiseProduct(radii);
  put("ellipsoid", std::make_shared<Ellipsoid>(radii), std::move(skin));
  const Vector3d disc(radii[0], radii[0], 0.2 * radii[0]);
  Points disc_skin = ballPoints(1, spacing / disc.maxCoeff());
  for (Vector3d& p : disc_skin) p = p.cwiseProduct(disc);
  put("disc", std::make_shared<Ellipsoid>(disc), std::move(disc_skin));

  const double ring = random.uniform(0.05, 0.15), tube = random.uniform(0.1, 0.6) * ring;
  for (const double angle : {random.uniform(0.1, pi), random.uniform(pi, 1.5 * pi), 2 * pi})
    put("torus of " + std::to_string(angle), std::make_shared<Torus>(ring, tube, angle),
        torusPoints(ring, tube, angle, spacing));

  const auto outline = star(random, 9, {0.01, -0.02}, 0.15);
  put("extrusion", std::make_shared<Extrusion>(outline, l), extrusionPoints(outline, l, spacing));
  const std::vector<Vector2d> roof{{-r, 0}, {r, 0}, {0, s}};
  put("prism", std::make_shared<Extrusion>(roof, l), extrusionPoints(roof, l, spacing));
  const auto profile = cup(random);
  put("cup", std::make_shared<Revolution>(profile), sweptPoints(closed(profile), spacing));
  const auto bead = star(random, 7, {0.12, 0.02}, 0.1);
  put("ring of star profile", std::make_shared<Revolution>(bead), sweptPoints(closed(bead), spacing));
  const std::vector<Vector2d> top{{0, -l}, {r, 0}, {0, s}};
  put("spinning top", std::make_shared<Revolution>(top), sweptPoints(closed(top), spacing));

  // A union of a tilted box and a ball that overlaps it: its surface is what of theirs lies in no other part.
  PosedShape slab{std::make_shared<Box>(size)}, ball{std::make_shared<Sphere>(r)};
  slab.pose.rotate(Eigen::AngleAxisd(random.uniform(-3, 3), random.inCube(1).normalized()));
  slab.pose.translation() = random.inCube(0.1);
  ball.pose.translation() = slab.pose * Vector3d(0.4 * size.x(), 0, 0);
  Points both;
  for (const Vector3d& p : boxPoints(size, spacing))
    if ((slab.pose * p - ball.pose.translation()).norm() >= r) both.push_back(slab.pose * p);
  for (const Vector3d& p : ballPoints(r, spacing)) {
    const Vector3d q = ball.pose * p;
    if (((slab.pose.inverse() * q).cwiseAbs() - size / 2).maxCoeff() >= 0) both.push_back(q);
  }
  put("union", std::make_shared<Compound>(std::vector<PosedShape>{slab, ball}), std::move(both), false);
  return all;
}

TriangleMesh ballMesh(double radius, int n) {
  TriangleMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      const auto first = static_cast<int>(mesh.vertices.size());
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          // The angle goes evenly from −π/4 to π/4; symmetric to the byte, that faces' borders are the same.
          const auto slope = [n](int k) {
            const int centred = 2 * k - n;
            return std::copysign(std::tan(0.25 * pi * std::abs(centred) / n), centred);
          };
          Vector3d p;
          p[axis] = side;
          p[(axis + 1) % 3] = std::abs(2 * i - n) == n ? std::copysign(1.0, 2 * i - n) : slope(i);
          p[(axis + 2) % 3] = std::abs(2 * j - n) == n ? std::copysign(1.0, 2 * j - n) : slope(j);
          // A sum in an order that does not depend on the face.
          Vector3d sorted = p.cwiseAbs();
          std::sort(sorted.data(), sorted.data() + 3);
          const double length = std::sqrt(sorted[0] * sorted[0] + sorted[1] * sorted[1] + sorted[2] * sorted[2]);
          mesh.vertices.push_back(radius / length * p);
        }
      const auto vertex = [&](int i, int j) { return first + j * (n + 1) + i; };
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          std::array<int, 3> one{vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)};
          std::array<int, 3> two{vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)};
          if (side < 0) {
            std::swap(one[1], one[2]);
            std::swap(two[1], two[2]);
          }
          mesh.triangles.push_back(one);
          mesh.triangles.push_back(two);
        }
    }
  return welded(mesh);
}

TriangleMesh boxMesh(const Vector3d& size) {
  TriangleMesh mesh;
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d side(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
    mesh.vertices.push_back(side.cwiseProduct(size));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

}  // namespace tactus::geometry_test
