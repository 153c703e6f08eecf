#include <algorithm>
#include <iostream>
#include <optional>

#include "apps/tactus/command.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"
#include "conformance/conformance.h"
#include "dsl/element_text.h"

#include <nlohmann/json.hpp>

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

/// What `info` and `check` call the tasks and signals that no plugin brings.
constexpr const char* built_in = "built-in";

ordered_json describe(const runtime::LoadedPlugin& plugin) {
  return {{"name", plugin.name},
          {"version", plugin.version},
          {"licence", plugin.licence},
          {"path", plugin.path},
          {"elements", plugin.elements},
          {"framework_version", plugin.descriptor->framework_version},
          {"abi", plugin.descriptor->abi},
          {"compiler", plugin.descriptor->compiler},
          {"eigen_version", plugin.descriptor->eigen_version},
          {"eigen_max_align", plugin.descriptor->eigen_max_align}};
}

int list(const std::vector<std::string>& paths, bool json) {
  Program program(paths);
  const std::vector<std::string> refused = program.loadFolders();
  ordered_json plugins = ordered_json::array();
  std::vector<std::vector<std::string>> rows{{"plugin", "version", "licence", "elements", "library"}};
  for (const runtime::LoadedPlugin& plugin : program.plugins().loaded()) {
    plugins.push_back(describe(plugin));
    rows.push_back({plugin.name, plugin.version, plugin.licence, joined(plugin.elements), plugin.path});
  }
  if (json) {
    const ordered_json all{{"plugins", plugins}, {"refused", refused}, {"searched", program.plugins().folders()}};
    std::cout << jsonText(all, 2) << "\n";
  } else {
    std::cout << textTable(rows);
    std::cerr << "searched: " << joined(program.plugins().folders()) << "\n";
  }
  for (const std::string& refusal : refused) std::cerr << "refused: " << refusal << "\n";
  return refused.empty() ? exit_done : exit_plugin;
}

/// What `info` and `check` were asked about.
struct Chosen {
  Chosen(const std::string& asked, std::vector<std::string> paths) : program(withFile(asked, std::move(paths))) {
    if (asked == built_in) {
      for (const control::ElementRow& row : program.registry().elements().rows()) {
        const bool made = row.kind != control::ElementKind::structure;
        if (made && !ofPlugin(row.name)) elements.push_back(row.name);
      }
      return;
    }
    plugin = isFile(asked) ? &program.plugins().loadFile(asked) : &program.plugins().loadNamed(asked);
    elements = plugin->elements;
  }

  static bool isFile(const std::string& asked) {
    return asked.find('/') != std::string::npos || asked.ends_with(".so");
  }
  /// A file that is asked for is loaded first.
  static std::vector<std::string> withFile(const std::string& asked, std::vector<std::string> paths) {
    if (isFile(asked)) paths.insert(paths.begin(), asked);
    return paths;
  }
  bool ofPlugin(const std::string& element) const {
    for (const runtime::LoadedPlugin& loaded : program.plugins().loaded())
      for (const std::string& its : loaded.elements)
        if (its == element) return true;
    return false;
  }

  Program program;
  const runtime::LoadedPlugin* plugin = nullptr;                   ///< null for the built-ins
  std::vector<std::string> elements;
};

int info(const std::string& asked, const std::vector<std::string>& paths, bool json) {
  Chosen chosen(asked, paths);
  ordered_json out = chosen.plugin ? describe(*chosen.plugin) : ordered_json{{"name", built_in}};
  ordered_json elements = ordered_json::array();
  std::string text;
  if (chosen.plugin) {
    const runtime::PluginDescriptor& descriptor = *chosen.plugin->descriptor;
    text = textTable({{"plugin", chosen.plugin->name + " " + chosen.plugin->version},
                      {"licence", chosen.plugin->licence},
                      {"library", chosen.plugin->path},
                      {"Tactus", descriptor.framework_version},
                      {"plugin ABI", std::to_string(descriptor.abi)},
                      {"compiler", descriptor.compiler},
                      {"Eigen", std::to_string(descriptor.eigen_version / 10000) + "." +
                                    std::to_string(descriptor.eigen_version / 100 % 100) + "." +
                                    std::to_string(descriptor.eigen_version % 100) + ", aligned to " +
                                    std::to_string(descriptor.eigen_max_align) + " bytes"}});
  }
  for (const control::ElementRow& row : chosen.program.registry().elements().rows()) {
    if (std::find(chosen.elements.begin(), chosen.elements.end(), row.name) == chosen.elements.end()) continue;
    elements.push_back(dsl::elementJson(row));
    text += (text.empty() ? "" : "\n") + dsl::elementText(row);
  }
  out["elements"] = elements;
  std::cout << (json ? out.dump(2) + "\n" : text);
  return exit_done;
}

