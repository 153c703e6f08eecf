#include "sim/link_features.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tactus::sim {
namespace {

void addFeatures(const description::CapsuleShape& capsule, int link, std::vector<LinkFeature>& features) {
  features.push_back({link, link, capsule.from, capsule.to, capsule.radius});
}

void addFeatures(const description::BoxShape& box, int link, std::vector<LinkFeature>& features) {
  std::array<int, 3> edges = {0, 1, 2};                            // axes from the shortest edge to the longest
  std::stable_sort(edges.begin(), edges.end(), [&](int a, int b) { return box.size[a] < box.size[b]; });
  const double radius = 0.5 * box.size[edges[0]];
  const Eigen::Vector3d across = Eigen::Vector3d::Unit(edges[1]) * (0.5 * box.size[edges[1]] - radius);
  const Eigen::Vector3d along = Eigen::Vector3d::Unit(edges[2]) * (0.5 * box.size[edges[2]] - radius);
  const int gaps = static_cast<int>(std::ceil(2 * across.norm() / radius));
  for (int i = 0; i <= gaps; ++i) {
    const Eigen::Vector3d middle = gaps > 0 ? Eigen::Vector3d((2.0 * i / gaps - 1) * across) : Eigen::Vector3d::Zero();
    features.push_back({link, link, box.pose * (middle - along), box.pose * (middle + along), radius});
  }
}

}  // namespace

std::vector<LinkFeature> linkFeatures(const description::Robot& robot) {
  std::vector<LinkFeature> features;
  for (int link = 0; link < static_cast<int>(robot.links.size()); ++link)
    for (const description::LinkShape& shape : robot.links[link].shapes)
      std::visit([&](const auto& s) { addFeatures(s, link, features); }, shape);
  return features;
}

}  // namespace tactus::sim
