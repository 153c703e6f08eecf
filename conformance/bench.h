#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "dsl/stack.h"
#include "framework/control/controller.h"
#include "framework/control/registry.h"
#include "framework/runtime/plugin_loader.h"

/// Signals and tasks of a stack without plant and back end: ticked at states that a test chooses.
namespace tactus::conformance {

/// Built-in and shipped elements with those of the given plugins: what reads stacks.
class Workshop {
 public:
  /// `plugins` are libraries.  Throws runtime::PluginError.
  explicit Workshop(const std::vector<std::string>& plugins = {});

  /// Robot models are found beside the stack, in TACTUS_MODEL_PATH, and among the shipped ones.  Throws
  /// dsl::InvalidStack.
  dsl::Stack read(const std::string& file);
  const control::Registry& registry() const { return registry_; }
  const runtime::PluginLoader& plugins() const { return plugins_; }

 private:
  control::Registry registry_;
  runtime::PluginLoader plugins_;
};

/// One world: new signals and tasks, what the robot senses, and its dynamics.
///
///   conformance::Bench bench("stack.xml", {"build/acme.so"});
///   bench.sensed.q = …;
///   bench.tick();
///   bench.rows("reach").force
class Bench {
 public:
  /// At the stack's start, at rest, touching nothing.  Throws dsl::InvalidStack.
  Bench(const dsl::Stack& stack, const control::Registry& registry);
  Bench(const std::string& stack_file, const std::vector<std::string>& plugins);

  /// What the next tick is told; time is set by `tick`.
  control::Sensed sensed;

  /// All signals in their order, the controllers of levels, then all tasks; time then goes on by a period.
  void tick();
  /// Signals, controllers of levels and tasks, and what the next tick is told.
  void archive(control::Archive& archive);

  const dynamics::DynamicsCache& robot() const { return cache_; }  ///< at the state of the last tick
  const control::TickTask& rows(std::string_view task) const;
  const control::Task& task(std::string_view name) const;
  const control::Signal& signal(std::string_view name) const;
  double period() const { return controller_->period(); }          ///< s

  // The parts of `tick`, for who wants to look between them.
  control::Tick sense();                                           ///< the dynamics at `sensed`, and what sensors read
  void prepare(const control::Tick& tick);                         ///< signals, then the controllers of levels
  const control::Controller& controller() const { return *controller_; }
  const std::vector<control::NamedSignal>& signals() const { return controller_->signals(); }
  struct TaskOnBench {
    std::string name;
    control::Task* task;
    control::TickTask rows;
  };
  std::vector<TaskOnBench>& tasks() { return tasks_; }
  TaskOnBench& taskNamed(std::string_view name);
  void endTick() { sensed.time += period(); }

 private:
  std::shared_ptr<Workshop> workshop_;                             // of the second constructor
  std::unique_ptr<control::Controller> controller_;                // keeps signals and tasks; never asked for a torque
  dynamics::DynamicsCache cache_;
  std::vector<TaskOnBench> tasks_;

  Bench(std::shared_ptr<Workshop> workshop, const std::string& stack_file);
};

}  // namespace tactus::conformance
