#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stdexcept>
#include <string>

/// The sub-commands of `tactus`, one file each.  An `add…` function declares the command's options and, when the
/// command line names it, puts what is to be done into Context::action.
namespace tactus::app {

enum ExitCode {
  exit_done = 0,
  exit_mismatch = 1,                                               ///< comparison or golden
  exit_usage = 2,
  exit_invalid_stack = 3,
  exit_plugin = 4,
  exit_numerical = 5,
  exit_files = 6,
  exit_interrupted = 130
};

struct Context {
  bool json = false;                                               ///< --json: data on stdout, talk on stderr
  std::function<int()> action;                                     ///< returns an ExitCode
};

/// A command line that asks for something that does not exist; exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A result that is no number, or that no digit can be trusted of; exit code 5.
class NumericalError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void addRun(CLI::App& program, Context& context);
void addCheck(CLI::App& program, Context& context);
void addCompare(CLI::App& program, Context& context);
void addSolve(CLI::App& program, Context& context);
void addDynamics(CLI::App& program, Context& context);
void addGrasp(CLI::App& program, Context& context);
void addGolden(CLI::App& program, Context& context);
void addStudy(CLI::App& program, Context& context);
void addPlugins(CLI::App& program, Context& context);
void addExplain(CLI::App& program, Context& context);
void addExport(CLI::App& program, Context& context);
void addFormat(CLI::App& program, Context& context);
void addMigrate(CLI::App& program, Context& context);
void addGraph(CLI::App& program, Context& context);
void addSchema(CLI::App& program, Context& context);
void addPlot(CLI::App& program, Context& context);
void addReport(CLI::App& program, Context& context);
void addNew(CLI::App& program, Context& context);
void addCompletion(CLI::App& program, Context& context);
void addMan(CLI::App& program, Context& context);

}  // namespace tactus::app
