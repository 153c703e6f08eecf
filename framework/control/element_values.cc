#include "framework/control/element_values.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace tactus::control {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string quoted(std::string_view text) { return std::string("'").append(text).append("'"); }

std::vector<std::string_view> tokens(std::string_view text) {
  std::vector<std::string_view> found;
  for (std::size_t at = text.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    found.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(blanks, end);
  }
  return found;
}

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

bool isIdentifier(std::string_view text) {
  if (text.empty() || !isLetter(text.front())) return false;
  for (char c : text)
    if (!isLetter(c) && !isDigit(c) && c != '_' && c != '-') return false;
  return true;
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + quoted(words[i]);
  return text;
}

/// "a number > 0 (N/m)": what the row's range lets through.
std::string expectedRange(const AttributeRow& row) {
  std::string text;
  if (std::isfinite(row.lower)) text += (row.lower_open ? " > " : " ≥ ") + formatNumber(row.lower);
  if (std::isfinite(row.upper)) text += (text.empty() ? " ≤ " : " and ≤ ") + formatNumber(row.upper);
  if (!row.unit.empty() && row.unit != "1") text += " (" + row.unit + ")";
  return text;
}

/// What is often meant by a comma among numbers.
std::string commaHint(const AttributeRow& row, std::string_view text) {
  if (text.find(',') == std::string_view::npos) return "";
  const bool several = row.type == ValueType::reals || row.type == ValueType::points;
  return several ? "; numbers are separated by blanks, not by commas" : "; the decimal sign is a point";
}

/// One number of the row; appends to `numbers`.
bool parseNumber(const AttributeRow& row, std::string_view token, std::vector<double>& numbers, std::string& error) {
  const bool whole = row.type == ValueType::integer;
  const std::string wanted = (whole ? "an integer" : "a number") + expectedRange(row);
  double number = 0;
  std::from_chars_result result{};
  if (whole) {
    int integer = 0;
    result = std::from_chars(token.data(), token.data() + token.size(), integer);
    number = integer;
  } else {
    result = std::from_chars(token.data(), token.data() + token.size(), number);
  }
  if (result.ec == std::errc::result_out_of_range) {
    error = quoted(token) + " is too large or too small to be represented: expected " + wanted;
    return false;
  }
  if (result.ec != std::errc() || result.ptr != token.data() + token.size()) {
    error = quoted(token) + " is not " + (whole ? "an integer" : "a number") + ": expected " + wanted +
            commaHint(row, token);
    return false;
  }
  if (!std::isfinite(number)) {
    error = quoted(token) + " is not a finite number: expected " + wanted;
    return false;
  }
  if (number < row.lower || (row.lower_open && number == row.lower) || number > row.upper) {
    error = quoted(token) + " is out of range: expected " + wanted;
    return false;
  }
  numbers.push_back(number);
  return true;
}

std::string numbersWord(int count) { return count == 1 ? "1 number" : std::to_string(count) + " numbers"; }

bool parseReals(const AttributeRow& row, std::string_view text, std::vector<double>& numbers, std::string& error) {
  const auto words = tokens(text);
  if (row.count > 0 && static_cast<int>(words.size()) != row.count) {
    error = "expected " + numbersWord(row.count) + ", found " + std::to_string(words.size()) + commaHint(row, text);
    return false;
  }
  if (words.empty()) {
    error = "expected numbers separated by blanks, found none";
    return false;
  }
  for (std::string_view word : words)
    if (!parseNumber(row, word, numbers, error)) return false;
  return true;
}

bool parsePoints(const AttributeRow& row, std::string_view text, std::vector<double>& numbers, std::string& error) {
  int group = 1;
  for (std::size_t begin = 0; begin <= text.size(); ++group) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    if (!parseReals(row, text.substr(begin, end - begin), numbers, error)) {
      error = "point " + std::to_string(group) + ": " + error;
      return false;
    }
    begin = end + 1;
  }
  return true;
}

bool parseNames(const AttributeRow& row, std::string_view text, std::string& error) {
  if (!tokens(text).empty()) return true;
  error = std::string("expected names of ") + (row.type == ValueType::joints ? "joints" : "links") +
          " or of their groups, separated by blanks";
  return false;
}

bool parsePort(const AttributeRow& row, std::string_view text, std::string& error) {
  if (std::find(row.choices.begin(), row.choices.end(), text) != row.choices.end()) return true;
  const std::size_t dot = text.find('.');
  if (dot != std::string_view::npos && isIdentifier(text.substr(0, dot)) && isIdentifier(text.substr(dot + 1)))
    return true;
  error = quoted(text) + " does not name a port: expected signal.port, such as 'touch.held'";
  if (!row.choices.empty()) error += ", or " + listed(row.choices);
  return false;
}

