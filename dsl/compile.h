#pragma once

#include <memory>

#include "dsl/diagnostic.h"
#include "dsl/stack.h"
#include "framework/control/controller.h"
#include "framework/control/registry.h"

namespace tactus::dsl {

/// Builds the controller that a stack describes.  Throws InvalidStack: what a factory refuses, a reference that
/// leads nowhere, a cycle between signals, an ability that the back end lacks, each at its place.
/// The stack's ElementRows belong to `registry`, which must outlive both.
std::unique_ptr<control::Controller> compile(const Stack& stack, const control::Registry& registry);

}  // namespace tactus::dsl
