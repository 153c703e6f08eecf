#include "apps/tactus/program.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/tactus/command.h"
#include "apps/tactus/text.h"
#include "dsl/read_study.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/program_path.h"
#include "sim/simbody_plant.h"
#include "tasks/register_tasks.h"

namespace tactus::app {
namespace {

/// Folders where plugins are looked up by name, in order.
std::vector<std::string> pluginFolders(const std::vector<std::string>& explicit_plugins) {
  std::vector<std::string> folders;
  for (const std::string& path : explicit_plugins) {
    if (std::filesystem::is_directory(path)) folders.push_back(path);
  }
  for (std::string& folder : runtime::foldersFromEnvironment("TACTUS_PLUGIN_PATH"))
    folders.push_back(std::move(folder));
  folders.push_back(runtime::shippedPluginFolder());
  return folders;
}

/// The option of a back end that has `word` among its choices.
std::string optionWithChoice(const control::ElementRow& row, const std::string& word) {
  std::vector<std::string> choices;
  for (const control::AttributeRow& attribute : row.attributes) {
    for (const std::string& choice : attribute.choices) {
      if (choice == word) return attribute.name;
      choices.push_back(choice);
    }
  }
  throw UsageError("back end '" + row.name + "' has no variant '" + word + "'; variants: " + joined(choices));
}

std::map<std::string, std::string> parseSettings(const std::vector<std::string>& settings) {
  std::map<std::string, std::string> values;
  for (const std::string& setting : settings) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos || equals == 0) throw UsageError("--set " + setting + ": expected name=value");
    values[setting.substr(0, equals)] = setting.substr(equals + 1);
  }
  return values;
}

}  // namespace

Program::Program(const std::vector<std::string>& plugins)
    : plugins_(registry_, pluginFolders(plugins), runtime::shippedPluginFolder()) {
  dsl::addStructureElements(registry_);
  dsl::addStudyElements(registry_);
  tasks::registerBuiltIns(registry_);
  for (const std::string& path : plugins) {
    if (!std::filesystem::is_directory(path)) plugins_.loadFile(path);
  }
  plugins_.loadFolder(runtime::shippedPluginFolder());
}

std::vector<std::string> Program::loadFolders() {
  std::vector<std::string> refusals;
  for (const std::string& folder : plugins_.folders()) {
    std::error_code error;
    std::vector<std::filesystem::path> libraries;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".so") libraries.push_back(entry.path());
    }
    std::sort(libraries.begin(), libraries.end());
    for (const std::filesystem::path& library : libraries) {
      try {
        plugins_.loadFile(library.string());
      } catch (const runtime::PluginError& refusal) {
        refusals.emplace_back(refusal.what());
      }
    }
  }
  return refusals;
}

std::vector<std::string> Program::modelPath() const {
  std::vector<std::string> folders = runtime::foldersFromEnvironment("TACTUS_MODEL_PATH");
  folders.push_back(runtime::shippedModelFolder());
  return folders;
}

std::vector<std::string> Program::includeFolders() const {
  return runtime::foldersFromEnvironment("TACTUS_INCLUDE_PATH");
}

const control::ElementRow& Program::backEndRow(const std::string& name) const {
  const control::ElementRow* row = registry_.elements().findBackEnd(name);
  if (!row) {
    throw UsageError("there is no back end '" + name +
                     "'; back ends: " + joined(registry_.names(control::ElementKind::back_end)));
  }
  return *row;
}

BackEndChoice Program::backEndChoice(const std::string& label) const {
  std::vector<std::string> parts = split(label, '/');
  BackEndChoice choice{label, parts.front(), {}};
  const control::ElementRow& row = backEndRow(choice.name);
  for (size_t i = 1; i < parts.size(); ++i) {
    const size_t equals = parts[i].find('=');
    if (equals == std::string::npos) {
      choice.options[optionWithChoice(row, parts[i])] = parts[i];
    } else {
      choice.options[parts[i].substr(0, equals)] = parts[i].substr(equals + 1);
    }
  }
  return choice;
}

dsl::Stack Program::read(const StackOptions& options, std::vector<dsl::Diagnostic>* warnings) {
  // A file that is not there is no invalid stack.  A pipe is read once.
  if (std::filesystem::is_directory(options.file) || ::access(options.file.c_str(), R_OK) != 0)
    runtime::readFile(options.file);
  dsl::ReadOptions read;
  read.set = parseSettings(options.set);
  read.model_path = modelPath();
  read.include_folders = includeFolders();
  read.plant_step = sim::PlantOptions().step;
  read.load_plugin = [this](const std::string& name) { plugins_.loadNamed(name); };
  if (!options.back_end.empty()) {
    const BackEndChoice choice = backEndChoice(options.back_end);
    read.backend = choice.name;
    read.backend_options = choice.options;
  }
  dsl::Stack stack = dsl::readStack(options.file, registry_, read, warnings);
  if (options.duration) {
    const double rate = stack.controller.values.real("rate");
    if (std::lround(*options.duration * rate) < 1) {
      throw UsageError("--duration " + rounded(*options.duration) + " is shorter than one tick of " +
                       rounded(1 / rate) + " s");
    }
    stack.run.duration = *options.duration;
  }
  if (options.seed) stack.run.seed = *options.seed;
  return stack;
}

}  // namespace tactus::app
