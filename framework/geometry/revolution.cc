#include "framework/geometry/revolution.h"

#include <algorithm>
#include <cmath>

#include "framework/geometry/convex_parts.h"
#include "framework/geometry/surface.h"

namespace tactus::geometry {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

constexpr double level = 1e-9;                                     ///< directions this near to the axis are taken as it

double farthestCorner(const Outline& outline) {
  double farthest = 0;
  for (const Vector2d& corner : outline.corners()) farthest = std::max(farthest, corner.norm());
  return farthest;
}

/// How a set of the half plane ρ ≥ 0 is swept: as a whole, where the section with its mirror image is convex; or a side
/// of it, in the plane through the axis and the point.
enum class Sweep { whole, near_side, far_side };

class Swept final : public Shape {
 public:
  Swept(ConvexSet section, Sweep sweep, std::shared_ptr<const Shape> solid)
      : Shape(solid->boundingRadius(), sweep == Sweep::whole),
        section_(std::move(section)),
        side_(sweep == Sweep::far_side ? -1 : 1),
        solid_(std::move(solid)) {}

 private:
  SignedDistance doDistance(const Vector3d& p) const override {
    const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
    const Vector2d offset = section_.offset({side_ * rho, p.z()});
    const double distance = offset.norm();
    if (distance == 0) return solid_->distance(p);
    const Vector2d radial = rho > 0 ? Vector2d(side_ / rho * p.head<2>()) : Vector2d(side_, 0);
    return {distance, {offset.x() / distance * radial.x(), offset.x() / distance * radial.y(), offset.y() / distance}};
  }

  ConvexSet section_;
  double side_;                                                    // 1, or −1: across the axis
  std::shared_ptr<const Shape> solid_;
};

/// Whether the set and its mirror image make up a convex one.
bool isConvexWithImage(const ConvexSet& set) {
  const auto& corners = set.corners();
  if (corners.size() > 2) return Outline::rightHalf(corners).isConvex();
  const double across = std::min(corners.front().x(), corners.back().x());
  return across == 0 && (corners.front().y() == corners.back().y() || corners.front().x() == corners.back().x());
}

/// What a set has on the axis: a segment or a point.
std::vector<Vector2d> onAxis(const ConvexSet& set) {
  std::vector<Vector2d> found;
  for (const Vector2d& corner : set.corners())
    if (corner.x() == 0) found.push_back(corner);
  return found;
}

}  // namespace

Revolution::Revolution(std::vector<Vector2d> profile) : Revolution(Outline::rightHalf(std::move(profile))) {}

Revolution::Revolution(Outline profile)
    : Shape(farthestCorner(profile), profile.isConvex()), profile_(std::move(profile)) {}

SignedDistance Revolution::doDistance(const Vector3d& p) const {
  const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const PlanarDistance nearest = profile_.distance({rho, p.z()});
  const Vector2d radial = rho > 0 ? Vector2d(p.head<2>() / rho) : Vector2d::UnitX();
  return {nearest.distance,
          {nearest.gradient.x() * radial.x(), nearest.gradient.x() * radial.y(), nearest.gradient.y()}};
}

std::optional<Vector3d> Revolution::doSupport(const Vector3d& n) const {
  const double sideways = n.head<2>().norm();
  const Vector2d in_plane(sideways > level ? sideways : 0, n.z());
  const Vector2d* farthest = nullptr;
  for (const Vector2d& corner : profile_.corners()) {
    const double ahead = farthest ? (corner - *farthest).dot(in_plane) : 1;
    if (ahead > 0 || (ahead == 0 && corner.x() < farthest->x())) farthest = &corner;
  }
  const Vector2d radial = sideways > level ? Vector2d(n.head<2>() / sideways) : Vector2d::UnitX();
  return Vector3d(farthest->x() * radial.x(), farthest->x() * radial.y(), farthest->y());
}

std::vector<Piece> Revolution::doPieces() const {
  if (isConvex()) return {};
  const auto solid = std::make_shared<Revolution>(*this);
  const ConvexParts parts = convexParts(profile_.corners());
  std::vector<Piece> pieces;
  /// Returns the numbers of its near and its far side.
  const auto add = [&](const ConvexSet& set, int sign, std::array<int, 2> near, std::array<int, 2> far) {
    const auto number = [&] { return static_cast<int>(pieces.size()) - 1; };
    if (isConvexWithImage(set)) {
      pieces.push_back({std::make_shared<Swept>(set, Sweep::whole, solid), sign, near});
      return std::array<int, 2>{number(), number()};
    }
    pieces.push_back({std::make_shared<Swept>(set, Sweep::near_side, solid), sign, near});
    const int near_side = number();
    pieces.push_back({std::make_shared<Swept>(set, Sweep::far_side, solid), sign, far});
    const int far_side = number();
    if (const std::vector<Vector2d> common = onAxis(set); !common.empty())
      pieces.push_back({std::make_shared<Swept>(ConvexSet(common), Sweep::whole, solid), -sign, {near_side, far_side}});
    return std::array<int, 2>{near_side, far_side};
  };
  std::vector<std::array<int, 2>> sides;                           // by part
  for (const ConvexSet& part : parts.parts) sides.push_back(add(part, 1, {-1, -1}, {-1, -1}));
  for (const auto& [diagonal, between] : parts.cuts) {
    const auto &one = sides[between[0]], &other = sides[between[1]];
    add(diagonal, -1, {one[0], other[0]}, {one[1], other[1]});
  }
  return pieces;
}

TriangleMesh Revolution::doSurface() const { return lathe(profile_.corners()); }

}  // namespace tactus::geometry
