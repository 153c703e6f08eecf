#pragma once

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

/// Null root, and errors in `findings`, when the file is not a stack at all; other errors leave a tree to check on.
/// A value that still holds "${" is one whose error has been told.
StackDocument readDocument(const std::string& file, const std::map<std::string, std::string>& set, Findings& findings);

/// The file as written in `from`: relative to the folder of that file.
std::string pathBeside(const std::string& from, const std::string& file);

}  // namespace tactus::dsl
