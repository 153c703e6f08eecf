#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "framework/control/activation.h"
#include "framework/control/back_end.h"
#include "framework/control/level_controller.h"
#include "framework/control/readings.h"
#include "framework/control/sensing_guard.h"
#include "framework/control/signal.h"
#include "framework/control/task.h"
#include "framework/control/torque_shaper.h"
#include "framework/dynamics/dynamics_cache.h"

namespace tactus::control {

struct NamedSignal {
  std::string name;
  std::unique_ptr<Signal> signal;
  std::vector<std::string> readers = {};                           ///< signals, tasks and controllers with a port of it
  bool switched_off = false;                                       ///< its values stand as they were
};
struct NamedTask {
  std::string name;
  std::unique_ptr<Task> task;
  Activation activation = {};
  bool switched_off = false;                                       ///< by a fault of its own, for good
};
struct NamedController {
  std::string name;                                                ///< "" where a level has none
  std::unique_ptr<LevelController> controller;
  bool switched_off = false;                                       ///< with its tasks
};
struct Level {
  int priority = 1;
  std::optional<double> weight;
  std::vector<NamedTask> tasks;
  Activation activation = {};                                      ///< of all its tasks, besides their own
  NamedController owner = {};                                      ///< of its tasks
};

/// What becomes of a task that throws, breaks its promise, or gives numbers that are none.
enum class OnFault {
  fall_back,                                                       ///< throwing ends the run; numbers make the tick fall back
  switch_off,                                                      ///< it takes no part any more; the rest goes on
  end                                                              ///< both end the run
};

struct ControllerOptions {
  double torque_rate = std::numeric_limits<double>::infinity();    ///< 1/s: of a joint's effort limit
  double ramp = 0.1;                                               ///< s, of setWeight, setPriority, setBackEnd
  double hold = 0.02;                                              ///< s, that last good values stand in
  Deadline deadline = {};                                          ///< of every back end that it is given
  std::optional<int> limits_priority = {};                         ///< TorqueLimits::priority
  OnFault on_fault = OnFault::fall_back;
};

/// A task that was switched off by OnFault::switch_off.  All tasks of a controller go with it, and with a signal all
/// that reads it, directly or through others.
struct SwitchedOff {
  std::string task;
  double time = 0;                                                 ///< s
  std::string reason;
  bool threw = false;                                              ///< else its numbers were none
};

void archive(Archive& archive, SwitchedOff& fault);

/// A task, signal or back end that threw, or broke its promise, in a tick; the message names it and the time.
class TickError : public std::runtime_error {
 public:
  enum class Part { signal, task, controller, back_end };
  /// "task 'hold' failed at t = 0.1 s" and what it said.
  TickError(Part part, const std::string& where, const std::string& reason)
      : std::runtime_error(where + ": " + reason), part(part), reason(reason) {}
  Part part;                                                       ///< back_end: the problem of the tick is whole
  std::string reason;
};

/// Whose torque a tick applied.
enum class TorqueSource {
  solved,                                                          ///< the back end's
  partial,                                                         ///< what the back end had settled when it failed
  held,                                                            ///< that of the last tick that was solved
  gravity                                                          ///< none but that which bears the robot's weight
};

/// What a tick did besides its torque.
struct TickRecord {
  Status status = Status::ok;                                      ///< of the back end; `failed` where it was not asked
  TorqueSource source = TorqueSource::solved;
  bool fallback = false;                                           ///< `source` is not `solved`
  bool late = false;                                               ///< the back end missed its deadline
  bool limited = false;                                            ///< the torque was scaled or cut into its limits
  bool rate_limited = false;                                       ///< the torque was kept from changing faster
  SensingRecord sensing;
  /// The task whose rows made the tick fall back; lives until the next setPriority.
  const std::string* unusable_task = nullptr;
};

/// The compiled stack: signals in dependency order, levels of tasks, one back end.
///
/// A tick: what was sensed is checked (SensingGuard, Readings); dynamics from (q, q̇), signals, the controllers of
/// levels, tasks, tick problem with the limits left after b + g, back end, τ* = task torque + b + g; τ follows τ* within limits and rate (TorqueShaper).
/// Takes no memory after construction (as far as the back end takes none).
///
/// Where the back end does not say `ok`, the tick applies, the first that there is: the finite torque that it left
/// (`partial`: the levels that it settled), unless a task's numbers are at fault; the last solved torque, for up to
/// `hold` seconds (`held`); b + g alone (`gravity`).  Where it is blind, it asks nobody and bears the weight, g alone;
/// where it has never sensed some joint, it gives 0.  The torque goes over to `gravity` and back by a transfer.
///
/// Between two ticks tasks, levels and back ends may be switched.  The torque goes on from where it was; while it
/// does, limits and rate win over the laws of the levels.  The calls take memory and throw std::invalid_argument.
class Controller {
 public:
  Controller(std::shared_ptr<const dynamics::Model> model, std::vector<NamedSignal> signals,
             std::vector<Level> levels, std::unique_ptr<BackEnd> back_end, double period,
             const Eigen::Vector3d& gravity_W, const ControllerOptions& options = {},
             std::unique_ptr<Readings> readings = nullptr);

