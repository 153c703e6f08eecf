#include "framework/geometry/ellipsoid.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "framework/geometry/lengths.h"
#include "framework/geometry/surface.h"

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

double longest(const Vector3d& radii) {
  for (const double radius : radii) positive("the radius of an ellipsoid", radius);
  if (radii.maxCoeff() > 1000 * radii.minCoeff())
    throw std::invalid_argument("the longest radius of an ellipsoid is at most 1000 times the shortest");
  return radii.maxCoeff();
}

/// The t > 0 with F(t) = Σ (aᵢ/(t + gapᵢ))² = 1, a ≥ 0, gap₂ = 0, a₂ > 0 or F(0) > 1.  F falls, and 1/√F is concave
/// and nearly straight, so Newton's steps on it are few.  Where F is 1 to rounding, the point lies on the ellipsoid.
double solve(const Vector3d& a, const Vector3d& gap) {
  constexpr double rounding = 1e-15;
  double low = std::max(0.0, (a - gap).maxCoeff()), high = a.norm();
  double t = high, width = high - low;
  for (int i = 0; i < 200; ++i) {
    const Vector3d inverse = (t * Vector3d::Ones() + gap).cwiseInverse();
    const Vector3d squared = a.cwiseProduct(inverse).cwiseAbs2();
    const double F = squared.sum();
    if (std::abs(F - 1) <= rounding) break;
    (F > 1 ? low : high) = t;
    double next = t + F * (std::sqrt(F) - 1) / squared.dot(inverse);
    const bool halved = high - low <= 0.5 * width;
    width = high - low;
    if (!(next > low && next < high) || (i > 8 && !halved)) next = low + 0.5 * (high - low);
    if (next == t || next == low || next == high) break;
    t = next;
  }
  return t;
}

}  // namespace

Ellipsoid::Ellipsoid(const Vector3d& radii) : Shape(longest(radii), true), radii_(radii), axis_{0, 1, 2} {
  std::stable_sort(axis_.begin(), axis_.end(), [&](int i, int j) { return radii[i] > radii[j]; });
  for (int i = 0; i < 3; ++i) sorted_[i] = radii[axis_[i]];
  const double e = sorted_[2];
  for (int i = 0; i < 3; ++i) gap_[i] = (sorted_[i] - e) / e * ((sorted_[i] + e) / e);
}

/// The nearest point x of the first octant to y there has y − x = s Σ xᵢ/eᵢ², so xᵢ = eᵢ² yᵢ/(s + eᵢ²); with
/// t = s/e₂² + 1 and aᵢ = eᵢ yᵢ/e₂² it lies on the ellipsoid when F(t) = 1.
SignedDistance Ellipsoid::doDistance(const Vector3d& p) const {
  Vector3d y, a;
  const double e = sorted_[2];
  for (int i = 0; i < 3; ++i) {
    y[i] = std::abs(p[axis_[i]]);
    a[i] = sorted_[i] / e * (y[i] / e);
    if (a[i] < 1e-100) a[i] = 0;                                   // squares of it would underflow
  }
  Vector3d x;
  double on_plane = a[2] > 0 ? 2 : 0;                              // F(0), where the shortest axis has no part in it
  for (int i = 0; i < 2 && a[2] == 0; ++i)
    if (a[i] > 0) on_plane += gap_[i] > 0 ? a[i] / gap_[i] * (a[i] / gap_[i]) : 2;
  if (on_plane < 1) {                                              // both sides of the plane are equally near
    for (int i = 0; i < 2; ++i) x[i] = a[i] > 0 ? sorted_[i] * (a[i] / gap_[i]) : 0;
    x[2] = e * std::sqrt(1 - on_plane);
  } else {
    const double t = solve(a, gap_);
    for (int i = 0; i < 3; ++i) x[i] = a[i] > 0 ? sorted_[i] * (a[i] / (t + gap_[i])) : 0;
  }
  const Vector3d normal = x.cwiseQuotient(sorted_).cwiseQuotient(sorted_ / e).normalized();
  const double distance = (y - x).dot(normal);
  SignedDistance nearest;
  nearest.distance = distance;
  for (int i = 0; i < 3; ++i) nearest.gradient[axis_[i]] = std::copysign(normal[i], p[axis_[i]]);
  return nearest;
}

std::optional<Vector3d> Ellipsoid::doSupport(const Vector3d& n) const {
  const Vector3d stretched = radii_.cwiseProduct(n);
  return Vector3d(radii_.cwiseProduct(stretched) / stretched.norm());
}

TriangleMesh Ellipsoid::doSurface() const {
  TriangleMesh mesh = lathe(arc(Eigen::Vector2d::Zero(), 1, -std::numbers::pi / 2, std::numbers::pi / 2));
  for (Vector3d& vertex : mesh.vertices) vertex = vertex.cwiseProduct(radii_);
  return mesh;
}

}  // namespace tactus::geometry
