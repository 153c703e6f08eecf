#pragma once

#include <memory>
#include <vector>

#include "dsl/diagnostic.h"
#include "dsl/stack.h"
#include "framework/control/controller.h"
#include "framework/control/registry.h"
#include "framework/runtime/guarded_observer.h"
#include "framework/runtime/measures.h"
#include "framework/runtime/sensing_plant.h"

namespace tactus::dsl {

/// Builds the controller that a stack describes.  Throws InvalidStack: what a factory refuses, a reference that
/// leads nowhere, a cycle between signals, an ability that the back end lacks, each at its place.
/// The stack's ElementRows belong to `registry`, which must outlive both.
std::unique_ptr<control::Controller> compile(const Stack& stack, const control::Registry& registry);

/// The sensors of a run with that seed.  Throws InvalidStack as `compile` does; a stack that compiles has its sensors.
std::vector<runtime::NamedSensor> makeSensors(const Stack& stack, const control::Registry& registry,
                                              const description::Scene& scene, std::uint64_t seed);

/// The stack's measures; ports that they read are those of the controller's signals, which outlives them as the scene does.
/// `scene` and `start_q` are those of the run's seed.  Throws InvalidStack.
std::vector<runtime::NamedMeasure> makeMeasures(const Stack& stack, const control::Registry& registry,
                                                const control::Controller& controller,
                                                const description::Scene& scene, const Eigen::VectorXd& start_q);

/// The stack's own recorders, each to write into `folder`; ports that they read are those of the controller's signals.
/// Throws InvalidStack with what a factory refuses, FileError where it cannot write.
std::vector<std::unique_ptr<runtime::GuardedObserver>> makeRecorders(const Stack& stack,
                                                                     const control::Registry& registry,
                                                                     const control::Controller& controller,
                                                                     const std::string& folder);

}  // namespace tactus::dsl
