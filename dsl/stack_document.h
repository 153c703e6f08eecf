#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dsl/findings.h"
#include "dsl/xml_file.h"
#include "framework/control/element_table.h"

namespace tactus::dsl {

/// A stack as one tree of elements: includes are replaced by what they bring, ${…} by the parameters' values.
struct StackDocument {
  std::unique_ptr<XmlElement> root;
  std::map<std::string, std::string> files;                        ///< every file read → its content
  std::map<std::string, std::vector<description::Place>> included_from;
};

/// A file with `outermost` outermost, "stack" or "study".
///
/// Null root, and errors in `findings`, when the file is not one at all; other errors leave a tree to check on.
/// A value that still holds "${" is one whose error has been told.
///
/// Includes are read from the stack's own folder and those below it, and from `include_folders`; a file has at most
/// 16 MiB, all together 64 MiB.
StackDocument readDocument(const std::string& file, const std::map<std::string, std::string>& set,
                           const std::vector<std::string>& include_folders, Findings& findings,
                           const std::string& outermost = "stack");

/// Loads what every <plugin> names, in order and each once, before anything else is checked: plugins bring the elements
/// that the rest is made of.  Throws the errors when one cannot be loaded.  Returns the names.
std::vector<std::string> loadPlugins(const XmlElement& root, const std::function<void(const std::string&)>& load,
                                     Findings& findings);

/// The file as written in `from`: relative to the folder of that file.
std::string pathBeside(const std::string& from, const std::string& file);

}  // namespace tactus::dsl
