#pragma once

#include "framework/control/registry.h"

namespace tactus::dsl {

/// Adds the built-in shapes: <plane>, <box>, <sphere>, <cylinder>, <capsule>.
void addShapeElements(control::Registry& registry);

}  // namespace tactus::dsl
