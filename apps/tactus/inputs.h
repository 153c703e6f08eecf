#pragma once

#include <string>
#include <vector>

#include "dsl/stack.h"

namespace tactus::app {

/// FNV-1a, 64 bit: tells whether an input is the one that was recorded.
std::string hashOf(const std::string& content);

/// Hash of the running program with those of its libraries that are Tactus's own.
std::string hashOfProgram();

/// Full paths of the files that the scene's shapes name, as the resolved stack has them.
std::vector<std::string> filesOfShapes(const dsl::Stack& stack);

}  // namespace tactus::app
