#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dsl/read_stack.h"
#include "framework/control/registry.h"
#include "framework/runtime/plugin_loader.h"

namespace tactus::app {

/// A back end as the command line names it: `qp`, `qp/nlopt`, `null-space/successive/one-pass`, `qp/solver=nlopt`.
struct BackEndChoice {
  std::string label;                                               ///< as given
  std::string name;
  std::map<std::string, std::string> options;
};

/// What the command line says about a stack.
struct StackOptions {
  std::string file;
  std::vector<std::string> set;                                    ///< name=value
  std::string back_end;                                            ///< "" = as the stack says
  std::optional<double> duration;                                  ///< s
  std::optional<std::uint64_t> seed;
};

/// The element table with everything that this program can build: structure, built-in tasks, shipped plugins and
/// those of --plugin.
class Program {
 public:
  /// `plugins` are library files or folders to search; throws PluginError.
  explicit Program(const std::vector<std::string>& plugins = {});
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  control::Registry& registry() { return registry_; }
  runtime::PluginLoader& plugins() { return plugins_; }
  const runtime::PluginLoader& plugins() const { return plugins_; }
  /// Loads every library of the folders of --plugin and TACTUS_PLUGIN_PATH, which a stack loads by name; returns what
  /// the refused ones are refused for.
  std::vector<std::string> loadFolders();
  /// Folders where robots are looked up by name, after the stack's own.
  std::vector<std::string> modelPath() const;
  /// Folders besides a stack's own where its includes may lie: TACTUS_INCLUDE_PATH.
  std::vector<std::string> includeFolders() const;

  /// Throws UsageError for a back end or an option that does not exist.
  BackEndChoice backEndChoice(const std::string& label) const;
  /// Throws UsageError for an unknown back end; lists those that exist.
  const control::ElementRow& backEndRow(const std::string& name) const;
  /// Throws dsl::InvalidStack, runtime::FileError when the file itself cannot be read.
  dsl::Stack read(const StackOptions& options, std::vector<dsl::Diagnostic>* warnings = nullptr);

 private:
  control::Registry registry_;
  runtime::PluginLoader plugins_;
};

}  // namespace tactus::app
