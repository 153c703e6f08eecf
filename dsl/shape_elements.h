#pragma once

#include "framework/control/registry.h"

namespace tactus::dsl {

/// Adds the built-in shapes: those of framework/geometry.
void addShapeElements(control::Registry& registry);

}  // namespace tactus::dsl
