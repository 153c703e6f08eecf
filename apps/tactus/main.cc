#include <csignal>
#include <iostream>

#include "apps/tactus/command.h"
#include "apps/tactus/errors.h"
#include "dsl/nearest_name.h"
#include "framework/runtime/version.h"

namespace tactus::app {
namespace {

constexpr const char* examples = R"(Examples:
  tactus check examples/explore_table/stack.xml
  tactus run examples/explore_table/stack.xml --seed 3
  tactus compare examples/explore_table/stack.xml --backends null-space,qp/ipopt,qp/nlopt
  tactus COMMAND --help

Exit codes: 0 done, 1 comparison or golden mismatch, 2 usage, 3 invalid stack, 4 plugin, 5 numerical failure,
6 files, 130 interrupted (the log is kept).)";

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

/// Words that a command does not know, each with the nearest option or sub-command.
std::string describeExtras(const CLI::App* command) {
  std::vector<std::string> options, commands;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  }
  for (const CLI::App* inner : command->get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(inner->get_name());
  }
  std::string message;
  for (const std::string& word : command->remaining()) {
    if (!message.empty()) message += "\n  ";
    const bool is_option = word.starts_with("-");
    const char* kind = is_option          ? "unknown option '"
                       : commands.empty() ? "unexpected argument '"
                                          : "unknown command '";
    const std::string nearest = dsl::nearestName(word.substr(0, word.find('=')), is_option ? options : commands);
    message += kind + word + "'" + (nearest.empty() ? "" : "; did you mean '" + nearest + "'?");
    // What follows a wrong command belongs to it.
    if (!is_option && !commands.empty()) break;
  }
  return message;
}

/// An option that ends with its "=": the parser would take the next word for its value, be it another option.
std::string optionWithoutValue(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--") break;
    if (word.starts_with("--") && word.find('=') == word.size() - 1) return word;
  }
  return "";
}

int runCommand(int argc, char** argv) {
  CLI::App app("Tactus: XML stacks of contact tasks, compiled into torque controllers");
  app.name("tactus");
  app.set_version_flag("--version", "tactus " TACTUS_VERSION);
  app.footer(examples);

  Context context;
  addRun(app, context);
  addCheck(app, context);
  addCompare(app, context);
  addSolve(app, context);
  addDynamics(app, context);
  addGrasp(app, context);
  addGolden(app, context);
  addStudy(app, context);
  addPlugins(app, context);
  addPlot(app, context);
  addReport(app, context);
  addExport(app, context);
  addExplain(app, context);
  addGraph(app, context);
  addNew(app, context);
  addSchema(app, context);
  addFormat(app, context);
  addMigrate(app, context);
  addCompletion(app, context);
  addMan(app, context);
  // A misspelled command would otherwise be reported as a missing one.  Commands inherit this when they are added, so
  // it comes after them: what they do not know stays an error.
  app.require_subcommand(0, 1);
  app.allow_extras();

  if (const std::string bare = optionWithoutValue(argc, argv); !bare.empty())
    return usage(&app, "'" + bare + "' has no value");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request, std::cout, std::cerr);
  } catch (const CLI::ParseError& error) {
    // What is missing is often only misspelled: an unknown option explains more.
    const CLI::App* command = deepest(&app);
    const std::string extras = describeExtras(command);
    return usage(command, extras.empty() ? error.what() : extras);
  }
  if (const std::string extras = describeExtras(&app); !extras.empty()) return usage(&app, extras);
  if (!context.action) {
    const CLI::App* command = deepest(&app);
    std::cerr << command->help(command == &app ? "" : fullName(command->get_parent()));
    return exit_usage;
  }
  return reportErrors(context);
}

}  // namespace
}  // namespace tactus::app

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);                                   // a file that may grow no more is an error like a full disk
  const int code = tactus::app::runCommand(argc, argv);
  // Data that did not arrive is a failure, whatever was done for it.
  if (std::cout.flush()) return code;
  std::cerr << "tactus: standard output could not be written\n";
  return code == tactus::app::exit_done ? tactus::app::exit_files : code;
}
