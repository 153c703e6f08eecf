#pragma once

#include "apps/tactus/command.h"
#include "apps/tactus/stack_arguments.h"

namespace tactus::app {

/// Prints every value of a stack, after includes, parameters, classes and defaults, with where it comes from.
int explainStack(const StackOptions& options, const std::vector<std::string>& plugins, bool json);

}  // namespace tactus::app
