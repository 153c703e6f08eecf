#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/tactus/command.h"
#include "apps/tactus/conflict_json.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "dsl/capsule.h"
#include "dsl/nearest_name.h"
#include "dsl/tick_file.h"
#include "framework/control/refuse_torque.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

/// Options that have a flag of their own; all others go through --option.
constexpr const char* named_options[] = {"projection", "inequalities", "objective", "metric", "solver"};

constexpr const char* any_back_end = "any";

struct SolveArguments {
  std::string file;
  std::string back_end;                                            ///< "" = the one that a capsule recorded
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

/// One back end ready to solve the file's problem.
struct Request {
  std::string name;
  control::ElementValues values;
  const dsl::Capsule* capsule = nullptr;                           ///< whose state it starts from; null: afresh
};

struct Answer {
  control::TickSolution solution;
  bool threw = false;                                              ///< the back end did; the message says so
  double solve_us = 0;
};

/// The back end and the options that the capsule recorded, some replaced by those of the command line.
Request recorded(Program& program, const dsl::Capsule& capsule, const SolveArguments& arguments) {
  const control::ElementTable& table = program.registry().elements();
  if (const size_t dot = capsule.back_end.find('.'); dot != std::string::npos && !table.findBackEnd(capsule.back_end))
    program.plugins().loadNamed(capsule.back_end.substr(0, dot));
  BackEndChoice choice{capsule.back_end, capsule.back_end, capsule.options};
  return {choice.name, valuesOf(program.backEndRow(choice.name), chosenOptions(arguments, choice)), &capsule};
}

/// Whether the words of --backend name what the capsule recorded: its back end, and no variant that it was not.
bool isRecorded(const BackEndChoice& choice, const dsl::Capsule& capsule) {
  return choice.name == capsule.back_end &&
         std::all_of(choice.options.begin(), choice.options.end(), [&](const auto& option) {
           const auto recorded = capsule.options.find(option.first);
           return recorded != capsule.options.end() && recorded->second == option.second;
         });
}

Request requested(Program& program, const dsl::TickFile& file, const SolveArguments& arguments) {
  if (arguments.back_end.empty()) {
    if (file.capsule) return recorded(program, *file.capsule, arguments);
    throw UsageError("--backend is missing; only a capsule of a run names its own");
  }
  const BackEndChoice choice = program.backEndChoice(arguments.back_end);
  if (file.capsule && isRecorded(choice, *file.capsule)) return recorded(program, *file.capsule, arguments);
  return {choice.name, valuesOf(program.backEndRow(choice.name), chosenOptions(arguments, choice)), nullptr};
}

/// A plugin's back end may refuse what somebody made of its numbers.
void resume(control::BackEnd& back_end, const control::WarmStart& warm_start) {
  try {
    back_end.setWarmStart(warm_start);
  } catch (const std::exception& error) {
    throw dsl::JsonFileError("capsule.warm_start", std::string("the back end refuses it: ") + error.what());
  }
}

std::string thrown(const std::string& what) { return "the back end threw: " + what; }

Answer answer(const control::Registry& registry, const Request& request, const control::TickProblem& problem) {
  using Clock = std::chrono::steady_clock;
  const std::unique_ptr<control::BackEnd> back_end = makeBackEnd(registry, request.values);
  Answer answer;
  if (request.capsule) {
    // Wall-clock time does not repeat; the steps that were done in it do.
    control::Deadline deadline{request.capsule->deadline.iterations};
    if (request.capsule->late && std::isfinite(request.capsule->deadline.seconds))
      deadline.iterations = std::min(deadline.iterations, request.capsule->iterations);
    back_end->setDeadline(deadline);
  }
  back_end->prepare(problem, answer.solution);
  if (request.capsule) resume(*back_end, request.capsule->warm_start);
  const control::TickSolution fresh = answer.solution;
  const auto threw = [&](const std::string& what) {
    answer.solution = fresh;                                       // not what it may have left half done
    answer.solution.status = control::Status::failed;
    answer.solution.message = thrown(what);
    answer.threw = true;
  };
  const auto start = Clock::now();
  try {
    back_end->solve(problem, answer.solution);
  } catch (const std::exception& error) {
    threw(error.what());
  } catch (...) {
    threw("it threw something that is not a std::exception");
  }
  answer.solve_us = std::chrono::duration<double, std::micro>(Clock::now() - start).count();
  // As the controller does: such a torque never reaches the robot.
  if (!answer.solution.torque.allFinite()) control::refuseTorque(answer.solution);
  return answer;
}

ordered_json toJson(const control::TickProblem& problem, const Request& request, const Answer& answer) {
  return ordered_json::parse(dsl::solutionToJson(problem, answer.solution, request.name, answer.solve_us));
}

/// How an answer compares with the one that a capsule holds.
struct Reproduction {
  bool exact = false;                                              ///< status, every bit of the torque, what was thrown
  double difference = 0;                                           ///< largest of a joint, N m
  std::string joint;                                               ///< where

