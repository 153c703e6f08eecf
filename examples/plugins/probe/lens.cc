#include "lens.h"

#include <cmath>

namespace probe {

using namespace tactus::control;
using tactus::geometry::SignedDistance;

void Lens::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "probe.lens";
  row.description = "A lens: what two equal balls have in common, its rim in the plane z = 0.";
  row.attributes = {
      {.name = "radius", .type = ValueType::real, .unit = "m", .required = true, .description = "Of its rim.",
       .lower = 0, .lower_open = true},
      {.name = "thickness", .type = ValueType::real, .unit = "m", .required = true,
       .description = "In its middle, at most the diameter of the rim.", .lower = 0, .lower_open = true},
  };
  registry.addShape(row, [](const ElementValues& values) {
    const double radius = values.real("radius"), thickness = values.real("thickness");
    if (thickness > 2 * radius) throw ElementError("thickness", "a lens is at most as thick as its rim is wide");
    return std::make_shared<Lens>(radius, thickness);
  });
}

Lens::Lens(double radius, double thickness)
    : Shape(radius, true),
      rim_(radius),
      ball_((radius * radius + thickness * thickness / 4) / thickness),
      centre_(ball_ - thickness / 2) {
  if (thickness > 2 * radius) throw std::invalid_argument("a lens is at most as thick as its rim is wide");
}

SignedDistance Lens::doDistance(const Eigen::Vector3d& p) const {
  const double side = std::copysign(1.0, p.z());
  const Eigen::Vector3d from_centre(p.x(), p.y(), side * p.z() + centre_);
  const double length = from_centre.norm();
  SignedDistance nearest{-ball_, Eigen::Vector3d::UnitZ()};
  if (length > 0 && ball_ * from_centre.z() / length >= centre_) {
    nearest = {length - ball_, from_centre / length};
  } else if (length > 0) {
    const double rho = std::hypot(p.x(), p.y());
    const Eigen::Vector3d rim(rim_ * p.x() / rho, rim_ * p.y() / rho, 0);
    const Eigen::Vector3d offset = Eigen::Vector3d(p.x(), p.y(), side * p.z()) - rim;
    nearest.distance = offset.norm();
    nearest.gradient = nearest.distance > 0 ? Eigen::Vector3d(offset / nearest.distance) : Eigen::Vector3d(rim / rim_);
  }
  nearest.gradient.z() *= side;
  return nearest;
}

}  // namespace probe
