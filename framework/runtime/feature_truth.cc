#include "framework/runtime/feature_truth.h"

#include <cmath>

namespace tactus::runtime {

using Eigen::Vector3d;

std::optional<Vector3d> highestPoint(const description::Object& object) {
  std::optional<Vector3d> highest;
  for (const description::Primitive& primitive : object.primitives) {
    const Eigen::Isometry3d X_WP = object.pose * primitive.pose;
    const Vector3d up = X_WP.linear().transpose() * Vector3d::UnitZ();
    const std::optional<Vector3d> point = primitive.shape->support(up);
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
