#pragma once

#include <atomic>
#include <exception>
#include <string>
#include <vector>

#include "framework/control/observer.h"
#include "framework/runtime/plant.h"

namespace tactus::runtime {

enum class Ending {
  done,
  interrupted,                                                     ///< the stop flag was raised
  plant_error,                                                     ///< the plant gave up; `message` says why
  tick_error,                                                      ///< a task, signal, controller or back end failed
  part_error,                                                      ///< a sensor or a recorder failed
  file_error                                                       ///< an observer could not write
};

struct LoopResult {
  Ending ending = Ending::done;
  std::string message;
  long ticks = 0;
  double simulated = 0;                                            ///< s
  double wall_clock = 0;                                           ///< s, observers included
  std::exception_ptr error;                                        ///< PlantError, TickError, PartError, FileError
  double realtimeFactor() const { return wall_clock > 0 ? simulated / wall_clock : 0; }
};

/// Controller and plant in turn, at the controller's period, for `duration` seconds or until `stop` is raised:
/// sense, tick, observers in their order, advance.  What observers throw besides PartError and FileError goes through.  The tick that
/// throws reaches them as `broken`.
LoopResult runLoop(Plant& plant, control::Controller& controller, double duration,
                   const std::vector<control::Observer*>& observers, const std::atomic<bool>& stop);

}  // namespace tactus::runtime
