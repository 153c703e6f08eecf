#pragma once

#include "framework/control/registry.h"

namespace tactus::dsl {

/// Adds <faults> and what may stand in it besides the faults of sensors.
void addFaultElements(control::Registry& registry);

}  // namespace tactus::dsl
