#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "dsl/findings.h"
#include "framework/control/registry.h"

/// Files written for an older Tactus.  The table keeps the names that elements and attributes once had.
namespace tactus::dsl {

/// A stretch of a file and what should stand there.
struct Edit {
  std::string file;
  std::size_t at = 0;                                              ///< offset of its first byte
  std::size_t size = 0;                                            ///< bytes
  std::string text;
};

/// Gives every element and attribute below `root` that has a former name its present one, in memory, with a warning
/// (W012) each.  Returns the edits that would do the same to the files, in no particular order.
std::vector<Edit> useNewNames(XmlElement& root, const control::ElementTable& table, Findings& findings);

/// What `tactus migrate` makes of a stack and of every file that it includes.
struct Migration {
  std::map<std::string, std::string> files;                        ///< those that change → their new text
  std::vector<Diagnostic> changes;                                 ///< a warning for each
};

/// Throws InvalidStack when the stack cannot be read at all, or a plugin of it cannot be loaded.
Migration migrate(const std::string& file, const control::Registry& registry,
                  const std::function<void(const std::string& plugin)>& load_plugin);

/// `text` with the edits made; they must not overlap.
std::string applyEdits(const std::string& text, std::vector<Edit> edits);

}  // namespace tactus::dsl
