#pragma once

#include <vector>

#include "framework/description/faults.h"
#include "framework/description/scene.h"

namespace tactus::sim {

/// Turns mass m, centre of mass c and inertia I (about c) of links, or of an object that forces move, into
///
///   m' = f m + a,   c' = (f m c + a p) / m',   I' = f I + (f m a / m') (d² 1 − d dᵀ),   d = p − c
///
/// with `factor` f, and a point mass `added` a at `point` p.
void makeWrong(const description::WrongMass& fault, description::Robot& robot, description::Scene& scene);

/// Which of the faults hold from a time on.
struct MassPeriod {
  double from = 0;                                                 ///< s
  std::vector<bool> holds;                                         ///< by fault
};

/// From the first, at −∞, on: a new one begins whenever a fault begins or ends.
std::vector<MassPeriod> massPeriods(const std::vector<description::WrongMass>& faults);

}  // namespace tactus::sim
