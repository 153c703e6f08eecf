#pragma once

#include <string>

#include "dsl/read_stack.h"
#include "framework/control/registry.h"

namespace tactus::dsl_test {

/// Structure, the built-in tasks, stand-ins for back ends that solve nothing, and small elements of a vendor
/// <test.probe>, <test.pull>, <test.guard> and <test.press>, each with one kind of value or refusal to try.
control::Registry makeRegistry();

/// Reading with the project's models, and no plugins but "known".
dsl::ReadOptions readOptions();

/// A file below tests/dsl.
std::string testFile(const std::string& name);

/// Text written to a file of its own in a folder that the test keeps.
std::string writeFile(const std::string& name, const std::string& text);

/// A stack of the small arm: `inside` stands between the robot and a controller.
std::string smallStack(const std::string& inside, const std::string& controller = "<controller backend=\"all\"/>");

}  // namespace tactus::dsl_test
