#pragma once

#include "bench/peers/engine.h"

namespace tactus::bench {

/// What a peer takes as the velocity of a floating base: angular, then linear.
enum class FloatingBase {
  body_axes,                                                       ///< both in the axes of the body
  world_axes                                                       ///< both in the axes of the world
};

/// A peer's speeds u against ours: u = T q̇ and u̇ = T q̈ + drift.
struct Coordinates {
  Eigen::MatrixXd T;
  Eigen::VectorXd drift;

  /// `first_speed[i]` is the index into u of the first speed of body i.
  Coordinates(const Problem& problem, const State& state, const std::vector<int>& first_speed, FloatingBase base);

  /// A peer's results in ours.  Its bias is that of u̇ = 0, ours that of q̈ = 0: M of the peer tells the difference.
  Results toOurs(Operation operation, const Results& peer, const Eigen::MatrixXd& M) const;
};

}  // namespace tactus::bench
