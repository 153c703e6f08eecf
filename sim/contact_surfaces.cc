#include "sim/contact_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "framework/description/link_shape.h"

namespace tactus::sim {
namespace {

using Eigen::Vector3d;

Feature ofLink(int link, const Vector3d& from, const Vector3d& to, double radius) {
  return {{link, -1}, link, {from, to, radius}};
}

void addFeatures(const description::CapsuleShape& capsule, int link, std::vector<Feature>& features) {
  features.push_back(ofLink(link, capsule.from, capsule.to, capsule.radius));
}

void addFeatures(const description::BoxShape& box, int link, std::vector<Feature>& features) {
  std::array<int, 3> edges = {0, 1, 2};                            // axes from the shortest edge to the longest
  std::stable_sort(edges.begin(), edges.end(), [&](int a, int b) { return box.size[a] < box.size[b]; });
  const double radius = 0.5 * box.size[edges[0]];
  const Vector3d across = Vector3d::Unit(edges[1]) * (0.5 * box.size[edges[1]] - radius);
  const Vector3d along = Vector3d::Unit(edges[2]) * (0.5 * box.size[edges[2]] - radius);
  const int gaps = static_cast<int>(std::ceil(2 * across.norm() / radius));
  for (int i = 0; i <= gaps; ++i) {
    const Vector3d middle = gaps > 0 ? Vector3d((2.0 * i / gaps - 1) * across) : Vector3d::Zero();
    features.push_back(ofLink(link, box.pose * (middle - along), box.pose * (middle + along), radius));
  }
}

}  // namespace

std::vector<Feature> linkFeatures(const description::Robot& robot) {
  std::vector<Feature> features;
  for (int link = 0; link < static_cast<int>(robot.links.size()); ++link)
    for (const description::LinkShape& shape : robot.links[link].shapes)
      std::visit([&](const auto& s) { addFeatures(s, link, features); }, shape);
  return features;
}

std::vector<Collider> linkColliders(const description::Robot& robot) {
  std::vector<Collider> colliders;
  for (int link = 0; link < static_cast<int>(robot.links.size()); ++link)
    for (const description::LinkShape& shape : robot.links[link].shapes) {
      const geometry::PosedShape solid = description::solidOf(shape);
      colliders.push_back({{link, -1}, link, solid.shape, solid.pose});
    }
  return colliders;
}

std::vector<Feature> objectFeatures(const description::Object& object, int index) {
  std::vector<Feature> features;
  for (const description::Primitive& primitive : object.primitives)
    for (geometry::Feeler feeler : primitive.shape->feelers()) {
      feeler.from = primitive.pose * feeler.from;
      feeler.to = primitive.pose * feeler.to;
      features.push_back({{-1, index}, world_body, feeler});
    }
  return features;
}

std::vector<Collider> objectColliders(const description::Object& object, int index) {
  std::vector<Collider> colliders;
  for (const description::Primitive& primitive : object.primitives)
    colliders.push_back({{-1, index}, world_body, primitive.shape, primitive.pose});
  return colliders;
}

}  // namespace tactus::sim
