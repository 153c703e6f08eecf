#include "framework/geometry/compound.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "framework/geometry/surface.h"

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

double boundingRadius(const std::vector<PosedShape>& parts) {
  if (parts.empty()) throw std::invalid_argument("a union has one part or more");
  double farthest = 0;
  for (const PosedShape& part : parts)
    farthest = std::max(farthest, part.pose.translation().norm() + part.shape->boundingRadius());
  return farthest;
}

double worstError(const std::vector<PosedShape>& parts) {
  double worst = 0;
  for (const PosedShape& part : parts) worst = std::max(worst, part.shape->error());
  return worst;
}

}  // namespace

Compound::Compound(std::vector<PosedShape> parts)
    : Shape(geometry::boundingRadius(parts), parts.size() == 1 && parts.front().shape->isConvex(), worstError(parts)) {
  for (PosedShape& part : parts)
    parts_.push_back({part.shape, part.pose.linear(), part.pose.translation(), part.shape->boundingRadius()});
}

SignedDistance Compound::doDistance(const Vector3d& p) const {
  SignedDistance nearest{std::numeric_limits<double>::infinity()};
  const Part* owner = nullptr;
  for (const Part& part : parts_) {
    const Vector3d offset = p - part.p;
    const double reach = nearest.distance + part.bounding_radius;  // no nearer than |offset| − bounding radius
    if (owner && (reach <= 0 || offset.squaredNorm() >= reach * reach)) continue;
    const SignedDistance own = part.shape->distance(part.R.transpose() * offset);
    if (owner && own.distance >= nearest.distance) continue;
    nearest = own;
    owner = &part;
  }
  nearest.gradient = owner->R * nearest.gradient;
  return nearest;
}

std::optional<Vector3d> Compound::doSupport(const Vector3d& n) const {
  std::optional<Vector3d> farthest;
  for (const Part& part : parts_) {
    const std::optional<Vector3d> own = part.shape->support(part.R.transpose() * n);
    if (!own) return std::nullopt;
    const Vector3d point = part.R * *own + part.p;
    if (!farthest || point.dot(n) > farthest->dot(n)) farthest = point;
  }
  return farthest;
}

TriangleMesh Compound::doSurface() const {
  std::vector<PosedShape> posed;
  for (const Part& part : parts_) {
    posed.push_back({part.shape});
    posed.back().pose.linear() = part.R;
    posed.back().pose.translation() = part.p;
  }
  return surfaceOf(posed);
}

}  // namespace tactus::geometry
