#include "apps/tactus/stack_arguments.h"

#include <charconv>
#include <cmath>
#include <iostream>

#include "apps/tactus/text.h"
#include "dsl/read_stack.h"

namespace tactus::app {

CLI::Validator positive() {
  const auto check = [](std::string& text) -> std::string {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool number = error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
    return number && value > 0 ? "" : "'" + text + "' is not a number greater than 0";
  };
  return CLI::Validator(check, "");
}

CLI::Validator simulatedTime() {
  const auto check = [](std::string& text) -> std::string {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool number = error == std::errc() && end == text.data() + text.size();
    return number && value > 0 && value <= dsl::longest_run
               ? ""
               : "'" + text + "' is not a number greater than 0 and at most " + rounded(dsl::longest_run);
  };
  return CLI::Validator(check, "");
}

CLI::Validator timeOfTick() {
  const auto check = [](std::string& text) -> std::string {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool number = error == std::errc() && end == text.data() + text.size();
    return number && value >= 0 && value <= dsl::longest_run
               ? ""
               : "'" + text + "' is not a number from 0 to " + rounded(dsl::longest_run);
  };
  return CLI::Validator(check, "");
}

CLI::Validator notEmpty() {
  return CLI::Validator([](std::string& text) -> std::string { return text.empty() ? "it is empty" : ""; }, "");
}

CLI::Validator seed() {
  const auto check = [](std::string& text) -> std::string {
    std::int32_t value = 0;                                        // as far as a stack's seed reaches
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool number = error == std::errc() && end == text.data() + text.size();
    return number && value >= 0 ? "" : "'" + text + "' is not a whole number from 0 to 2147483647";
  };
  return CLI::Validator(check, "");
}

void declarePlugins(CLI::App& command, std::vector<std::string>& plugins) {
  command.add_option("--plugin", plugins, "Plugin library to load, or folder to search for plugins")
      ->type_name("PATH")
      ->allow_extra_args(false);
}

void StackArguments::declare(CLI::App& command) {
  command.add_option("--duration", stack.duration, "Simulated time; the stack's own without it")
      ->type_name("SECONDS")
      ->check(simulatedTime());
  command.add_option("--seed", stack.seed, "Seed of the jitter of scene and start; the stack's own without it")
      ->type_name("N")
      ->check(seed());
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
