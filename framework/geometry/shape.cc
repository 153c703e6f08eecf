#include "framework/geometry/shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "framework/geometry/surface.h"

namespace tactus::geometry {

Shape::Shape(double bounding_radius, bool convex, double error)
    : bounding_radius_(bounding_radius), convex_(convex), error_(error) {
  if (!(bounding_radius > 0)) throw std::invalid_argument("the bounding radius of a shape is > 0");
  if (!(error >= 0) || !std::isfinite(error)) throw std::invalid_argument("the error of a shape is finite and ≥ 0");
}

std::optional<Eigen::Vector3d> Shape::doSupport(const Eigen::Vector3d& n) const {
  if (std::isinf(bounding_radius_)) return std::nullopt;
  constexpr double far = 1e7;  // bias R²/2far R and cancellation far·2⁻⁵³ are alike there
  const Eigen::Vector3d p = far * bounding_radius_ * n;
  const SignedDistance nearest = distance(p);
  return p - nearest.distance * nearest.gradient;
}

std::vector<Feeler> Shape::doFeelers() const {
  constexpr int count = 120;
  std::vector<Feeler> feelers;
  if (std::isinf(bounding_radius_)) return feelers;
  for (int i = 0; i < count; ++i) {                                // Fibonacci's spiral
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0));
    const double z = 1 - (2 * i + 1.0) / count, rho = std::sqrt(1 - z * z);
    const Eigen::Vector3d n(rho * std::cos(i * turn), rho * std::sin(i * turn), z);
    const SignedDistance nearest = distance(bounding_radius_ * n);
    const Eigen::Vector3d point =
        convex_ ? *support(n) : Eigen::Vector3d(bounding_radius_ * n - nearest.distance * nearest.gradient);
    const bool is_new = std::none_of(feelers.begin(), feelers.end(), [&](const Feeler& other) {
      return (other.from - point).norm() < 1e-3 * bounding_radius_;
    });
    if (is_new) feelers.push_back({point, point});
  }
  // A corner bears alone; where a round side lies, some of many do.
  constexpr std::size_t corners = 24;
  if (feelers.size() > corners)
    for (Feeler& feeler : feelers) feeler.share = 0.5;
  return feelers;
}

std::vector<Piece> Shape::doPieces() const { return {}; }

TriangleMesh Shape::doSurface() const { return std::isinf(bounding_radius_) ? TriangleMesh{} : surfaceNets(*this); }

}  // namespace tactus::geometry
