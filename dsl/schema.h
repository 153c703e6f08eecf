#pragma once

#include <map>
#include <string>

#include "framework/control/element_table.h"

/// What editors, programs and readers get of the element table; the C++ checker stays the authority.
namespace tactus::dsl {

/// An XML Schema (1.0) for completion and for hints while typing.  It accepts every valid stack; counts, references,
/// ranges and presence rules are left to `tactus check`.  Values may hold ${name} everywhere.
std::string schemaXsd(const control::ElementTable& table);

/// {format, version, elements: [elementJson]}
std::string schemaJson(const control::ElementTable& table);

/// The reference manual: file name → Markdown, one page for each kind of element and README.md to begin with.
std::map<std::string, std::string> referencePages(const control::ElementTable& table);

}  // namespace tactus::dsl
