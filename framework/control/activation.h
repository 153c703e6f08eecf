#pragma once

#include <limits>

#include "framework/control/archive.h"

namespace tactus::control {

/// When a task or a level takes part: while all of these hold.
struct ActiveWhen {
  bool active = true;                                              ///< what Controller::setActive changes
  const double* on = nullptr;                                      ///< a signal's scalar port: while it is > 0.5
  double from = -std::numeric_limits<double>::infinity();          ///< s, of the plant's clock; included
  double until = std::numeric_limits<double>::infinity();          ///< s; not included
  double ramp = 0.1;                                               ///< s, in which a switch takes effect
};

/// How far a task or a level takes part, from tick to tick.
///
/// Its *share*, 0 to 1, goes to its goal at the rate 1/ramp and scales the task's forces and accelerations.  The rows
/// themselves cannot fade: a row is held by the levels below or it is not, whatever its length.  They *stand*, whole,
/// from the tick in which the conditions come to hold until these have failed for a whole ramp; the step in the torque
/// that rows make when they come or go is taken up by the transfer of TorqueShaper.
///
/// That the rows linger is the hysteresis: a condition that flickers, every tick if need be, leaves them standing, and
/// they come and go at most once in a ramp.  What is active in the first tick has its whole share from the start.
class Activation {
 public:
  Activation() = default;
  explicit Activation(const ActiveWhen& when) : when_(when) {}

  void setActive(bool active) { when_.active = active; }
  /// Goes on by one tick.  True when rows came or went; never in the first tick.
  bool advance(double time, double dt);

  bool stands() const { return stands_; }
  double share() const { return share_; }
  double ramp() const { return when_.ramp; }
  void archive(Archive& archive);
  /// Conditions besides setActive: its share is worth a column of the log.
  bool isConditional() const;

 private:
  bool holds(double time) const;

  ActiveWhen when_;
  bool started_ = false;
  bool stands_ = true;
  double share_ = 1;
  double off_for_ = 0;                                             // s, since the conditions last held
};

}  // namespace tactus::control
