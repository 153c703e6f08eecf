#pragma once

#include <atomic>
#include <string>
#include <vector>

#include "framework/runtime/observer.h"
#include "framework/runtime/plant.h"

namespace tactus::runtime {

enum class Ending {
  done,
  interrupted,                                                     ///< the stop flag was raised
  plant_error                                                      ///< the plant gave up; `message` says why
};

struct LoopResult {
  Ending ending = Ending::done;
  std::string message;
  long ticks = 0;
  double simulated = 0;                                            ///< s
  double wall_clock = 0;                                           ///< s, observers included
  double realtimeFactor() const { return wall_clock > 0 ? simulated / wall_clock : 0; }
};

/// Controller and plant in turn, at the controller's period, for `duration` seconds or until `stop` is raised:
/// sense, tick, observers in their order, advance.  What observers throw goes through.
LoopResult runLoop(Plant& plant, control::Controller& controller, double duration,
                   const std::vector<Observer*>& observers, const std::atomic<bool>& stop);

}  // namespace tactus::runtime
