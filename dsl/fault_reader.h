#pragma once

#include "dsl/element_checker.h"
#include "dsl/stack.h"

namespace tactus::dsl {

/// Fills what goes wrong with drives and bodies.  Robot, objects and controller of the stack are there already; names
/// that lead nowhere are passed over, since the ReferenceChecker tells of them.
void readFaults(const CheckedElement& faults, Stack& stack, Findings& findings);

}  // namespace tactus::dsl
