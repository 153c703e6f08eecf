#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/tactus/command.h"
#include "apps/tactus/explain_tick.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "dsl/nearest_name.h"

namespace tactus::app {
namespace {

using control::AttributeRow;
using control::ElementKind;
using control::ElementRow;
using control::ValueType;
using nlohmann::ordered_json;

struct ExplainArguments {
  std::string type;
  StackOptions stack;                                              ///< with --at
  std::optional<double> at;                                        ///< s
  std::vector<std::string> plugins;
};

struct KindText {
  ElementKind kind;
  const char* key;
  const char* heading;
};

constexpr KindText kinds[] = {{ElementKind::structure, "structure", "structure"},
                              {ElementKind::shape, "shape", "shapes, in <object>"},
                              {ElementKind::signal, "signal", "signals, in <signals>"},
                              {ElementKind::task, "task", "tasks, in <level>"},
                              {ElementKind::back_end, "back-end", "back ends, by <controller backend>"}};

const KindText& textOf(ElementKind kind) {
  for (const KindText& text : kinds) {
    if (text.kind == kind) return text;
  }
  return kinds[0];
}

const char* nameOf(ValueType type) {
  switch (type) {
    case ValueType::text: return "text";
    case ValueType::identifier: return "name";
    case ValueType::flag: return "true or false";
    case ValueType::integer: return "integer";
    case ValueType::real: return "number";
    case ValueType::reals: return "numbers";
    case ValueType::points: return "points";
    case ValueType::choice: return "choice";
    case ValueType::port: return "port";
    case ValueType::link: return "link";
    case ValueType::links: return "links or groups";
    case ValueType::joints: return "joints or groups";
    case ValueType::object: return "object";
    case ValueType::element_class: return "class";
    case ValueType::file: return "file";
  }
  return "";
}

/// "3 numbers", "points of 3 numbers", "port of type contact-set"
std::string typeOf(const AttributeRow& row) {
  const std::string count = std::to_string(row.count);
  if (row.type == ValueType::reals && row.count > 0) return count + " numbers";
  if (row.type == ValueType::points) return "points of " + count + " numbers, separated by ';'";
  if (row.type == ValueType::port) return "port of type " + row.port_type;
  return nameOf(row.type);
}

/// "> 0, ≤ 1"; "" where any number may stand.
std::string rangeOf(const AttributeRow& row) {
  std::string text;
  if (std::isfinite(row.lower)) text += (row.lower_open ? "> " : "≥ ") + control::formatNumber(row.lower);
  if (std::isfinite(row.upper)) text += (text.empty() ? "≤ " : ", ≤ ") + control::formatNumber(row.upper);
  return text;
}

std::string unitOf(const AttributeRow& row) { return row.unit == "1" ? "" : row.unit; }

ordered_json describe(const AttributeRow& row) {
  ordered_json json{{"name", row.name}, {"type", typeOf(row)}, {"required", row.required}};
  if (!row.unit.empty()) json["unit"] = row.unit;
  if (row.default_text) json["default"] = *row.default_text;
  if (std::isfinite(row.lower)) json[row.lower_open ? "greater_than" : "lower"] = row.lower;
  if (std::isfinite(row.upper)) json["upper"] = row.upper;
  if (!row.choices.empty()) json["choices"] = row.choices;
  json["description"] = row.description;
  return json;
}

ordered_json describe(const ElementRow& row) {
  ordered_json json{{"name", row.name}, {"kind", textOf(row.kind).key}, {"description", row.description}};
  if (!row.source.empty()) json["source"] = row.source;
  json["attributes"] = ordered_json::array();
  for (const AttributeRow& attribute : row.attributes) json["attributes"].push_back(describe(attribute));
  json["ports"] = ordered_json::array();
  for (const control::PortRow& port : row.ports) {
    json["ports"].push_back(
        {{"name", port.name}, {"type", port.type}, {"unit", port.unit}, {"description", port.description}});
  }
  json["children"] = ordered_json::array();
  for (const control::ChildRow& child : row.children) json["children"].push_back(child.element);
  return json;
}

std::string childText(const control::ChildRow& child) {
  const bool kind = child.element.starts_with("@");
  const std::string text = kind ? "any " + child.element.substr(1) : "<" + child.element + ">";
  const std::string least = std::to_string(child.min), most = std::to_string(child.max);
  if (child.min == child.max) return text + " (" + least + ")";
  if (child.min > 0) return text + " (at least " + least + ")";
  return child.max < 0 ? text : text + " (at most " + most + ")";
}

/// One attribute: what may be written on the first line, what it means below.
std::string text(const AttributeRow& row) {
  std::vector<std::string> facts{typeOf(row)};
  if (!unitOf(row).empty()) facts.push_back(unitOf(row));
  if (!rangeOf(row).empty()) facts.push_back(rangeOf(row));
  if (!row.choices.empty()) {
    facts.push_back((row.type == ValueType::choice ? "one of " : "or ") + joined(row.choices, " | "));
  }
  if (row.required) facts.push_back("required");
  if (row.default_text) facts.push_back("default " + (row.default_text->empty() ? "empty" : *row.default_text));
  return "  " + row.name + ": " + joined(facts, "; ") + "\n" +
         (row.description.empty() ? "" : "      " + row.description + "\n");
}

std::string text(const ElementRow& row) {
  const bool back_end = row.kind == ElementKind::back_end;
  std::string out = (back_end ? "backend=\"" + row.name + "\"" : "<" + row.name + ">") + ": " + row.description + "\n";
  if (!row.source.empty()) out += "source: " + row.source + "\n";
  if (!row.attributes.empty()) out += back_end ? "\noptions, attributes of <controller>\n" : "\nattributes\n";
  for (const AttributeRow& attribute : row.attributes) out += text(attribute);
  if (row.takes_back_end_options) out += "  and the options of the back end that `backend` names\n";
  if (!row.ports.empty()) out += "\nports, read as signal.port\n";
  for (const control::PortRow& port : row.ports) {
    const bool has_unit = !port.unit.empty() && port.unit != "1";
    out += "  " + port.name + ": " + port.type + (has_unit ? "; " + port.unit : "") + "\n" +
           (port.description.empty() ? "" : "      " + port.description + "\n");
  }
  if (!row.children.empty()) out += "\nchildren\n";
  for (const control::ChildRow& child : row.children) out += "  " + childText(child) + "\n";
  return out;
}

int list(const control::ElementTable& table, bool json) {
  ordered_json all = ordered_json::array();
  std::string out;
  for (const KindText& kind : kinds) {
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
    found.push_back(describe(row));
    out += (out.empty() ? "" : "\n") + text(row);
  }
  if (found.empty()) {
    if (std::filesystem::exists(arguments.type))
      throw UsageError("'" + arguments.type + "' is a file: --at SECONDS says which tick of it is explained");
    const std::string nearest = dsl::nearestName(arguments.type, names);
    const std::string hint = nearest.empty() ? "'tactus explain' lists what there is" : "did you mean '" + nearest + "'?";
    throw UsageError("nothing is called '" + arguments.type + "'; " + hint);
  }
  std::cout << (json ? jsonText(ordered_json{{"elements", found}}, 2) + "\n" : out);
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
