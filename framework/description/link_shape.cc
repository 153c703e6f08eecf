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

}  // namespace tactus::description