  Reproduction(const dsl::Capsule& capsule, const Answer& answer) {
    const Eigen::VectorXd& torque = answer.solution.torque;
    const size_t bytes = sizeof(double) * static_cast<size_t>(torque.size());
    exact = answer.solution.status == capsule.status && answer.threw == capsule.threw &&
            (!answer.threw || answer.solution.message == thrown(capsule.message)) &&
            std::memcmp(torque.data(), capsule.torque.data(), bytes) == 0;
    if (torque.size() == 0) return;
    Eigen::Index at = 0;
    difference = (torque - capsule.torque).cwiseAbs().maxCoeff(&at);
    joint = capsule.joints[static_cast<size_t>(at)];
  }

  std::string text(const dsl::Capsule& capsule, const Answer& answer) const {
    const control::TickSolution& solution = answer.solution;
    if (exact) return answer.threw ? "reproduced: the back end threw again" : "reproduced to the bit";
    std::string text = "not reproduced: ";
    if (capsule.threw) return text + "in the run " + thrown(capsule.message);
    if (answer.threw) return text + "in the run it did not throw";
    if (solution.status != capsule.status) {
      text += "the run had status " + std::string(dsl::statusName(capsule.status)) + ", this is " +
              dsl::statusName(solution.status) + "; ";
    }
    return text + "the torque is off by " + rounded(difference) + " N m at joint " + joint +
           (capsule.late && std::isfinite(capsule.deadline.seconds)
                ? " (the tick was late by the clock, which does not repeat)"
                : "");
  }
};

/// Of an infeasible problem: adds `conflict` to the answer and returns its sentence.
std::string addConflict(const dsl::TickFile& file, const control::TickSolution& solution, ordered_json& answer) {
  if (solution.status != control::Status::infeasible) return "";
  control::ConflictNames names;
  if (file.capsule) names = {file.capsule->joints, file.capsule->places};
  const control::Conflict conflict = control::findConflict(file.problem);
  answer["conflict"] = conflictToJson(conflict, file.problem, names);
  return control::describe(conflict, file.problem, names);
}

int solveOne(Program& program, const dsl::TickFile& file, const SolveArguments& arguments, bool json) {
  const Request request = requested(program, file, arguments);
  const Answer found = answer(program.registry(), request, file.problem);
  const control::TickSolution& solution = found.solution;
  ordered_json data = toJson(file.problem, request, found);

  std::optional<Reproduction> reproduction;
  if (request.capsule) {
    const dsl::Capsule& capsule = *request.capsule;
    reproduction.emplace(capsule, found);
    data["capsule"] = {{"reproduced", reproduction->exact},
                       {"difference_Nm", reproduction->difference},
                       {"tick", capsule.tick},
                       {"time", capsule.time},
                       {"recorded_status", dsl::statusName(capsule.status)}};
    std::cerr << "tactus solve: tick " << capsule.tick << ", t = " << rounded(capsule.time, 6) << " s, "
              << capsule.back_end << ": " << reproduction->text(capsule, found) << "\n";
  }
  const std::string why = addConflict(file, solution, data);
  std::cout << (json ? jsonText(data) + "\n" : summary(solution));
  if (solution.status != control::Status::ok) {
    std::cerr << "tactus solve: " << dsl::statusName(solution.status)
              << (solution.message.empty() ? "" : ": " + solution.message) << "\n";
  }
  if (!why.empty()) std::cerr << "tactus solve: " << why << "\n";
  if (reproduction && !reproduction->exact) return exit_mismatch;
  return solution.status == control::Status::ok ? exit_done : exit_numerical;
}

/// Every back end that there is, one line each.
int solveAny(Program& program, const dsl::TickFile& file, const SolveArguments& arguments, bool json) {
  if (!chosenOptions(arguments, {}).empty()) throw UsageError("--backend any takes no options: each has its own");
  std::vector<Request> requests;
  if (file.capsule) requests.push_back(recorded(program, *file.capsule, arguments));
  for (const std::string& name : program.registry().names(control::ElementKind::back_end)) {
    if (!requests.empty() && file.capsule && name == file.capsule->back_end) continue;
    requests.push_back({name, valuesOf(program.backEndRow(name), {}), nullptr});
  }
  ordered_json all = ordered_json::array();
  std::vector<std::vector<std::string>> rows{
      {"back end", "status", "largest torque (N m)", "iterations", "solve (µs)"}};
  if (file.capsule) rows.front().push_back("from the recorded (N m)");
  bool solved = false;
  std::string why;
  for (const Request& request : requests) {
    const Answer found = answer(program.registry(), request, file.problem);
    const control::TickSolution& solution = found.solution;
    solved |= solution.status == control::Status::ok;
    ordered_json entry = toJson(file.problem, request, found);
    const std::string sentence = addConflict(file, solution, entry);
    if (why.empty()) why = sentence;
    if (!solution.message.empty()) std::cerr << "tactus solve: " << request.name << ": " << solution.message << "\n";
    rows.push_back({request.name, dsl::statusName(solution.status), rounded(solution.torque.cwiseAbs().maxCoeff()),
                    std::to_string(solution.iterations), rounded(found.solve_us, 3)});
    if (file.capsule) {
      const Reproduction reproduction(*file.capsule, found);
      entry["capsule"] = {{"reproduced", reproduction.exact}, {"difference_Nm", reproduction.difference}};
      rows.back().push_back(reproduction.exact ? "the same bits" : rounded(reproduction.difference));
    }
    all.push_back(std::move(entry));
  }
  std::cout << (json ? jsonText(all) + "\n" : textTable(rows));
  if (!why.empty()) std::cerr << "tactus solve: " << why << "\n";
  return solved ? exit_done : exit_numerical;
}

int solve(const SolveArguments& arguments, bool json) {
  Program program(arguments.plugins);
  const bool any = arguments.back_end == any_back_end;
  // A word that names no back end is refused whatever the file is.
  if (!any && !arguments.back_end.empty()) program.backEndChoice(arguments.back_end);
  try {
    const dsl::TickFile file = dsl::readTickFile(arguments.file);
    return any ? solveAny(program, file, arguments, json) : solveOne(program, file, arguments, json);
  } catch (const dsl::JsonFileError& error) {
    throw runtime::FileError(arguments.file, error.what());
  }
}

}  // namespace

