#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dsl/diagnostic.h"
#include "dsl/stack.h"
#include "framework/control/registry.h"

namespace tactus::dsl {

/// Simulated seconds that a run takes at most.
inline constexpr double longest_run = 1e6;

struct ReadOptions {
  std::map<std::string, std::string> set;         ///< --set name=value: overrides <parameter>; unknown names are errors
  std::vector<std::string> include_folders;                        ///< besides the stack's own, where includes may lie
  std::vector<std::string> model_path;                     ///< folders searched for robot models, after the stack's own
  /// Loads the plugin that <plugin name> asks for into the registry; throws std::runtime_error with the reason.
  std::function<void(const std::string& name)> load_plugin;
  std::string backend;                                        ///< --backend: replaces the controller's; "" = as written
  double plant_step = 0;                                           ///< s; a tick is a whole number of them; 0 = any rate
  std::map<std::string, std::string> backend_options;             ///< option=value for that back end, e.g. solver=nlopt
};

/// Adds the structural elements (<stack>, <robot>, <scene>, <level>, <controller>, …) and the built-in shapes.
void addStructureElements(control::Registry& registry);

/// Reads and checks a stack.  Throws InvalidStack with every error found.  Warnings go to `warnings` when given.
Stack readStack(const std::string& file, control::Registry& registry, const ReadOptions& options,
                std::vector<Diagnostic>* warnings = nullptr);

/// The stack with every parameter, class, include and default resolved, as XML that reads back to the same Stack.
std::string writeResolved(const Stack& stack);

}  // namespace tactus::dsl
