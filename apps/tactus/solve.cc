#include <algorithm>
#include <chrono>
#include <iostream>

#include "apps/tactus/command.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "dsl/nearest_name.h"
#include "dsl/tick_file.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

/// Options that have a flag of their own; all others go through --option.
constexpr const char* named_options[] = {"projection", "inequalities", "objective", "metric", "solver"};

struct SolveArguments {
  std::string file;
  std::string back_end;
  std::map<std::string, std::string> named;
  std::vector<std::string> others;                                 ///< name=value
  std::vector<std::string> plugins;
};

std::map<std::string, std::string> chosenOptions(const SolveArguments& arguments, const BackEndChoice& choice) {
  std::map<std::string, std::string> options = choice.options;
  for (const auto& [name, value] : arguments.named) {
    if (!value.empty()) options[name] = value;
  }
  for (const std::string& other : arguments.others) {
    const size_t equals = other.find('=');
    if (equals == std::string::npos) throw UsageError("--option " + other + ": expected name=value");
    options[other.substr(0, equals)] = other.substr(equals + 1);
  }
  return options;
}

/// Throws UsageError for what the back end does not know or does not accept.
control::ElementValues valuesOf(const control::ElementRow& row, const std::map<std::string, std::string>& options) {
  std::vector<std::string> known;
  for (const control::AttributeRow& attribute : row.attributes) known.push_back(attribute.name);
  for (const auto& [name, value] : options) {
    if (row.attribute(name)) continue;
    const std::string nearest = dsl::nearestName(name, known);
    throw UsageError("back end '" + row.name + "' has no option '" + name + "'" +
                     (nearest.empty() ? "" : "; did you mean '" + nearest + "'?") + "; its options: " + joined(known));
  }
  try {
    return control::makeValues(row, options);
  } catch (const std::invalid_argument& error) {
    throw UsageError("back end '" + row.name + "': " + error.what());
  }
}

std::unique_ptr<control::BackEnd> makeBackEnd(const control::Registry& registry, const control::ElementValues& values) {
  try {
    return registry.makeBackEnd(values);
  } catch (const control::ElementError& error) {
    throw UsageError("back end '" + values.row().name + "': " + error.what());
  }
}

control::TickProblem readProblem(const std::string& file) {
  try {
    return dsl::readTickProblem(file);
  } catch (const dsl::TickFileError& error) {
    throw runtime::FileError(file, error.what());
  }
}

std::string summary(const control::TickSolution& solution) {
  std::string text = solution.message.empty() ? "" : solution.message + "\n";
  std::vector<std::vector<std::string>> rows{{"level", "rank", "nullity", "residual", "active"}};
  for (const control::LevelReport& level : solution.levels) {
    rows.push_back({std::to_string(level.priority), std::to_string(level.rank), std::to_string(level.nullity),
                    rounded(level.residual), std::to_string(level.active.size())});
  }
  text += textTable(rows) + "torque";
  for (const double torque : solution.torque) text += " " + rounded(torque, 6);
  return text + "\n";
}

int solve(const SolveArguments& arguments, bool json) {
  using Clock = std::chrono::steady_clock;
  Program program(arguments.plugins);
  const BackEndChoice choice = program.backEndChoice(arguments.back_end);
  const control::ElementValues values = valuesOf(program.backEndRow(choice.name), chosenOptions(arguments, choice));
  const control::TickProblem problem = readProblem(arguments.file);
  const std::unique_ptr<control::BackEnd> back_end = makeBackEnd(program.registry(), values);

  control::TickSolution solution;
  back_end->prepare(problem, solution);
  const auto start = Clock::now();
  back_end->solve(problem, solution);
  const double solve_us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();

  std::cout << (json ? dsl::solutionToJson(problem, solution, choice.name, solve_us) : summary(solution));
  if (solution.status == control::Status::ok) return exit_done;
  std::cerr << "tactus solve: " << (solution.status == control::Status::infeasible ? "infeasible" : "failed")
            << (solution.message.empty() ? "" : ": " + solution.message) << "\n";
  return exit_numerical;
}

}  // namespace

void addSolve(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("solve", "Solve one tick problem from a file");
  const auto arguments = std::make_shared<SolveArguments>();
  command->add_option("TICK", arguments->file, "A tick problem, JSON of the format tactus-tick/1")
      ->required()
      ->type_name("");
  command->add_option("--backend", arguments->back_end, "null-space, qp, qp/nlopt, …")
      ->required()
      ->type_name("BACKEND");
  for (const char* name : named_options) {
    command->add_option(std::string("--") + name, arguments->named[name], "Option of the back end")
        ->type_name("CHOICE");
  }
  command->add_option("--option", arguments->others, "Any other option of the back end")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  declarePlugins(*command, arguments->plugins);
  command->add_flag("--json", context.json, "{backend, status, torque, contact_forces?, levels, solve_us, …}");
  command->footer(R"(An infeasible problem prints its JSON all the same and ends with exit code 5.

Examples:
  tactus solve tick.json --backend null-space --projection augmented --inequalities exact --json
  tactus solve tick.json --backend qp/nlopt --objective torque --metric inertia --option force-weight=0.1 --json)");
  command->callback([=, &context] { context.action = [=, &context] { return solve(*arguments, context.json); }; });
}

}  // namespace tactus::app
