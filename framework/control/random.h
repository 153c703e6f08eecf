#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace tactus::control {

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
  /// Uniform in [−1, 1), 53 bits.
  double symmetric() { return static_cast<double>(next() >> 11) * 0x1p-52 - 1; }
  /// Uniform in [0, 1), 53 bits.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  /// Normal, mean 0, deviation 1 (Box and Muller 1958); takes two draws.
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }

  std::uint64_t state() const { return state_; }
  template <class Archive>
  void archive(Archive& archive) {
    archive("state", state_);
  }

 private:
  std::uint64_t state_;
};

/// The seed of one part of a run, of its name (FNV-1a): its draws do not depend on what else there is.
inline std::uint64_t seedOf(std::uint64_t run_seed, std::string_view name) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return SplitMix64(run_seed).next() ^ hash;
}

}  // namespace tactus::control
