#pragma once

#include <optional>
#include <string>

#include "dsl/stack.h"
#include "framework/control/registry.h"

namespace tactus::conformance {

/// A stack on the shipped arm and hand that holds one instance of the element, made from its defaults; what it requires
/// besides is filled with something plausible: some link, some joints, a signal with a port of the type, a number
/// within the range.  Nothing, and the reason in `why_not`, where that cannot be.
std::optional<dsl::Stack> specimenOf(const control::ElementRow& row, const control::Registry& registry,
                                     std::string& why_not);

/// The element's values alone, so made: for shapes, which stand in no controller.
std::optional<control::ElementValues> specimenValues(const control::ElementRow& row, std::string& why_not);

}  // namespace tactus::conformance