bool parseText(const AttributeRow& row, const std::string& text, Value& value, std::string& error) {
  switch (row.type) {
    case ValueType::text: return true;
    case ValueType::identifier:
    case ValueType::object:
    case ValueType::element_class:
      if (isIdentifier(text)) return true;
      error = quoted(text) + " is not a name: expected a letter, then letters, digits, '_' or '-'";
      return false;
    case ValueType::flag:
      if (text == "true" || text == "false") {
        value.numbers.push_back(text == "true" ? 1 : 0);
        return true;
      }
      error = quoted(text) + " is not a flag: expected 'true' or 'false'";
      return false;
    case ValueType::integer:
    case ValueType::real: return parseNumber(row, text, value.numbers, error);
    case ValueType::reals: return parseReals(row, text, value.numbers, error);
    case ValueType::points: return parsePoints(row, text, value.numbers, error);
    case ValueType::choice:
      for (const std::string& choice : row.choices)
        if (choice == text) return true;
      error = quoted(text) + " is not one of the choices: expected " + listed(row.choices);
      return false;
    case ValueType::port: return parsePort(row, text, error);
    case ValueType::links:
    case ValueType::joints: return parseNames(row, text, error);
    case ValueType::link:
    case ValueType::file:
      if (!text.empty()) return true;
      error = row.type == ValueType::link ? "expected the name of a link" : "expected the name of a file";
      return false;
  }
  return false;
}

}  // namespace

std::string formatNumber(double number) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, number);
  return std::string(buffer, result.ptr);
}

bool ElementValues::has(std::string_view attribute) const {
  if (reads_) reads_->emplace(attribute);
  return values_.find(attribute) != values_.end();
}

const Value& ElementValues::value(std::string_view attribute) const {
  if (reads_) reads_->emplace(attribute);
  const auto found = values_.find(attribute);
  if (found != values_.end()) return found->second;
  const std::string element = row_ ? "<" + row_->name + ">" : "an element without a row";
  if (row_ && row_->attribute(attribute))
    throw std::logic_error(element + ": attribute '" + std::string(attribute) + "' has no value");
  throw std::logic_error(element + " has no attribute '" + std::string(attribute) + "'");
}

double ElementValues::real(std::string_view attribute) const {
  const Value& found = value(attribute);
  if (found.numbers.size() != 1)
    throw std::logic_error("attribute '" + std::string(attribute) + "' is not a single number");
  return found.numbers.front();
}

int ElementValues::integer(std::string_view attribute) const { return static_cast<int>(real(attribute)); }

bool ElementValues::flag(std::string_view attribute) const { return real(attribute) != 0; }

Eigen::Vector3d ElementValues::vector3(std::string_view attribute) const {
  const std::vector<double>& found = numbers(attribute);
  if (found.size() != 3) throw std::logic_error("attribute '" + std::string(attribute) + "' is not three numbers");
  return {found[0], found[1], found[2]};
}

std::vector<PortRow> ElementValues::ports() const {
  std::vector<PortRow> found;
  for (const PortRow& port : row_->ports) {
    if (!port.name.starts_with('@')) {
      found.push_back(port);
      continue;
    }
    for (const ElementValues& child : children) {
      if (child.row().name != std::string_view(port.name).substr(1) || !child.has("name")) continue;
      found.push_back(port);
      found.back().name = child.text("name");
    }
  }
  return found;
}

std::optional<Value> parseValue(const AttributeRow& row, const std::string& text, std::string& error) {
  Value value;
  value.text = text;
  if (!parseText(row, text, value, error)) return std::nullopt;
  return value;
}

ElementValues makeValues(const ElementRow& row, const std::map<std::string, std::string>& given) {
  ElementValues values(row);
  const std::string element = "<" + row.name + ">";
  for (const auto& [name, text] : given) {
    const AttributeRow* attribute = row.attribute(name);
    if (!attribute) throw std::invalid_argument(element + " has no attribute '" + name + "'");
    std::string error;
    auto value = parseValue(*attribute, text, error);
    if (!value) throw std::invalid_argument(element + ": attribute '" + name + "': " + error);
    value->origin.kind = Origin::Kind::attribute;
    values.set(name, std::move(*value));
  }
  for (const AttributeRow& attribute : row.attributes) {
    if (values.has(attribute.name)) continue;
    if (attribute.required) throw std::invalid_argument(element + " needs the attribute '" + attribute.name + "'");
    if (!attribute.default_text) continue;
    std::string error;
    values.set(attribute.name, parseValue(attribute, *attribute.default_text, error).value());
  }
  return values;
}

}  // namespace tactus::control
