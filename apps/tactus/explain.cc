#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/tactus/command.h"
#include "apps/tactus/explain_stack.h"
#include "apps/tactus/explain_tick.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "dsl/codes.h"
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
  bool resolved = false;
  std::vector<std::string> plugins;
};

/// What stands for a file, rather than for the name of an element.
bool isFile(const std::string& type) { return type.ends_with(".xml") || type.find('/') != std::string::npos; }

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
  std::cout << (json ? jsonText(ordered_json{{"elements", all}}, 2) + "\n" : out);
  return exit_done;
}

/// "'held' is a port of contacts", "" where nothing has an attribute or a port of that name.
std::string ownersOf(const std::string& name, const control::ElementTable& table) {
  std::vector<std::string> attribute_of, port_of;
  for (const ElementRow& row : table.rows()) {
    if (row.attribute(name)) attribute_of.push_back(row.name);
    for (const control::PortRow& port : row.ports)
      if (port.name == name) port_of.push_back(row.name);
  }
  const auto owners = [&](const char* what, std::vector<std::string> rows) {
    constexpr size_t most = 6;
    const bool many = rows.size() > most;
    if (many) rows.resize(most);
    return rows.empty() ? "" : "'" + name + "' is " + what + " of " + joined(rows) + (many ? ", …" : "");
  };
  const std::string attribute = owners("an attribute", attribute_of), port = owners("a port", port_of);
  return attribute + (attribute.empty() || port.empty() ? "" : " and ") + port;
}

/// What may help somebody who asked for what is no element: an attribute or port, alone or as signal.port, or a slip.
std::string hintFor(const std::string& asked, const control::ElementTable& table) {
  const std::string word = asked.substr(asked.find('.') == std::string::npos ? 0 : asked.find('.') + 1);
  if (const std::string owners = ownersOf(word, table); !owners.empty()) return owners;
  std::vector<std::string> elements, parts;
  for (const ElementRow& row : table.rows()) {
    elements.push_back(row.name);
    for (const control::AttributeRow& attribute : row.attributes) parts.push_back(attribute.name);
    for (const control::PortRow& port : row.ports) parts.push_back(port.name);
  }
  if (const std::string near = dsl::nearestName(asked, elements); !near.empty()) return "did you mean '" + near + "'?";
  if (const std::string near = dsl::nearestName(word, parts); !near.empty())
    return "did you mean '" + near + "'? " + ownersOf(near, table);
  return "'tactus explain' lists what there is";
}

int explain(const ExplainArguments& arguments, bool json) {
  if (arguments.at) {
    if (arguments.type.empty()) throw UsageError("--at needs the stack or the run folder that it asks about");
    ExplainTickArguments tick{arguments.stack, arguments.plugins, *arguments.at};
    tick.stack.file = arguments.type;
    return explainTick(tick, json);
  }
  const bool stack = std::filesystem::is_regular_file(arguments.type) || isFile(arguments.type);
  if (arguments.resolved && arguments.type.empty()) throw UsageError("--resolved needs the stack that it asks about");
  if (arguments.resolved || stack) {
    if (std::filesystem::is_directory(arguments.type))
      throw UsageError("'" + arguments.type + "' is a folder: --at SECONDS says which tick of a run is explained");
    StackOptions options = arguments.stack;
    options.file = arguments.type;
    return explainStack(options, arguments.plugins, json);
  }
  Program program(arguments.plugins);
  for (const std::string& refusal : program.loadFolders()) std::cerr << "refused: " << refusal << "\n";
  const control::ElementTable& table = program.registry().elements();
  if (arguments.type.empty()) return list(table, json);

  ordered_json found = ordered_json::array();
  std::string out;
  for (const ElementRow& row : table.rows()) {
    if (row.name != arguments.type) continue;
    found.push_back(dsl::elementJson(row));
    out += (out.empty() ? "" : "\n") + dsl::elementText(row);
  }
  for (const dsl::Code& code : dsl::all_codes) {
    if (arguments.type != code.id) continue;
    found.push_back({{"code", code.id}, {"meaning", code.meaning}});
    out = std::string(code.id) + ": " + code.meaning + "\ndocs/messages.md tells how it comes about and what to do\n";
  }
  if (found.empty()) {
    if (std::filesystem::is_directory(arguments.type))
      throw UsageError("'" + arguments.type + "' is a folder: --at SECONDS says which tick of a run is explained");
    throw UsageError("no element is called '" + arguments.type + "'; " + hintFor(arguments.type, table));
  }
  std::cout << (json ? jsonText(ordered_json{{"elements", found}}, 2) + "\n" : out);
  return exit_done;
}

}  // namespace

void addExplain(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand(
      "explain",
      "What an element means and takes, what a stack's values are and where they come from, or who took whose freedom in "
      "a tick; alone: all elements");
  const auto arguments = std::make_shared<ExplainArguments>();
  command
      ->add_option("TYPE|STACK|RUN", arguments->type,
                   "An element or a back end: impedance, level, sphere, qp, …; a stack; with --at a stack or a run folder")
      ->type_name("");
  command->add_flag("--resolved", arguments->resolved,
                    "Of a stack: every value after includes, parameters, classes and defaults, with its origin (a stack's "
                    "file without --at means this)");
  command->add_option("--at", arguments->at, "Run to this time and print the priority x-ray of its tick")
      ->type_name("SECONDS")
      ->check(timeOfTick());
  command->add_option("--backend", arguments->stack.back_end, "Back end instead of the stack's")->type_name("BACKEND");
  command->add_option("--seed", arguments->stack.seed, "Seed of the jitter of scene and start; the stack's own without it")
      ->type_name("N")
      ->check(seed());
  command->add_option("--set", arguments->stack.set, "Give a <parameter> of the stack another value")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  declarePlugins(*command, arguments->plugins);
  command->add_flag("--json", context.json,
                    "{elements: [{name, kind, description, source?, attributes, ports, children}]}; of a stack "
                    "{stack, elements: [{element, path, values: [{name, value, origin, …}]}]}; with --at {time, levels, "
                    "tasks, limits, …}");
  command->footer(R"(The x-ray tells for each task the rank that it wanted and was granted, the directions that it lost
and to whom, active inequalities, torque limits, and torque by task.  Of a run folder the stack runs again and its log
is checked.

Examples:
  tactus explain
  tactus explain impedance
  tactus explain acme.wiggle --plugin build/acme.so --json
  tactus explain examples/explore_table/stack.xml --set press=1
  tactus explain examples/explore_table/stack.xml --at 2.5
  tactus explain runs/explore-table-null-space-seed1 --at 2.5 --json)");
  command->callback([=, &context] { context.action = [=, &context] { return explain(*arguments, context.json); }; });
}

}  // namespace tactus::app
