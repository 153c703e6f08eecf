#pragma once

#include <string>

namespace tactus::dsl {

/// The same XML in one layout, as `tactus fmt` writes it: two blanks a level, lines of up to 120 characters, one blank
/// between attributes, broken attributes below each other, no blanks at the ends of lines.  Comments, processing
/// instructions, the order of everything and what stands between quotes stay as they are; so do single blank lines, and
/// short elements that stood on one line.  The result reads as the same document and formats to itself.
///
/// `text` is well-formed (see parseXml).
std::string formatXml(const std::string& text);

}  // namespace tactus::dsl
