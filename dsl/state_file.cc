#include "dsl/state_file.h"

#include <cmath>
#include <filesystem>
#include <limits>

#include "dsl/json_node.h"
#include "framework/runtime/file_error.h"

namespace tactus::dsl {
namespace {

using control::StateValue;

constexpr const char* state_format = "tactus-state/1";

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json toJson(double number) {
  if (std::isfinite(number)) return number;
  const std::string sign = std::signbit(number) ? "-" : "";
  return sign + (std::isnan(number) ? "nan" : "inf");
}

Json toJson(const StateValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  Json list = Json::array();
  if (const auto* integers = std::get_if<std::vector<std::int64_t>>(&value))
    for (const std::int64_t integer : *integers) list.push_back(integer);
  else
    for (const double number : std::get<std::vector<double>>(value)) list.push_back(toJson(number));
  return list;
}

bool isWhole(const Json& entry) {
  if (!entry.is_number_integer()) return false;
  return !entry.is_number_unsigned() ||
         entry.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
}

double readReal(const Json& entry, const JsonNode& node) {
  if (entry.is_number()) return entry.get<double>();
  const std::string word = entry.is_string() ? entry.get<std::string>() : "";
  const double sign = word.starts_with("-") ? -1 : 1;
  if (word == "nan" || word == "-nan") return std::copysign(std::numeric_limits<double>::quiet_NaN(), sign);
  if (word == "inf" || word == "-inf") return sign * std::numeric_limits<double>::infinity();
  node.fail("expected a number, \"nan\", \"-nan\", \"inf\" or \"-inf\"");
}

StateValue readValue(const Json& json, const JsonNode& node) {
  if (json.is_string()) return json.get<std::string>();
  if (!json.is_array()) node.fail("expected an array of numbers, or a text");
  bool whole = true;
  for (const Json& entry : json) whole = whole && isWhole(entry);
  if (whole) return json.get<std::vector<std::int64_t>>();
  std::vector<double> numbers;
  for (std::size_t i = 0; i < json.size(); ++i) numbers.push_back(readReal(json[i], node.at(i)));
  return numbers;
}

std::vector<std::string> readNames(const JsonNode& node) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < node.size(); ++i) names.push_back(node.at(i).text());
  return names;
}

}  // namespace

std::string stateToJson(const SavedState& saved) {
  const Json head{{"format", state_format}, {"stack", saved.stack},   {"backend", saved.back_end},
                  {"seed", saved.seed},     {"time", saved.time},     {"robot", saved.robot},
                  {"joints", saved.joints}, {"links", saved.links},   {"objects", saved.objects}};
  std::string text = "{\n";
  for (const auto& [key, value] : head.items()) text += dumped(key) + ": " + dumped(value) + ",\n";
  text += "\"values\": {";
  const char* separator = "\n";
  for (const auto& [path, value] : saved.values) {
    text += separator + dumped(path) + ": " + dumped(toJson(value));
    separator = ",\n";
  }
  return text + "\n}}\n";
}

SavedState readState(const std::string& file) {
  std::error_code error;
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    throw runtime::FileError(file, "is not a file");
  return parseState(runtime::readFile(file));
}

SavedState parseState(const std::string& text) {
  const Json json = parseJson(text);
  const JsonNode root(json, "");
  if (!json.is_object() || !json.contains("format") || json["format"] != state_format)
    root.fail(std::string("no state: \"format\" is not \"") + state_format + "\"");
  root.expectObject({"format", "stack", "backend", "seed", "time", "robot", "joints", "links", "objects", "values"}, {});
  SavedState saved;
  saved.stack = root.at("stack").text();
  saved.back_end = root.at("backend").text();
  saved.seed = static_cast<std::uint64_t>(root.at("seed").integer(0, std::numeric_limits<int>::max()));
  saved.time = root.at("time").number();
  if (saved.time < 0) root.at("time").fail("must not be negative");
  saved.robot = root.at("robot").text();
  saved.joints = readNames(root.at("joints"));
  saved.links = readNames(root.at("links"));
  saved.objects = readNames(root.at("objects"));
  const Json& values = json["values"];
  if (!values.is_object()) root.at("values").fail("expected an object");
  for (const auto& [path, value] : values.items())
    saved.values[path] = readValue(value, JsonNode(value, "values." + path));
  return saved;
}

}  // namespace tactus::dsl
