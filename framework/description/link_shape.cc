#include "framework/description/link_shape.h"

#include "framework/geometry/primitives.h"

namespace tactus::description {
namespace {

geometry::PosedShape solidOf(const CapsuleShape& capsule) {
  const Eigen::Vector3d along = capsule.to - capsule.from;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = 0.5 * (capsule.from + capsule.to);
  const double length = along.norm();
  if (length == 0) return {std::make_shared<geometry::Sphere>(capsule.radius), pose};
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), along).toRotationMatrix();
  return {std::make_shared<geometry::Capsule>(capsule.radius, length), pose};
}

geometry::PosedShape solidOf(const BoxShape& box) { return {std::make_shared<geometry::Box>(box.size), box.pose}; }

}  // namespace

geometry::PosedShape solidOf(const LinkShape& shape) {
  return std::visit([](const auto& one) { return solidOf(one); }, shape);
}

Eigen::Vector3d middleOf(const Link& link) {
  if (link.shapes.empty()) return link.centre_of_mass;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const LinkShape& shape : link.shapes) sum += solidOf(shape).pose.translation();
  return sum / static_cast<double>(link.shapes.size());
}

}  // namespace tactus::description
