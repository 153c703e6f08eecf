#include "apps/tactus/stack_arguments.h"

#include <iostream>

namespace tactus::app {

void declarePlugins(CLI::App& command, std::vector<std::string>& plugins) {
  command.add_option("--plugin", plugins, "Plugin library to load, or folder to search for plugins")
      ->type_name("PATH")
      ->allow_extra_args(false);
}

void StackArguments::declare(CLI::App& command) {
  command.add_option("--duration", stack.duration, "Simulated time; the stack's own without it")
      ->type_name("SECONDS")
      ->check(CLI::PositiveNumber);
  command.add_option("--seed", stack.seed, "Seed of the scene's jitter; the stack's own without it")->type_name("N");
  command.add_option("--set", stack.set, "Give a <parameter> of the stack another value")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  declarePlugins(command, plugins);
}

dsl::Stack readAloud(Program& program, const StackOptions& options) {
  std::vector<dsl::Diagnostic> warnings;
  dsl::Stack stack = program.read(options, &warnings);
  for (const dsl::Diagnostic& warning : warnings) std::cerr << dsl::render(warning) << "\n";
  return stack;
}

}  // namespace tactus::app
