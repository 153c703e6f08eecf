#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/description/place.h"

namespace tactus::dsl {

/// The text of a file and where its lines are.  Offsets count bytes; lines and columns count from 1, columns in
/// characters (code points; a tab is one), and a byte-order mark does not count.
class SourceText {
 public:
  SourceText() = default;
  SourceText(std::string file, std::string text);

  const std::string& file() const { return file_; }
  const std::string& text() const { return text_; }
  description::Place place(std::size_t offset) const;
  /// The line that holds the offset, without its end ("\n" or "\r\n").
  std::string line(std::size_t offset) const;
  /// The same by its number; "" when there is no such line.
  std::string lineAt(int number) const;
  /// Offset of the first byte that is not UTF-8.
  std::optional<std::size_t> firstBadByte() const;
  /// Offset of the first character after a byte-order mark.
  std::size_t begin() const { return begin_; }

 private:
  std::size_t lineStart(std::size_t offset) const;

  std::string file_;
  std::string text_;
  std::size_t begin_ = 0;
  std::vector<std::size_t> line_starts_{0};
};

/// Characters (code points) in UTF-8 text.
int countCharacters(std::string_view text);

/// The file's content, or nothing when it cannot be read; at most `most` bytes of it.
std::optional<std::string> readFile(const std::string& file, std::size_t most = std::string::npos);

}  // namespace tactus::dsl
