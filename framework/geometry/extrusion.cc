#include "framework/geometry/extrusion.h"

#include <algorithm>
#include <cmath>

#include "framework/geometry/convex_parts.h"
#include "framework/geometry/lengths.h"

namespace tactus::geometry {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double level = 1e-9;                                     ///< components of a direction below it count as 0

double farthestCorner(const Outline& outline, double length) {
  double farthest = 0;
  for (const Vector2d& corner : outline.corners()) farthest = std::max(farthest, corner.norm());
  return std::hypot(farthest, 0.5 * positive("the length of an extrusion", length));
}

/// Over a convex part of the outline, or a cut.
class Prism final : public Shape {
 public:
  Prism(ConvexSet base, double length, std::shared_ptr<const Shape> whole)
      : Shape(whole->boundingRadius(), true), base_(std::move(base)), length_(length), whole_(std::move(whole)) {}

 private:
  SignedDistance doDistance(const Vector3d& p) const override {
    const Vector2d aside = base_.offset(p.head<2>());
    const Vector3d offset(aside.x(), aside.y(), std::copysign(std::max(0.0, std::abs(p.z()) - 0.5 * length_), p.z()));
    const double distance = offset.norm();
    if (distance == 0) return whole_->distance(p);
    return {distance, offset / distance};
  }

  ConvexSet base_;
  double length_;
  std::shared_ptr<const Shape> whole_;
};

}  // namespace

Extrusion::Extrusion(std::vector<Vector2d> outline, double length) : Extrusion(Outline(std::move(outline)), length) {}

Extrusion::Extrusion(Outline outline, double length)
    : Shape(farthestCorner(outline, length), outline.isConvex()),
      outline_(std::move(outline)),
      length_(length),
      middle_(outline_.centroid()) {
  if (outline_.distance(middle_).distance > 0) middle_ = outline_.corners().front();
}

SignedDistance Extrusion::doDistance(const Vector3d& p) const {
  const PlanarDistance side = outline_.distance(p.head<2>());
  const double beyond_end = std::abs(p.z()) - 0.5 * length_;
  const double axial = std::copysign(1.0, p.z());
  if (side.distance > 0 && beyond_end > 0) {                       // nearest to the rim
    const double length = std::sqrt(side.distance * side.distance + beyond_end * beyond_end);
    const Vector2d sideways = side.distance / length * side.gradient;
    return {length, {sideways.x(), sideways.y(), beyond_end / length * axial}};
  }
  if (side.distance > beyond_end) return {side.distance, {side.gradient.x(), side.gradient.y(), 0}};
  return {beyond_end, {0, 0, axial}};
}

std::optional<Vector3d> Extrusion::doSupport(const Vector3d& n) const {
  const double z = std::abs(n.z()) < level ? 0 : std::copysign(0.5 * length_, n.z());
  Vector2d farthest = middle_;
  if (n.head<2>().norm() > level) {
    const auto& corners = outline_.corners();
    farthest = *std::max_element(corners.begin(), corners.end(), [&](const Vector2d& a, const Vector2d& b) {
      return a.dot(n.head<2>()) < b.dot(n.head<2>());
    });
  }
  return Vector3d(farthest.x(), farthest.y(), z);
}

std::vector<Piece> Extrusion::doPieces() const {
  if (isConvex()) return {};
  const auto whole = std::make_shared<Extrusion>(*this);
  const ConvexParts parts = convexParts(outline_.corners());
  std::vector<Piece> pieces;
  for (const ConvexSet& part : parts.parts) pieces.push_back({std::make_shared<Prism>(part, length_, whole)});
  for (const auto& [diagonal, between] : parts.cuts)
    pieces.push_back({std::make_shared<Prism>(diagonal, length_, whole), -1, between});
  return pieces;
}

TriangleMesh Extrusion::doSurface() const {
  TriangleMesh mesh;
  const auto corner = [&](const Vector2d& p, double side) {
    mesh.vertices.emplace_back(p.x(), p.y(), 0.5 * side * length_);
    return static_cast<int>(mesh.vertices.size()) - 1;
  };
  const std::vector<Vector2d>& corners = outline_.corners();
  for (size_t i = 0; i < corners.size(); ++i) {
    const Vector2d &here = corners[i], &next = corners[(i + 1) % corners.size()];
    const int a = corner(here, -1), b = corner(next, -1), c = corner(next, 1), d = corner(here, 1);
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  for (const ConvexSet& part : convexParts(corners).parts)
    for (size_t i = 1; i + 1 < part.corners().size(); ++i)
      for (const double side : {-1.0, 1.0}) {
        const int a = corner(part.corners()[0], side), b = corner(part.corners()[i], side),
                  c = corner(part.corners()[i + 1], side);
        mesh.triangles.push_back(side > 0 ? std::array{a, b, c} : std::array{a, c, b});
      }
  return welded(mesh);
}

}  // namespace tactus::geometry
