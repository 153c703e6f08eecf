#pragma once

#include "apps/tactus/command.h"
#include "apps/tactus/program.h"
#include "dsl/diagnostic.h"

namespace tactus::app {

/// What every command that runs a stack takes.
struct StackArguments {
  StackOptions stack;
  std::vector<std::string> plugins;

  /// --duration, --seed, --set, --plugin
  void declare(CLI::App& command);
};

/// Accepts numbers greater than 0.
CLI::Validator positive();

/// Accepts a simulated time, s.
CLI::Validator simulatedTime();

/// Accepts the time of a tick, s: from 0.
CLI::Validator timeOfTick();

/// Accepts a text that is not empty, as an unset variable of a shell is.
CLI::Validator notEmpty();

/// Accepts a seed.
CLI::Validator seed();

/// Declares --plugin.
void declarePlugins(CLI::App& command, std::vector<std::string>& plugins);

/// Reads the stack, with its warnings on stderr.
dsl::Stack readAloud(Program& program, const StackOptions& options);

}  // namespace tactus::app
