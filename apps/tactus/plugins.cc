#include <iostream>

#include "apps/tactus/command.h"
#include "apps/tactus/program.h"
#include "apps/tactus/stack_arguments.h"
#include "apps/tactus/text.h"

#include <nlohmann/json.hpp>

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

int list(const std::vector<std::string>& paths, bool json) {
  Program program(paths);
  const std::vector<std::string> refused = program.loadFolders();
  ordered_json plugins = ordered_json::array();
  std::vector<std::vector<std::string>> rows{{"plugin", "version", "licence", "elements", "library"}};
  for (const runtime::LoadedPlugin& plugin : program.plugins().loaded()) {
    plugins.push_back({{"name", plugin.name},
                       {"version", plugin.version},
                       {"licence", plugin.licence},
                       {"path", plugin.path},
                       {"elements", plugin.elements},
                       {"framework_version", plugin.descriptor->framework_version},
                       {"abi", plugin.descriptor->abi},
                       {"compiler", plugin.descriptor->compiler},
                       {"eigen_max_align", plugin.descriptor->eigen_max_align}});
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

}  // namespace

void addPlugins(CLI::App& program, Context& context) {
  CLI::App* command = program.add_subcommand("plugins", "What is loaded besides the built-in tasks");
  CLI::App* list_command = command->add_subcommand("list", "Every loaded plugin with its elements and its library");
  const auto paths = std::make_shared<std::vector<std::string>>();
  declarePlugins(*list_command, *paths);
  list_command->add_flag("--json", context.json,
                         "{plugins: [{name, version, licence, path, elements, …}], refused, searched}");
  command->require_subcommand(0, 1);
  constexpr const char* examples =
      R"(Exit code 4 when a library of a searched folder is refused.

Examples:
  tactus plugins list
  tactus plugins list --plugin build/acme.so --json)";
  command->footer(examples);
  list_command->footer(examples);
  list_command->callback([=, &context] { context.action = [=, &context] { return list(*paths, context.json); }; });
}

}  // namespace tactus::app
