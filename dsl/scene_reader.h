#pragma once

#include "dsl/element_checker.h"
#include "dsl/stack.h"
#include "framework/control/registry.h"

namespace tactus::dsl {

/// Fills gravity and objects; poses given from a carrier's top are turned into the world.
void readScene(const CheckedElement& scene, const control::Registry& registry, Stack& stack, Findings& findings);

}  // namespace tactus::dsl
