#include "framework/geometry/convex_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::geometry {
namespace {

using Eigen::Vector2d;
using Corners = std::vector<Vector2d>;
using Ring = std::vector<int>;                                     // indices of corners, counter-clockwise

constexpr double rounding = 1e-12;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Sine of the turn from a → b towards c: > 0 when c lies left.
double turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return cross((b - a).normalized(), (c - b).normalized());
}

Vector2d toSegment(const Vector2d& a, const Vector2d& b, const Vector2d& p) {
  const Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0;
  return p - a - t * along;
}

class Cutter {
 public:
  explicit Cutter(const Corners& corners) : corners_(corners) {}

  ConvexParts cut() {
    Ring all(corners_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
    split(all);
    ConvexParts made;
    for (const Ring& ring : rings_) {
      Corners part;
      for (const int corner : ring) part.push_back(corners_[corner]);
      made.parts.emplace_back(std::move(part));
    }
    for (const auto& [from, to] : diagonals_)
      made.cuts.push_back({ConvexSet({corners_[from], corners_[to]}), {ringWith(from, to), ringWith(to, from)}});
    return made;
  }

 private:
  const Vector2d& at(const Ring& ring, std::size_t i) const { return corners_[ring[i % ring.size()]]; }

  bool isHollow(const Ring& ring, std::size_t i) const {
    return turn(at(ring, i + ring.size() - 1), at(ring, i), at(ring, i + 1)) < -rounding;
  }

  /// Whether the direction from corner i to p goes into the ring.
  bool looksInside(const Ring& ring, std::size_t i, const Vector2d& p) const {
    const Vector2d &before = at(ring, i + ring.size() - 1), &here = at(ring, i), &after = at(ring, i + 1);
    const bool left_of_first = turn(before, here, p) > rounding, left_of_second = turn(here, after, p) > rounding;
    return isHollow(ring, i) ? left_of_first || left_of_second : left_of_first && left_of_second;
  }

  bool isDiagonal(const Ring& ring, std::size_t i, std::size_t j) const {
    const Vector2d &a = at(ring, i), &b = at(ring, j);
    if (!looksInside(ring, i, b) || !looksInside(ring, j, a)) return false;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const std::size_t next = (k + 1) % ring.size();
      if (k != i && k != j && toSegment(a, b, at(ring, k)).norm() <= rounding * (b - a).norm()) return false;
      if (k == i || k == j || next == i || next == j) continue;
      const Vector2d &c = at(ring, k), &d = at(ring, next);
      if (cross(b - a, c - a) * cross(b - a, d - a) < 0 && cross(d - c, a - c) * cross(d - c, b - c) < 0) return false;
    }
    return true;
  }

  /// Whether a diagonal from corner i to p leaves no hollow there on either side.
  bool levels(const Ring& ring, std::size_t i, const Vector2d& p) const {
    return turn(at(ring, i + ring.size() - 1), at(ring, i), p) >= -rounding &&
           turn(p, at(ring, i), at(ring, i + 1)) >= -rounding;
  }

  void split(const Ring& ring) {
    const std::size_t n = ring.size();
    double shortest = std::numeric_limits<double>::infinity();
    bool best_levels = false;
    std::size_t from = n, to = n;
    for (std::size_t i = 0; i < n; ++i) {
      if (!isHollow(ring, i)) continue;
      for (std::size_t j = 0; j < n; ++j) {
        if (j == i || j == (i + 1) % n || i == (j + 1) % n) continue;
        const double length = (at(ring, i) - at(ring, j)).norm();
        const bool does_level = levels(ring, i, at(ring, j));
        if (does_level < best_levels || (does_level == best_levels && length >= shortest)) continue;
        if (!isDiagonal(ring, i, j)) continue;
        shortest = length;
        best_levels = does_level;
        from = i;
        to = j;
      }
    }
    if (from == n) {
      rings_.push_back(ring);
      return;
    }
    diagonals_.push_back({ring[from], ring[to]});
    Ring left, right;
    for (std::size_t k = to; k != from; k = (k + 1) % n) left.push_back(ring[k]);
    left.push_back(ring[from]);
    for (std::size_t k = from; k != to; k = (k + 1) % n) right.push_back(ring[k]);
    right.push_back(ring[to]);
    split(left);
    split(right);
  }

  int ringWith(int from, int to) const {
    for (std::size_t r = 0; r < rings_.size(); ++r)
      for (std::size_t i = 0; i < rings_[r].size(); ++i)
        if (rings_[r][i] == from && rings_[r][(i + 1) % rings_[r].size()] == to) return static_cast<int>(r);
    return -1;                                                     // cannot be: a diagonal is never cut again
  }

  const Corners& corners_;
  std::vector<Ring> rings_;
  std::vector<std::array<int, 2>> diagonals_;
};

}  // namespace

Vector2d ConvexSet::offset(const Vector2d& p) const {
  const std::size_t n = corners_.size();
  const std::size_t edges = n > 2 ? n : n - 1;
  bool inside = n > 2;
  Vector2d least = p - corners_.front();
  for (std::size_t i = 0; i < edges; ++i) {
    const Vector2d &a = corners_[i], &b = corners_[(i + 1) % n];
    if (cross(b - a, p - a) < 0) inside = false;
    const Vector2d offset = toSegment(a, b, p);
    if (offset.squaredNorm() < least.squaredNorm()) least = offset;
  }
  return inside ? Vector2d::Zero() : least;
}

ConvexParts convexParts(const Corners& corners) { return Cutter(corners).cut(); }

}  // namespace tactus::geometry
