#include "dsl/stack.h"

#include <algorithm>

namespace tactus::dsl {
namespace {

/// SplitMix64 (Steele, Lea, Flood 2014): the same draws with every standard library.
class SplitMix64 {
 public:
  explicit SplitMix64(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  /// Uniform in [-1, 1), 53 bits.
  double symmetric() { return static_cast<double>(next() >> 11) * 0x1p-52 - 1; }

 private:
  std::uint64_t state_;
};

/// FNV-1a: an object's draws depend on its name, not on what else is in the scene.
std::uint64_t hash(const std::string& name) {
  std::uint64_t value = 0xCBF29CE484222325u;
  for (char c : name) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return value;
}

Eigen::Vector3d draw(const ObjectDescription& object, std::uint64_t seed) {
  SplitMix64 seeds(seed);
  SplitMix64 random(seeds.next() ^ hash(object.object.name));
  Eigen::Vector3d shift;
  for (int i = 0; i < 3; ++i) shift[i] = object.jitter[i] * random.symmetric();
  return shift;
}

}  // namespace

description::Scene Stack::scene(std::uint64_t seed) const {
  description::Scene scene;
  scene.gravity = gravity;
  for (const ObjectDescription& described : objects) {
    description::Object object = described.object;
    const ObjectDescription* mover = &described;
    for (std::size_t i = 0; seed != 0 && mover && i < objects.size(); ++i) {
      object.pose.translation() += draw(*mover, seed);
      const auto carrier = std::find_if(objects.begin(), objects.end(),
                                        [&](const auto& other) { return other.object.name == mover->on; });
      mover = mover->on.empty() || carrier == objects.end() ? nullptr : &*carrier;
    }
    scene.objects.push_back(std::move(object));
  }
  return scene;
}

}  // namespace tactus::dsl
