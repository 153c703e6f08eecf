#pragma once

#include <nlohmann/json.hpp>

#include "apps/tactus/command.h"
#include "dsl/diagnostic.h"

namespace tactus::app {

/// Runs the action and turns what it throws into talk on stderr (with --json also `{errors: […]}` on stdout) and
/// the exit code.
int reportErrors(const Context& context);

/// {file, line, column, code, message, suggestion?}
nlohmann::ordered_json toJson(const dsl::Diagnostic& diagnostic);

/// "robot.urdf:3:5: message"; the message alone for what was made in code.
std::string located(const description::Place& place, const std::string& message);

/// The exit code of a list of findings: the first error's; 0 without errors.
int exitCode(const std::vector<dsl::Diagnostic>& diagnostics);

}  // namespace tactus::app
