#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/tactus/command.h"
#include "apps/tactus/explain_tick.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "dsl/element_text.h"
#include "dsl/nearest_name.h"

namespace tactus::app {
namespace {

using control::ElementRow;
using nlohmann::ordered_json;

struct ExplainArguments {
  std::string type;
  StackOptions stack;                                              ///< with --at
  std::optional<double> at;                                        ///< s
  std::vector<std::string> plugins;
};

int list(const control::ElementTable& table, bool json) {
  ordered_json all = ordered_json::array();
  std::string out;
  for (const dsl::KindText& kind : dsl::kindTexts()) {
    out += (out.empty() ? "" : "\n") + std::string(kind.heading) + "\n";
    for (const ElementRow& row : table.rows()) {
      if (row.kind != kind.kind) continue;
      all.push_back({{"name", row.name}, {"kind", kind.key}, {"description", row.description}});
      out += "  " + row.name + ": " + row.description + "\n";
    }
  }
  std::cout << (json ? ordered_json{{"elements", all}}.dump(2) + "\n" : out);
  return exit_done;
}

int explain(const ExplainArguments& arguments, bool json) {
  if (arguments.at) {
    if (arguments.type.empty()) throw UsageError("--at needs the stack or the run folder that it asks about");
    ExplainTickArguments tick{arguments.stack, arguments.plugins, *arguments.at};
    tick.stack.file = arguments.type;
    return explainTick(tick, json);
  }
  Program program(arguments.plugins);
  for (const std::string& refusal : program.loadFolders()) std::cerr << "refused: " << refusal << "\n";
  const control::ElementTable& table = program.registry().elements();
  if (arguments.type.empty()) return list(table, json);

  std::vector<std::string> names;
  ordered_json found = ordered_json::array();
  std::string out;
  for (const ElementRow& row : table.rows()) {
    names.push_back(row.name);
    if (row.name != arguments.type) continue;
    found.push_back(dsl::elementJson(row));
    out += (out.empty() ? "" : "\n") + dsl::elementText(row);
  }
  if (found.empty()) {
    if (std::filesystem::exists(arguments.type))
      throw UsageError("'" + arguments.type + "' is a file: --at SECONDS says which tick of it is explained");
    const std::string nearest = dsl::nearestName(arguments.type, names);
    const std::string hint = nearest.empty() ? "'tactus explain' lists what there is" : "did you mean '" + nearest + "'?";
    throw UsageError("nothing is called '" + arguments.type + "'; " + hint);
  }
  std::cout << (json ? ordered_json{{"elements", found}}.dump(2) + "\n" : out);
  return exit_done;
}

}  // namespace

void addExplain(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand(
      "explain", "What an element means and takes, or who took whose freedom in a tick; alone: all elements");
  const auto arguments = std::make_shared<ExplainArguments>();
  command
      ->add_option("TYPE|STACK|RUN", arguments->type,
                   "An element or a back end: impedance, level, sphere, qp, …; with --at a stack or a run folder")
      ->type_name("");
  command->add_option("--at", arguments->at, "Run to this time and print the priority x-ray of its tick")
      ->type_name("SECONDS")
      ->check(timeOfTick());
  command->add_option("--backend", arguments->stack.back_end, "Back end instead of the stack's")->type_name("BACKEND");
  command->add_option("--seed", arguments->stack.seed, "Seed of the scene's jitter; the stack's own without it")
      ->type_name("N")
      ->check(seed());
  command->add_option("--set", arguments->stack.set, "Give a <parameter> of the stack another value")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  declarePlugins(*command, arguments->plugins);
  command->add_flag("--json", context.json,
                    "{elements: [{name, kind, description, source?, attributes, ports, children}]}; with --at {time, "
                    "levels, tasks, limits, …}");
  command->footer(R"(The x-ray tells for each task the rank that it wanted and was granted, the directions that it lost
and to whom, active inequalities, torque limits, and torque by task.  Of a run folder the stack runs again and its log
is checked.

Examples:
  tactus explain
  tactus explain impedance
  tactus explain acme.wiggle --plugin build/acme.so --json
  tactus explain examples/explore_table/stack.xml --at 2.5
  tactus explain runs/explore-table-null-space-seed1 --at 2.5 --json)");
  command->callback([=, &context] { context.action = [=, &context] { return explain(*arguments, context.json); }; });
}

}  // namespace tactus::app
