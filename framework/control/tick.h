#pragma once

#include "framework/control/sensed.h"
#include "framework/dynamics/dynamics_cache.h"

namespace tactus::control {

/// What every signal and task may read in a tick.
struct Tick {
  double time = 0;                                                 ///< s
  double dt = 0;                                                   ///< s, control period
  const Sensed& sensed;
  const dynamics::DynamicsCache& robot;
};

/// A number that is written to the log every recorded tick.  `value` lives as long as its owner.
struct LogColumn {
  std::string name;                                                ///< slash-separated, e.g. "error"; the owner's path is put before it
  const double* value = nullptr;
};

/// A point that a task steers for, in the world, for people to see.  `position_W` lives as long as its owner.
struct Mark {
  std::string name;                                                ///< "reference", "target"
  const Eigen::Vector3d* position_W = nullptr;                     ///< m
};

/// A figure of the whole run, told at its end.
struct Metric {
  std::string name;                                                ///< with its unit as suffix: "contact_force_mean_N"
  double value = 0;
};

}  // namespace tactus::control
