#include "apps/tactus/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/tactus/command.h"
#include "framework/control/element_values.h"

namespace tactus::app {
namespace {

double parseNumber(const std::string& word, const std::string& what) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [read, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::result_out_of_range && read == end)
    throw UsageError(what + ": '" + word + "' is too large or too small a number");
  if (error != std::errc() || read != end) throw UsageError(what + ": '" + word + "' is not a number");
  if (!std::isfinite(value)) throw UsageError(what + ": '" + word + "' is not a finite number");
  return value;
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
  if (text.find_first_not_of(' ') == std::string::npos) return numbers;
  for (const std::string& part : split(text, ',')) {
    const size_t before = numbers.size();
    for (const std::string& word : split(part, ' '))
      if (!word.empty()) numbers.push_back(parseNumber(word, what));
    if (numbers.size() == before)
      throw UsageError(what + ": number " + std::to_string(before + 1) + " is empty");
  }
  return numbers;
}

std::string counted(size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
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

std::string clockText(double seconds) {
  const long all = std::lround(std::min(seconds, 1e15));
  const auto two = [](long number) { return (number < 10 ? "0" : "") + std::to_string(number); };
  const std::string minutes =
      all < 3600 ? std::to_string(all / 60) : std::to_string(all / 3600) + ":" + two(all / 60 % 60);
  return minutes + ":" + two(all % 60);
}

size_t width(std::string_view text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string timeText(double seconds) { return control::formatNumber(std::round(seconds * 1e9) / 1e9); }

std::string base64(std::string_view bytes) {
  static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t k) { return k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0u; };
    const unsigned group = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string jsonText(const nlohmann::ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace tactus::app
