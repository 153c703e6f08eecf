#include "framework/geometry/torus.h"

#include <cmath>
#include <numbers>

#include "framework/geometry/lengths.h"
#include "framework/geometry/surface.h"

namespace tactus::geometry {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double level = 1e-9;                                     ///< shorter in the plane, a direction has none

constexpr double turn = 2 * std::numbers::pi;
constexpr double rounding = 1e-3;                                  ///< of a turn: 6.28 and 6.29 are meant as one

bool isRing(double angle) { return angle >= turn * (1 - rounding); }

double boundingRadius(double radius, double tube_radius, double angle) {
  positive("the radius of a torus", radius);
  positive("the tube radius of a torus", tube_radius);
  positive("the angle of a torus", angle);
  if (angle > turn * (1 + rounding)) throw std::invalid_argument("the angle of a torus is at most 2π");
  if (tube_radius > radius) throw std::invalid_argument("the tube of a torus is no thicker than its circle");
  const bool bends_back = angle > std::numbers::pi && !isRing(angle);
  if (bends_back && radius * std::sin(0.5 * angle) < tube_radius)
    throw std::invalid_argument("the two ends of a torus keep clear of each other, or the angle is 2π");
  return radius + tube_radius;
}

/// The side of a ring that lies across the axis from a point.
class FarSide final : public Shape {
 public:
  explicit FarSide(std::shared_ptr<const Torus> ring) : Shape(ring->boundingRadius(), false), ring_(std::move(ring)) {}

 private:
  SignedDistance doDistance(const Vector3d& p) const override {
    const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const Vector3d outwards = rho > 0 ? Vector3d(-p.x() / rho, -p.y() / rho, 0) : Vector3d(-1, 0, 0);
    const Vector3d offset = p - ring_->radius() * outwards;
    const double length = offset.norm();
    if (length <= ring_->tubeRadius()) return ring_->distance(p);
    return {length - ring_->tubeRadius(), offset / length};
  }

  std::shared_ptr<const Torus> ring_;
};

}  // namespace

Torus::Torus(double radius, double tube_radius, double angle)
    : Shape(geometry::boundingRadius(radius, tube_radius, angle), false),
      radius_(radius),
      tube_radius_(tube_radius),
      angle_(angle),
      end_(isRing(angle) ? Vector2d(-1, 0) : Vector2d(std::cos(0.5 * angle), std::sin(0.5 * angle))) {}

Vector3d Torus::onArc(double x, double y) const {
  const double length = std::sqrt(x * x + y * y);
  if (length == 0) return {radius_, 0, 0};
  if (x >= end_.x() * length) return {radius_ * x / length, radius_ * y / length, 0};
  return {radius_ * end_.x(), (y < 0 ? -radius_ : radius_) * end_.y(), 0};
}

SignedDistance Torus::doDistance(const Vector3d& p) const {
  const Vector3d offset = p - onArc(p.x(), p.y());
  const double length = offset.norm();
  if (length == 0) return {-tube_radius_, Vector3d::UnitZ()};
  return {length - tube_radius_, offset / length};
}

std::optional<Vector3d> Torus::doSupport(const Vector3d& n) const {
  const bool flat = n.head<2>().norm() < level;
  return Vector3d(onArc(flat ? 1 : n.x(), flat ? 0 : n.y()) + tube_radius_ * n);
}

std::vector<Piece> Torus::doPieces() const {
  if (!isRing(angle_)) return {};
  const auto ring = std::make_shared<Torus>(*this);
  return {{ring}, {std::make_shared<FarSide>(ring)}};
}

TriangleMesh Torus::doSurface() const {
  if (!isRing(angle_)) return surfaceNets(*this, 2 * steps_a_turn);
  std::vector<Eigen::Vector2d> tube = arc({radius_, 0}, tube_radius_, 0, turn);
  tube.pop_back();
  return lathe(tube);
}

}  // namespace tactus::geometry
