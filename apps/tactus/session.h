#pragma once

#include <atomic>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/tactus/program.h"
#include "dsl/stack.h"
#include "dsl/state_file.h"
#include "framework/control/controller.h"
#include "framework/runtime/contact_metrics.h"
#include "framework/runtime/guarded_observer.h"
#include "framework/runtime/loop.h"
#include "framework/runtime/measures.h"
#include "framework/runtime/recorder.h"
#include "framework/runtime/run_statistics.h"
#include "framework/runtime/sensing_plant.h"

namespace tactus::app {

/// A feature that a signal seeks by touch, and where the scene really has it.
struct SoughtFeature {
  std::string name;
  const control::FeatureEstimate* estimate = nullptr;
  std::optional<Eigen::Vector3d> truth_W;                          ///< none: no such object, or it has no top
};

/// A stack brought to life once: scene of its seed, controller, plant, and the watchers of the run.
class Session {
 public:
  /// Throws dsl::InvalidStack; a robot that the plant refuses is one, too.  The registry outlives the session.
  Session(dsl::Stack stack, const control::Registry& registry);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// All that the next tick depends on, figures of contacts included.
  dsl::SavedState save();
  /// Goes on from there; the robot and the scene's objects are those of the state.  Throws control::StateError.  What
  /// the state lacks, or this stack, is told, a sentence each: tasks, signals and sensors that it lacks start afresh.
  std::vector<std::string> restore(const dsl::SavedState& saved);
  /// s, of the tick that comes next, by the plant's clock.
  double time() const { return plant_->truth().time; }
  long tick() const { return std::lround(time() / controller_->period()); }

  /// Runs until the stack's duration; `others` observe after contacts, measures and statistics.
  runtime::LoopResult run(const std::vector<control::Observer*>& others, const std::atomic<bool>& stop);
  /// A recorder of this session as the stack asks for it, which writes into `folder`.
  std::unique_ptr<runtime::Recorder> recordInto(const std::string& folder) const;
  /// The stack's own recorders, which write into `folder`; `run` does not close them.
  std::vector<control::Observer*> startRecorders(const std::string& folder);
  /// Figures of the run so far: contacts, tasks, signals, features, measures.
  std::vector<control::Metric> metrics() const;

  /// Names of all figures that a run of this stack may have; those of a feature that it may never find among them.
  std::vector<std::string> metricNames() const;

  /// What the reader of the figures must know: ticks that fell back and the task that made them, targets of no figure.
  std::vector<std::string> warnings() const;

  /// The exit code that faults of tasks call for: exit_plugin when one threw and was switched off, exit_numerical when
  /// the numbers of one were none, exit_done without a fault.
  int faultCode() const;

  /// Where each task stands in the stack, "file:line:column"; a controller's tasks stand where it does.
  std::map<std::string, std::string> taskPlaces() const;

  const dsl::Stack& stack() const { return stack_; }
  /// Of the run's seed.
  const description::Scene& scene() const { return scene_; }
  const runtime::Plant& plant() const { return *plant_; }
  control::Controller& controller() { return *controller_; }
  const control::Controller& controller() const { return *controller_; }
  const runtime::RunStatistics& statistics() const { return statistics_; }
  const runtime::ContactMetrics& contacts() const { return *contacts_; }
  const std::vector<SoughtFeature>& features() const { return features_; }
  /// Everything that the stack asks to go wrong, and when it did.
  const std::vector<const control::FaultRecord*>& faults() const { return faults_; }
  std::string backEndName() const;
  /// The force that the first contact-force task wants, N.
  std::optional<double> wantedForce() const;

 private:
  /// The value behind a port of that type and name; null when the signal's element has none.
  template <class T>
  const T* findPort(size_t signal, const std::string& port) const;
  /// The number behind "source.port" of a signal or a sensor; null where there is none.
  const double* findScalar(const std::string& reference) const;
  std::vector<int> desiredLinks() const;
  void findFeatures();
  void archiveParts(control::Archive& archive);

  dsl::Stack stack_;
  const control::Registry& registry_;
  description::Scene scene_;
  std::unique_ptr<control::Controller> controller_;
  std::unique_ptr<runtime::SensingPlant> plant_;
  std::vector<std::unique_ptr<runtime::GuardedObserver>> recorders_;
  std::unique_ptr<runtime::ContactMetrics> contacts_;
  std::unique_ptr<runtime::Measures> measures_;
  const control::TouchedPoints* touched_points_ = nullptr;
  std::vector<SoughtFeature> features_;
  std::vector<const control::FaultRecord*> faults_;                // of the plant
  runtime::RunStatistics statistics_;
};

}  // namespace tactus::app
