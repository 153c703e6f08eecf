#include "framework/geometry/uniform_body.h"

#include <algorithm>

namespace tactus::geometry {

UniformBody uniformBody(const std::function<double(const Eigen::Vector3d&)>& distance, const Eigen::Vector3d& middle,
                        double radius) {
  constexpr int cells = 64;
  const double length = 2 * radius / cells;
  double share = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        const Eigen::Vector3d p = length * Eigen::Vector3d(i + 0.5, j + 0.5, k + 0.5) - Eigen::Vector3d::Constant(radius);
        const double inside = std::clamp(0.5 - distance(middle + p) / length, 0.0, 1.0);
        if (inside == 0) continue;
        share += inside;
        first += inside * p;
        second += inside * p * p.transpose();
      }
  UniformBody body;
  if (share == 0) return body;
  const double cell = length * length * length;
  body.volume = cell * share;
  const Eigen::Vector3d centre = first / share;
  body.centre = middle + centre;
  const Eigen::Matrix3d about_centre = second - share * centre * centre.transpose();
  body.inertia = cell * (about_centre.trace() * Eigen::Matrix3d::Identity() - about_centre);
  return body;
}

}  // namespace tactus::geometry
