#include "framework/runtime/feature_truth.h"

#include <cmath>
#include <variant>

namespace tactus::runtime {
namespace {

using Eigen::Vector3d;

/// Components of the up direction smaller than this are taken as level: the whole edge or face is highest.
constexpr double level = 1e-9;

/// Sign of a component of the up direction, 0 where it is level.
double side(double component) { return std::abs(component) < level ? 0 : std::copysign(1.0, component); }

/// Support points in the direction `up` (unit, primitive frame): the point that lies farthest along it.
struct Support {
  Vector3d up;

  std::optional<Vector3d> operator()(const description::PlanePrimitive&) const { return std::nullopt; }
  std::optional<Vector3d> operator()(const description::BoxPrimitive& box) const {
    return Vector3d(up.unaryExpr(&side).cwiseProduct(box.size / 2));
  }
  std::optional<Vector3d> operator()(const description::SpherePrimitive& sphere) const {
    return Vector3d(sphere.radius * up);
  }
  std::optional<Vector3d> operator()(const description::CylinderPrimitive& cylinder) const {
    Vector3d point(0, 0, side(up.z()) * cylinder.length / 2);
    const double radial = up.head<2>().norm();
    if (radial > level) point.head<2>() = cylinder.radius / radial * up.head<2>();
    return point;
  }
  std::optional<Vector3d> operator()(const description::CapsulePrimitive& capsule) const {
    return Vector3d(Vector3d(0, 0, side(up.z()) * capsule.length / 2) + capsule.radius * up);
  }
};

}  // namespace

std::optional<Vector3d> highestPoint(const description::Object& object) {
  std::optional<Vector3d> highest;
  for (const description::Primitive& primitive : object.primitives) {
    const Eigen::Isometry3d X_WP = object.pose * primitive.pose;
    const Vector3d up = X_WP.linear().transpose() * Vector3d::UnitZ();
    const std::optional<Vector3d> point = std::visit(Support{up}, primitive.shape);
    if (!point) continue;
    const Vector3d point_W = X_WP * *point;
    if (!highest || point_W.z() > highest->z()) highest = point_W;
  }
  return highest;
}

std::vector<control::Metric> featureMetrics(const std::string& name, const control::FeatureEstimate& estimate,
                                            const std::optional<Vector3d>& truth) {
  std::vector<control::Metric> metrics{{name + "_found", estimate.found ? 1.0 : 0.0}};
  if (!estimate.found || !truth) return metrics;
  const Vector3d error = estimate.position_W - *truth;
  metrics.push_back({name + "_position_error_m", error.head<2>().norm()});
  metrics.push_back({name + "_height_error_m", std::abs(error.z())});
  return metrics;
}

}  // namespace tactus::runtime
