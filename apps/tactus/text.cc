#include "apps/tactus/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "apps/tactus/command.h"

namespace tactus::app {
namespace {

/// Characters of UTF-8 text.
size_t width(std::string_view text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (;;) {
    const size_t end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<double> parseNumbers(const std::string& text, const std::string& what) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* end = at + text.size();
  const auto separator = [](char c) { return c == ',' || c == ' '; };
  while ((at = std::find_if_not(at, end, separator)) != end) {
    const char* stop = std::find_if(at, end, separator);
    double value = 0;
    const auto [read, error] = std::from_chars(at, stop, value);
    if (error != std::errc() || read != stop || !std::isfinite(value)) {
      throw UsageError(what + ": '" + std::string(at, stop) + "' is not a finite number");
    }
    numbers.push_back(value);
    at = stop;
  }
  return numbers;
}

std::string rounded(double value, int digits) {
  if (std::isnan(value)) return "–";
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, digits).ptr};
}

std::string textTable(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], width(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (size_t i = 0; i < row.size(); ++i) {
      const std::string padding(widths[i] - width(row[i]), ' ');
      if (i > 0) line += "  ";
      line += i == 0 ? row[i] + padding : padding + row[i];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace tactus::app
