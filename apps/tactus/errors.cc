#include "apps/tactus/errors.h"

#include <filesystem>
#include <iostream>

#include "apps/tactus/interrupt.h"
#include "apps/tactus/text.h"
#include "framework/control/controller.h"
#include "framework/dynamics/model.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/part_error.h"
#include "framework/runtime/plant.h"
#include "framework/runtime/plugin_loader.h"

namespace tactus::app {
namespace {

using nlohmann::ordered_json;

int say(const Context& context, int code, const std::string& message) {
  std::cerr << "tactus: " << message << "\n";
  if (context.json) {
    const ordered_json error{{"message", message}};
    std::cout << jsonText(ordered_json{{"errors", ordered_json::array({error})}}, 2) << "\n";
  }
  return code;
}

}  // namespace

ordered_json toJson(const dsl::Diagnostic& diagnostic) {
  ordered_json json{{"file", diagnostic.place.file},
                    {"line", diagnostic.place.line},
                    {"column", diagnostic.place.column},
                    {"code", diagnostic.code},
                    {"message", diagnostic.message}};
  if (!diagnostic.suggestion.empty()) json["suggestion"] = diagnostic.suggestion;
  return json;
}

int exitCode(const std::vector<dsl::Diagnostic>& diagnostics) {
  for (const dsl::Diagnostic& diagnostic : diagnostics) {
    if (diagnostic.severity == dsl::Severity::error) return diagnostic.exit_code;
  }
  return exit_done;
}

std::string located(const description::Place& place, const std::string& message) {
  if (place.line == 0) return message;
  return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) + ": " + message;
}

int reportErrors(const Context& context) {
  try {
    return context.action();
  } catch (const dsl::InvalidStack& invalid) {
    ordered_json errors = ordered_json::array();
    for (const dsl::Diagnostic& diagnostic : invalid.diagnostics) {
      std::cerr << dsl::render(diagnostic) << "\n";
      errors.push_back(toJson(diagnostic));
    }
    if (context.json) std::cout << jsonText(ordered_json{{"errors", errors}}, 2) << "\n";
    return exitCode(invalid.diagnostics);
  } catch (const UsageError& error) {
    return say(context, exit_usage, error.what());
  } catch (const Interrupted& error) {
    return say(context, exit_interrupted, error.what());
  } catch (const runtime::PluginError& error) {
    return say(context, exit_plugin, error.what());
  } catch (const control::TickError& error) {
    return say(context, exit_plugin, error.what());
  } catch (const runtime::PartError& error) {
    return say(context, exit_plugin, error.what());
  } catch (const dynamics::ModelError& error) {
    return say(context, exit_invalid_stack, located(error.place, error.what()));
  } catch (const NumericalError& error) {
    return say(context, exit_numerical, error.what());
  } catch (const runtime::PlantError& error) {
    return say(context, exit_numerical, error.what());
  } catch (const runtime::FileError& error) {
    return say(context, exit_files, error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return say(context, exit_files, error.path1().string() + ": " + error.code().message());
  } catch (const std::exception& error) {
    return say(context, exit_numerical, std::string("internal error: ") + error.what());
  }
}

}  // namespace tactus::app
