#pragma once

#include <memory>
#include <string>
#include <vector>

#include "framework/control/task.h"

namespace tactus::control {

/// Owns a level: what its tasks are, and from tick to tick which of them take part and what they aim at.  The level
/// around it says when all of that holds, for a phase or for good; priority, weight and back end are none of its
/// business.
class LevelController {
 public:
  virtual ~LevelController() = default;

  /// After the signals and before any task, in ticks in which its level takes part; takes no memory.
  void update(const Tick& tick) { doUpdate(tick); }
  virtual void columns(std::vector<LogColumn>&) const {}
  virtual void metrics(std::vector<Metric>&) const {}
  /// What it carries from one tick to the next, besides that of its tasks.
  void archive(Archive& archive) { doArchive(archive); }

 private:
  virtual void doUpdate(const Tick& tick) = 0;
  virtual void doArchive(Archive&) {}
};

/// A task of a level controller; the stack knows it as `<controller>.<name>`.
struct OwnedTask {
  std::string name;                                                ///< an identifier, each once
  std::unique_ptr<Task> task;
  /// It takes part while this is > 0.5, always where it is null.  Comes and goes as every task does: its forces fade,
  /// and what its rows held goes over (Activation).  Lives as long as the controller.
  const double* active = nullptr;
};

/// What the factory of a level controller makes: the tasks go into the level, the controller keeps pointers to those
/// that it steers.
struct ControlledLevel {
  std::unique_ptr<LevelController> controller;
  std::vector<OwnedTask> tasks;
};

}  // namespace tactus::control
