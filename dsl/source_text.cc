#include "dsl/source_text.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace tactus::dsl {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

bool isContinuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Length of the UTF-8 sequence at `at`, 0 when it is broken (RFC 3629: no overlong forms, no surrogates).
std::size_t sequenceLength(std::string_view text, std::size_t at) {
  const auto byte = [&](std::size_t i) { return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0; };
  const unsigned first = byte(0), second = byte(1);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  if (first == 0xE0 && second < 0xA0) return 0;
  if (first == 0xED && second > 0x9F) return 0;
  if (first == 0xF0 && second < 0x90) return 0;
  if (first == 0xF4 && second > 0x8F) return 0;
  return length;
}

}  // namespace

SourceText::SourceText(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
  if (text_.starts_with(byte_order_mark)) begin_ = byte_order_mark.size();
  line_starts_[0] = begin_;
  for (std::size_t i = begin_; i < text_.size(); ++i)
    if (text_[i] == '\n') line_starts_.push_back(i + 1);
}

std::size_t SourceText::lineStart(std::size_t offset) const {
  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  return after == line_starts_.begin() ? begin_ : *(after - 1);
}

description::Place SourceText::place(std::size_t offset) const {
  offset = std::clamp(offset, begin_, text_.size());
  const std::size_t start = lineStart(offset);
  const auto number = std::lower_bound(line_starts_.begin(), line_starts_.end(), start) - line_starts_.begin();
  return {file_, static_cast<int>(number) + 1,
          countCharacters(std::string_view(text_).substr(start, offset - start)) + 1};
}

std::string SourceText::line(std::size_t offset) const {
  const std::size_t start = lineStart(std::clamp(offset, begin_, text_.size()));
  std::size_t end = std::min(text_.find('\n', start), text_.size());
  if (end > start && text_[end - 1] == '\r') --end;
  return text_.substr(start, end - start);
}

std::string SourceText::lineAt(int number) const {
  const bool exists = number >= 1 && static_cast<std::size_t>(number) <= line_starts_.size();
  return exists ? line(line_starts_[static_cast<std::size_t>(number) - 1]) : "";
}

std::optional<std::size_t> SourceText::firstBadByte() const {
  for (std::size_t at = 0; at < text_.size();) {
    const std::size_t length = sequenceLength(text_, at);
    if (length == 0) return at;
    at += length;
  }
  return std::nullopt;
}

int countCharacters(std::string_view text) {
  return static_cast<int>(std::count_if(text.begin(), text.end(), [](char c) { return !isContinuation(c); }));
}

std::optional<std::string> readFile(const std::string& file, std::size_t most) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::string content;
  char block[65536];
  while (content.size() < most && (stream.read(block, sizeof block), stream.gcount() > 0))
    content.append(block, static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) return std::nullopt;
  if (content.size() > most) content.resize(most);
  return content;
}

}  // namespace tactus::dsl
