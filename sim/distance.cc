#include "sim/distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::sim {
namespace {

/// Distance to a sphere about the origin, with a fixed answer at its centre.
SignedDistance fromCentre(const Eigen::Vector3d& offset, double radius, const Eigen::Vector3d& normal_at_centre) {
  const double length = offset.norm();
  if (length == 0) return {-radius, normal_at_centre};
  return {length - radius, offset / length};
}

}  // namespace

SignedDistance signedDistance(const description::PlanePrimitive&, const Eigen::Vector3d& p) {
  return {p.z(), Eigen::Vector3d::UnitZ()};
}

SignedDistance signedDistance(const description::BoxPrimitive& box, const Eigen::Vector3d& p) {
  const Eigen::Vector3d beyond = p.cwiseAbs() - 0.5 * box.size;    // per axis: > 0 outside that pair of faces
  const Eigen::Vector3d outside = beyond.cwiseMax(0);
  const double length = outside.norm();
  if (length > 0) {
    Eigen::Vector3d normal = outside / length;
    for (int i = 0; i < 3; ++i) normal[i] = std::copysign(normal[i], p[i]);
    return {length, normal};
  }
  int face = 0;
  const double depth = beyond.maxCoeff(&face);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  normal[face] = std::copysign(1.0, p[face]);
  return {depth, normal};
}

SignedDistance signedDistance(const description::SpherePrimitive& sphere, const Eigen::Vector3d& p) {
  return fromCentre(p, sphere.radius, Eigen::Vector3d::UnitZ());
}

SignedDistance signedDistance(const description::CylinderPrimitive& cylinder, const Eigen::Vector3d& p) {
  const double rho = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const Eigen::Vector3d radial = rho > 0 ? Eigen::Vector3d(p.x() / rho, p.y() / rho, 0) : Eigen::Vector3d::UnitX();
  const Eigen::Vector3d axial(0, 0, std::copysign(1.0, p.z()));
  const double beyond_side = rho - cylinder.radius;
  const double beyond_end = std::abs(p.z()) - 0.5 * cylinder.length;
  if (beyond_side > 0 && beyond_end > 0) {                         // nearest to the rim
    const double length = std::sqrt(beyond_side * beyond_side + beyond_end * beyond_end);
    return {length, (beyond_side * radial + beyond_end * axial) / length};
  }
  if (beyond_side > beyond_end) return {beyond_side, radial};
  return {beyond_end, axial};
}

SignedDistance signedDistance(const description::CapsulePrimitive& capsule, const Eigen::Vector3d& p) {
  const double half = 0.5 * capsule.length;
  const Eigen::Vector3d nearest_on_axis(0, 0, std::clamp(p.z(), -half, half));
  return fromCentre(p - nearest_on_axis, capsule.radius, Eigen::Vector3d::UnitX());
}

SignedDistance signedDistance(const description::PrimitiveShape& shape, const Eigen::Vector3d& p) {
  return std::visit([&p](const auto& primitive) { return signedDistance(primitive, p); }, shape);
}

double boundingRadius(const description::PrimitiveShape& shape) {
  struct Radius {
    double operator()(const description::PlanePrimitive&) const { return std::numeric_limits<double>::infinity(); }
    double operator()(const description::BoxPrimitive& box) const { return 0.5 * box.size.norm(); }
    double operator()(const description::SpherePrimitive& sphere) const { return sphere.radius; }
    double operator()(const description::CylinderPrimitive& c) const { return std::hypot(c.radius, 0.5 * c.length); }
    double operator()(const description::CapsulePrimitive& c) const { return c.radius + 0.5 * c.length; }
  };
  return std::visit(Radius{}, shape);
}

}  // namespace tactus::sim