  /// The torque to hold until the next tick, N m, b + g included, within the actuators' limits, always finite.
  /// Throws TickError.
  const Eigen::VectorXd& tick(const Sensed& sensed);

  /// A task, or a level with all its tasks; takes part while this is on and its conditions hold.
  void setActive(std::string_view task, bool active);
  void setActive(int priority, bool active);
  /// Of a level, > 0; for weighted back ends.
  void setWeight(int priority, double weight);
  /// Moves a task to another one of the levels.
  void setPriority(std::string_view task, int priority);
  /// Refuses one that honours no inequalities where a task is one.
  void setBackEnd(std::unique_ptr<BackEnd> back_end);

  double period() const { return period_; }                        ///< s
  const ControllerOptions& options() const { return options_; }
  const dynamics::Model& model() const { return *model_; }
  const dynamics::DynamicsCache& robot() const { return cache_; }
  const TickProblem& problem() const { return problem_; }
  const TickSolution& solution() const { return solution_; }
  const TickRecord& record() const { return record_; }
  const SensingGuard& sensing() const { return sensing_; }
  BackEnd& backEnd() { return *back_end_; }
  const BackEnd& backEnd() const { return *back_end_; }
  const std::vector<NamedSignal>& signals() const { return signals_; }
  const std::vector<Level>& levels() const { return levels_; }
  const Readings& readings() const { return *readings_; }
  Readings& readings() { return *readings_; }
  const Activation& activationOf(std::string_view task) const;
  /// In the order in which it happened.
  const std::vector<SwitchedOff>& switchedOff() const { return switched_off_; }

  /// All that the next ticks depend on, between two of them: signals, tasks and controllers by name, levels by
  /// priority, what the back end carries.  What setWeight, setPriority and setBackEnd changed is not among it.
  void archive(Archive& archive);

 private:
  struct Place {
    std::size_t level;
    std::size_t task;
  };
  Place placeOf(std::string_view task) const;
  std::size_t levelOf(int priority) const;

  void solveTick(const Sensed& sensed);
  void bearWeight(const Sensed& sensed);
  void updateSignals(const Tick& tick);
  void assembleProblem(const Tick& tick);
  void steer(const Tick& tick, std::size_t level);
  void fillRows(const Tick& tick, NamedTask& named, TickTask& rows);
  void switchOff(const Tick& tick, NamedTask& named, TickTask& rows, const std::string& reason, bool threw);
  void switchOffReaders(const Tick& tick, const NamedSignal& signal, const std::string& reason);
  void switchOffOwner(const Tick& tick, std::size_t level, const std::string& reason);
  /// The torque that is wanted, and whose it is.
  void chooseTorque();
  void applyTorque();
  /// The first task whose numbers no back end can work with, null when there is none.
  const std::string* findUnusableTask() const;

  std::shared_ptr<const dynamics::Model> model_;
  std::vector<NamedSignal> signals_;
  std::vector<Level> levels_;
  std::unique_ptr<BackEnd> back_end_;
  std::unique_ptr<Readings> readings_;                             // never null
  double period_;
  ControllerOptions options_;
  dynamics::DynamicsCache cache_;
  SensingGuard sensing_;
  TickProblem problem_;
  TickSolution solution_;
  TickRecord record_;
  TorqueShaper shaper_;
  Eigen::VectorXd wanted_;                                         // τ*
  Eigen::VectorXd last_solved_;                                    // applied in the last tick that was solved
  std::vector<SwitchedOff> switched_off_;
  double unsolved_for_ = std::numeric_limits<double>::infinity();  // s
  bool bore_weight_ = false;                                       // the last tick's source was `gravity`
};

}  // namespace tactus::control
