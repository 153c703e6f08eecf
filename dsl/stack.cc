#include "dsl/stack.h"

#include <algorithm>

#include "framework/control/random.h"

namespace tactus::dsl {
namespace {

Eigen::Vector3d draw(const ObjectDescription& object, std::uint64_t seed) {
  control::SplitMix64 random(control::seedOf(seed, object.object.name));
  Eigen::Vector3d shift;
  for (int i = 0; i < 3; ++i) shift[i] = object.jitter[i] * random.symmetric();
  return shift;
}

}  // namespace

std::vector<const ElementInstance*> Stack::sources() const {
  std::vector<const ElementInstance*> found;
  for (const ElementInstance& sensor : sensors) found.push_back(&sensor);
  for (const ElementInstance& signal : signals) found.push_back(&signal);
  return found;
}

const ElementInstance* Stack::source(std::string_view name) const {
  for (const ElementInstance* source : sources())
    if (source->name == name) return source;
  return nullptr;
}

description::Scene Stack::scene(std::uint64_t seed) const {
  description::Scene scene;
  scene.gravity = gravity;
  for (const ObjectDescription& described : objects) {
    description::Object object = described.object;
    const ObjectDescription* mover = &described;
    for (std::size_t i = 0; seed != 0 && mover && i < objects.size(); ++i) {
      const Eigen::Vector3d shift = draw(*mover, seed);
      object.pose.translation() += shift;
      for (description::Waypoint& waypoint : object.path) waypoint.pose.translation() += shift;
      const auto carrier = std::find_if(objects.begin(), objects.end(),
                                        [&](const auto& other) { return other.object.name == mover->on; });
      mover = mover->on.empty() || carrier == objects.end() ? nullptr : &*carrier;
    }
    scene.objects.push_back(std::move(object));
  }
  constexpr int closest = 4;
  for (int closeness = 0; closeness <= closest; ++closeness)
    for (const PairDescription& described : pairs)
      if (described.closeness == closeness)
        scene.pairs.insert(scene.pairs.end(), described.pairs.begin(), described.pairs.end());
  return scene;
}

}  // namespace tactus::dsl
