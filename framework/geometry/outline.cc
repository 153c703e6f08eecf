#include "framework/geometry/outline.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace tactus::geometry {
namespace {

using Eigen::Vector2d;
using Corners = std::vector<Vector2d>;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Twice the area to the left of a → b towards c: > 0 when c lies left.
double side(const Vector2d& a, const Vector2d& b, const Vector2d& c) { return cross(b - a, c - a); }

bool boxesMeet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  return (a.cwiseMin(b).array() <= c.cwiseMax(d).array()).all() &&
         (c.cwiseMin(d).array() <= a.cwiseMax(b).array()).all();
}

/// Whether the segments ab and cd have a point in common.
bool meet(const Vector2d& a, const Vector2d& b, const Vector2d& c, const Vector2d& d) {
  return boxesMeet(a, b, c, d) && side(a, b, c) * side(a, b, d) <= 0 && side(c, d, a) * side(c, d, b) <= 0;
}

double area(const Corners& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    twice += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return 0.5 * twice;
}

void requireSimple(const Corners& corners) {
  const std::size_t n = corners.size();
  if (n < 3) throw std::invalid_argument("an outline has three corners or more, not " + std::to_string(n));
  for (const Vector2d& corner : corners)
    if (!corner.allFinite()) throw std::invalid_argument("the corners of an outline are finite");
  const auto named = [n](std::size_t edge) {
    return "corners " + std::to_string(edge + 1) + " and " + std::to_string((edge + 1) % n + 1);
  };
  for (std::size_t i = 0; i < n; ++i)
    if (corners[i] == corners[(i + 1) % n]) throw std::invalid_argument(named(i) + " of the outline are the same");
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d &a = corners[i], &b = corners[(i + 1) % n], &c = corners[(i + 2) % n];
    if (side(a, b, c) == 0 && (b - a).dot(c - b) < 0)
      throw std::invalid_argument("the outline turns back on itself at corner " + std::to_string((i + 1) % n + 1));
    for (std::size_t j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;                          // neighbours
      if (meet(a, b, corners[j], corners[(j + 1) % n]))
        throw std::invalid_argument("the outline meets itself: its edge between " + named(i) + " and that between " +
                                    named(j) + " have a point in common");
    }
  }
}

}  // namespace

Outline::Outline(Corners corners) : Outline(std::move(corners), false) {}

Outline Outline::rightHalf(Corners corners) { return Outline(std::move(corners), true); }

Outline::Outline(Corners corners, bool right_half) : corners_(std::move(corners)), right_half_(right_half) {
  requireSimple(corners_);
  if (right_half)
    for (std::size_t i = 0; i < corners_.size(); ++i)
      if (corners_[i].x() < 0)
        throw std::invalid_argument("corner " + std::to_string(i + 1) + " of the outline lies across the axis");
  if (area(corners_) < 0) std::reverse(corners_.begin(), corners_.end());

  const std::size_t n = corners_.size();
  const auto normalOf = [&](std::size_t i) -> Vector2d {          // of the edge from corner i; 0 of one on the axis
    const Vector2d &a = corners_[i], &b = corners_[(i + 1) % n];
    if (right_half && a.x() == 0 && b.x() == 0) return Vector2d::Zero();
    return Vector2d(b.y() - a.y(), a.x() - b.x()).normalized();
  };
  const auto cornerNormal = [&](std::size_t i) -> Vector2d {
    const Vector2d before = normalOf((i + n - 1) % n), after = normalOf(i);
    Vector2d sum = before + after;
    if (right_half && corners_[i].x() == 0) sum.x() = 0;           // with the mirror images of both
    const double length = sum.norm();
    if (length > 1e-9) return sum / length;
    return after.isZero() ? before : after;                        // met by no point but the corner itself
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Vector2d normal = normalOf(i);
    if (normal.isZero()) continue;
    const Vector2d &a = corners_[i], &b = corners_[(i + 1) % n];
    const double length = (b - a).norm();
    edges_.push_back({a, b, (b - a) / length, normal, cornerNormal(i), cornerNormal((i + 1) % n), length});
  }
}

PlanarDistance Outline::distance(const Vector2d& p) const {
  const Edge* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Edge& edge : edges_) {
    const Vector2d offset = p - edge.start;
    const double along = std::clamp(offset.dot(edge.direction), 0.0, edge.length);
    const double squared = (offset - along * edge.direction).squaredNorm();
    if (squared < least) {
      least = squared;
      nearest = &edge;
    }
  }
  const double along = (p - nearest->start).dot(nearest->direction);
  if (along > 0 && along < nearest->length) return {(p - nearest->start).dot(nearest->normal), nearest->normal};
  const Vector2d offset = p - (along > 0 ? nearest->end : nearest->start);
  const Vector2d& normal = along > 0 ? nearest->end_normal : nearest->start_normal;
  const double length = offset.norm();
  if (length == 0) return {0, normal};
  const double sign = offset.dot(normal) < 0 ? -1 : 1;
  return {sign * length, sign / length * offset};
}

bool Outline::isConvex() const {
  for (const Edge& edge : edges_)
    for (const Vector2d& corner : corners_) {
      const double rounding = 1e-12 * (edge.length + (corner - edge.start).norm());
      if ((corner - edge.start).dot(edge.normal) > rounding) return false;
      if (right_half_ && (Vector2d(-corner.x(), corner.y()) - edge.start).dot(edge.normal) > rounding) return false;
    }
  return true;
}

Vector2d Outline::centroid() const {
  Vector2d sum = Vector2d::Zero();
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Vector2d a = corners_[i] - corners_[0], b = corners_[(i + 1) % corners_.size()] - corners_[0];
    sum += cross(a, b) / 6 * (a + b);
  }
  return corners_[0] + sum / area(corners_);
}

}  // namespace tactus::geometry
