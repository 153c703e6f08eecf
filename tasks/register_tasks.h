#pragma once

#include "framework/control/registry.h"

namespace tactus::tasks {

/// Adds the built-in task types and signals, by the same calls that a plugin uses.
void registerBuiltIns(control::Registry& registry);

}  // namespace tactus::tasks
