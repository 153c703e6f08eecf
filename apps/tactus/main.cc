#include <iostream>

#include "apps/tactus/command.h"
#include "apps/tactus/errors.h"
#include "dsl/nearest_name.h"

namespace tactus::app {
namespace {

constexpr const char* examples = R"(Examples:
  tactus check examples/explore_table/stack.xml
  tactus run examples/explore_table/stack.xml --seed 3
  tactus compare examples/explore_table/stack.xml --backends null-space,qp/ipopt,qp/nlopt
  tactus COMMAND --help

Exit codes: 0 done, 1 comparison or golden mismatch, 2 usage, 3 invalid stack, 4 plugin, 5 numerical failure,
6 files, 130 interrupted (the log is kept).)";

std::string quotedSuggestion(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string nearest = dsl::nearestName(word, candidates);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

/// The command that the command line reached, e.g. `golden record`.
const CLI::App* deepest(const CLI::App* app) {
  for (auto inner = app->get_subcommands(); !inner.empty(); inner = app->get_subcommands()) app = inner.front();
  return app;
}

std::string fullName(const CLI::App* app) {
  const CLI::App* parent = app->get_parent();
  return parent ? fullName(parent) + " " + app->get_name() : app->get_name();
}

int usage(const CLI::App* command, const std::string& message) {
  const std::string name = fullName(command);
  std::cerr << name << ": " << message << "\ntry '" << name << " --help'\n";
  return exit_usage;
}

/// Words that a command does not know, each with its nearest option.
std::string describeExtras(const CLI::App* command) {
  std::vector<std::string> options;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  std::string message;
  for (const std::string& word : command->remaining()) {
    if (!message.empty()) message += "\n  ";
    const bool option = word.starts_with("-");
    message += option ? "unknown option '" + word + "'" + quotedSuggestion(word.substr(0, word.find('=')), options)
                      : "unexpected argument '" + word + "'";
  }
  return message;
}

int runCommand(int argc, char** argv) {
  CLI::App app("Tactus: XML stacks of contact tasks, compiled into torque controllers");
  app.name("tactus");
  // A misspelled command would otherwise be reported as a missing one.
  app.require_subcommand(0, 1);
  app.allow_extras();
  app.set_version_flag("--version", "tactus " TACTUS_VERSION);
  app.footer(examples);

  Context context;
  addRun(app, context);
  addCheck(app, context);
  addCompare(app, context);
  addSolve(app, context);
  addDynamics(app, context);
  addGolden(app, context);
  addPlugins(app, context);
  addReport(app, context);

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request, std::cout, std::cerr);
  } catch (const CLI::ExtrasError&) {
    const CLI::App* command = deepest(&app);
    return usage(command, describeExtras(command));
  } catch (const CLI::ParseError& error) {
    const CLI::App* command = deepest(&app);
    // What is missing is often only misspelled: an unknown option explains more.
    const std::string extras = command == &app ? "" : describeExtras(command);
    return usage(command, extras.empty() ? error.what() : extras);
  }
  if (!app.remaining().empty()) {
    const std::string& word = app.remaining().front();
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
    const bool option = word.starts_with("-");
    return usage(&app, std::string(option ? "unknown option '" : "unknown command '") + word + "'" +
                           (option ? "" : quotedSuggestion(word, names)));
  }
  if (!context.action) {
    std::cerr << deepest(&app)->help();
    return exit_usage;
  }
  return reportErrors(context);
}

}  // namespace
}  // namespace tactus::app

int main(int argc, char** argv) { return tactus::app::runCommand(argc, argv); }
