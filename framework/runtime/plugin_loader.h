#pragma once

#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/control/registry.h"
#include "framework/runtime/plugin_api.h"

namespace tactus::runtime {

/// A plugin that was not found or was refused; the message says why, lists every path tried and what to do.
class PluginError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct LoadedPlugin {
  std::string name;
  std::string version;
  std::string licence;
  std::string path;                                                ///< of the library, symbolic links followed
  std::vector<std::string> elements;                               ///< that it registered, in its order
  const PluginDescriptor* descriptor = nullptr;
};

/// Loads plugin libraries into a registry.
///
/// A library is opened with RTLD_NOW | RTLD_LOCAL and stays open: what it made may live as long as the program.
/// Its descriptor is checked field by field before any C++ type crosses.  Registration is all or nothing: it runs
/// on a copy of the registry, which replaces the original only when nothing went wrong.
/// Load before reading a stack: a load moves the registry's rows, and ElementValues point at them.
class PluginLoader {
 public:
  /// `folders` are searched in order for plugins that are asked for by name.  Plugins outside `shipped_folder` name
  /// each of their elements with their own name and a dot, <acme.wiggle>; "" = there are no shipped ones.
  PluginLoader(control::Registry& registry, std::vector<std::string> folders, const std::string& shipped_folder = "");

  /// Loads the library at `path`; a library that is loaded already is not loaded again.
  const LoadedPlugin& loadFile(const std::string& path);
  /// Loads NAME.so from the first folder that has it; nothing to do when NAME is loaded already.
  const LoadedPlugin& loadNamed(const std::string& name);
  /// Loads every library of a folder in the order of their names, but not those whose name is loaded already:
  /// a plugin that the user named goes before the shipped one.
  void loadFolder(const std::string& folder);

  const std::deque<LoadedPlugin>& loaded() const { return loaded_; }
  const std::vector<std::string>& folders() const { return folders_; }

 private:
  const LoadedPlugin* find(const std::string& name) const;
  /// `expected_name` is what the library must call itself; "" = any.
  const LoadedPlugin& load(const std::string& path, const std::string& expected_name);

  control::Registry& registry_;
  std::vector<std::string> folders_;
  std::string shipped_folder_;                                     ///< symbolic links followed
  std::deque<LoadedPlugin> loaded_;                                ///< a deque: references to its entries stay valid
};

}  // namespace tactus::runtime