void addSolve(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("solve", "Solve one tick problem from a file");
  const auto arguments = std::make_shared<SolveArguments>();
  command->add_option("TICK", arguments->file, "A tick problem, JSON of the format tactus-tick/1, or a run's capsule")
      ->required()
      ->type_name("");
  command
      ->add_option("--backend", arguments->back_end,
                   "null-space, qp, qp/nlopt, …; any: all of them; none, or its own: that of a capsule as it was")
      ->type_name("BACKEND");
  for (const char* name : named_options) {
    command->add_option(std::string("--") + name, arguments->named[name], "Option of the back end")
        ->type_name("CHOICE");
  }
  command->add_option("--option", arguments->others, "Any other option of the back end")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  declarePlugins(*command, arguments->plugins);
  command->add_flag("--json", context.json,
                    "{backend, status, torque, contact_forces?, levels, solve_us, conflict?, capsule?, …}");
  command->footer(R"(An infeasible problem prints its JSON all the same, with the tasks that contradict each other
and what would reconcile them, and ends with exit code 5.  A capsule is solved again with the
back end, options and warm start that it recorded; a torque that is not the recorded one to the bit ends with 1.

Examples:
  tactus solve tick.json --backend null-space --projection augmented --inequalities exact --json
  tactus solve tick.json --backend qp/nlopt --objective torque --metric inertia --option force-weight=0.1 --json
  tactus solve runs/press/capsule-21.json
  tactus solve runs/press/capsule-21.json --backend any)");
  command->callback([=, &context] { context.action = [=, &context] { return solve(*arguments, context.json); }; });
}

}  // namespace tactus::app
