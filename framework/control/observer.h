#pragma once

#include <span>

#include "framework/control/controller.h"

namespace tactus::control {

/// One tick as it happened: what was sensed, what the controller answered.
struct ObservedTick {
  const Sensed& truth;                                             ///< the plant's; `sensed` itself without sensors
  const Sensed& sensed;
  const Controller& controller;
  const Eigen::VectorXd& torque;                                   ///< N m, b + g included, held until the next tick
  double tick_us;                                                  ///< wall-clock time of Controller::tick alone
  std::span<const ObjectMotion> objects = {};                      ///< of the scene, in its order
};

/// A tick that threw, with which the run ends.
struct BrokenTick {
  const Sensed& sensed;
  const Controller& controller;
  const TickError& error;
};

/// Looks at every tick of a run and changes nothing.
class Observer {
 public:
  virtual ~Observer() = default;
  /// Just before a tick, after all that was switched since the last one.
  virtual void before(const Controller&) {}
  virtual void observe(const ObservedTick& tick) = 0;
  /// Instead of `observe`.
  virtual void broken(const BrokenTick&) {}
  /// After the last tick, however the run ended: write what is left.
  virtual void close() {}
};

}  // namespace tactus::control
