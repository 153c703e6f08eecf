#pragma once

#include "dsl/element_checker.h"
#include "dsl/stack.h"

namespace tactus::dsl {

/// Fills gravity and objects; poses given from a carrier's top are turned into the world.
void readScene(const CheckedElement& scene, Stack& stack, Findings& findings);

}  // namespace tactus::dsl