int check(const std::string& asked, StackOptions stack_options, const std::vector<std::string>& paths, bool json) {
  Chosen chosen(asked, paths);
  std::optional<dsl::Stack> stack;
  if (!stack_options.file.empty()) stack = chosen.program.read(stack_options);
  const conformance::Report report =
      conformance::checkElements(chosen.program.registry(), chosen.elements, stack ? &*stack : nullptr);
  if (json) {
    ordered_json findings = ordered_json::array();
    for (const conformance::Finding& finding : report.findings) {
      findings.push_back({{"element", finding.element},
                          {"instance", finding.instance},
                          {"law", finding.law},
                          {"outcome", conformance::nameOf(finding.outcome)},
                          {"message", finding.message}});
    }
    ordered_json out{{"plugin", chosen.plugin ? chosen.plugin->name : built_in}, {"conforms", report.conforms()}};
    if (stack) out["stack"] = stack_options.file;
    out["findings"] = findings;
    std::cout << out.dump(2) << "\n";
  } else {
    std::cout << report.text() << (report.conforms() ? "conforms\n" : "does not conform\n");
  }
  return report.conforms() ? exit_done : exit_mismatch;
}

}  // namespace

void addPlugins(CLI::App& program, Context& context) {
  CLI::App* command =
      program.add_subcommand("plugins", "What is loaded besides the built-in tasks, and whether it keeps the laws");
  command->require_subcommand(0, 1);
  constexpr const char* examples =
      R"(Exit codes: 0 done; 1 a law is broken (check); 4 a library cannot be loaded.

Examples:
  tactus plugins list
  tactus plugins list --plugin build/acme.so --json
  tactus plugins info build/acme.so
  tactus plugins check build/acme.so --stack stack.xml
  tactus plugins check built-in)";
  command->footer(examples);
  const auto paths = std::make_shared<std::vector<std::string>>();
  const auto asked = std::make_shared<std::string>();
  const auto stack = std::make_shared<StackOptions>();
  constexpr const char* what = "A library, the name of a plugin, or built-in";

  CLI::App* list_command = command->add_subcommand("list", "Every loaded plugin with its elements and its library");
  declarePlugins(*list_command, *paths);
  list_command->add_flag("--json", context.json,
                         "{plugins: [{name, version, licence, path, elements, …}], refused, searched}");
  list_command->footer(examples);
  list_command->callback([=, &context] { context.action = [=, &context] { return list(*paths, context.json); }; });

  CLI::App* info_command = command->add_subcommand("info", "What a plugin was built with, and its elements");
  info_command->add_option("NAME|FILE", *asked, what)->required()->type_name("");
  declarePlugins(*info_command, *paths);
  info_command->add_flag("--json", context.json, "{name, version, …, elements: [{name, kind, attributes, …}]}");
  info_command->footer(examples);
  info_command->callback(
      [=, &context] { context.action = [=, &context] { return info(*asked, *paths, context.json); }; });

  CLI::App* check_command = command->add_subcommand(
      "check", "The laws that every task, signal and back end keeps: Jacobian, frames, memory, determinism, …");
  check_command->add_option("NAME|FILE", *asked, what)->required()->type_name("");
  check_command->add_option("--stack", stack->file, "A stack with instances of its elements; else made from defaults")
      ->type_name("FILE");
  declarePlugins(*check_command, *paths);
  check_command->add_flag("--json", context.json,
                          "{plugin, conforms, stack?, findings: [{element, instance, law, outcome, message}]}");
  check_command->footer(examples);
  check_command->callback(
      [=, &context] { context.action = [=, &context] { return check(*asked, *stack, *paths, context.json); }; });
}

}  // namespace tactus::app
