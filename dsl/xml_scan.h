#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::dsl {

inline constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

struct ScannedAttribute {
  std::string name;
  std::size_t name_at = 0;                                         ///< offset of the name's first byte
  std::size_t value_at = 0;                                        ///< of the first byte inside the quotes
  std::size_t value_size = 0;                                      ///< bytes between the quotes, as written
};

struct ScannedElement {
  std::string name;
  std::size_t at = 0;                                              ///< offset of '<'
  std::size_t end = 0;                                             ///< just past its last '>'
  std::size_t text_at = nowhere;                                   ///< first character that is neither blank nor markup
  int parent = -1;                                                 ///< index into ScannedXml::elements
  std::vector<ScannedAttribute> attributes;
};

struct ScanError {
  std::size_t at = 0;
  std::string message;
  bool several_roots = false;
};

/// What stands where in an XML text: elements in document order, with the offsets that a DOM loses.  The first
/// breach of well-formedness ends the scan.  Document types are refused: a stack needs none.
struct ScannedXml {
  std::vector<ScannedElement> elements;
  std::optional<ScanError> error;
};

/// Scans text[begin…].  No recursion: depth costs memory, not stack.
ScannedXml scanXml(std::string_view text, std::size_t begin = 0);

}  // namespace tactus::dsl
