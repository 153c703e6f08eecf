#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/control/back_end.h"
#include "framework/control/signal.h"
#include "framework/control/task.h"
#include "framework/dynamics/dynamics_cache.h"

namespace tactus::control {

struct NamedSignal {
  std::string name;
  std::unique_ptr<Signal> signal;
};
struct NamedTask {
  std::string name;
  std::unique_ptr<Task> task;
};
struct Level {
  int priority = 1;
  std::optional<double> weight;
  std::vector<NamedTask> tasks;
};

/// A task, signal or back end that threw, or broke its promise, in a tick; the message names it and the time.
class TickError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a tick did besides its torque.
struct TickRecord {
  Status status = Status::ok;
  bool fallback = false;                                           ///< the back end failed: its fallback, or b + g, was held
  bool limited = false;                                            ///< the torque was scaled or cut into its limits
  /// The task whose rows made the tick fall back; lives as long as the controller.
  const std::string* unusable_task = nullptr;
};

/// The compiled stack: signals in dependency order, levels of tasks, one back end.
///
/// A tick: dynamics from (q, q̇), signals, tasks, tick problem with the limits left after b + g, back end,
/// τ = task torque + b + g.  Takes no memory after construction (as far as the back end takes none).
class Controller {
 public:
  Controller(std::shared_ptr<const dynamics::Model> model, std::vector<NamedSignal> signals,
             std::vector<Level> levels, std::unique_ptr<BackEnd> back_end, double period,
             const Eigen::Vector3d& gravity_W);

  /// The torque to hold until the next tick, N m, b + g included, within the actuators' limits, always finite.
  /// Throws TickError.
  const Eigen::VectorXd& tick(const Sensed& sensed);

  double period() const { return period_; }                        ///< s
  const dynamics::Model& model() const { return *model_; }
  const dynamics::DynamicsCache& robot() const { return cache_; }
  const TickProblem& problem() const { return problem_; }
  const TickSolution& solution() const { return solution_; }
  const TickRecord& record() const { return record_; }
  BackEnd& backEnd() { return *back_end_; }
  const BackEnd& backEnd() const { return *back_end_; }
  const std::vector<NamedSignal>& signals() const { return signals_; }
  const std::vector<Level>& levels() const { return levels_; }

 private:
  void assembleProblem(const Tick& tick);
  /// The first task whose numbers no back end can work with, null when there is none.
  const std::string* findUnusableTask() const;

  std::shared_ptr<const dynamics::Model> model_;
  std::vector<NamedSignal> signals_;
  std::vector<Level> levels_;
  std::unique_ptr<BackEnd> back_end_;
  double period_;
  dynamics::DynamicsCache cache_;
  TickProblem problem_;
  TickSolution solution_;
  TickRecord record_;
  Eigen::VectorXd torque_;
};

}  // namespace tactus::control
