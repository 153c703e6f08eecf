#include "dsl/json_node.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "dsl/json_file_error.h"
#include "dsl/nearest_name.h"

namespace tactus::dsl {

std::string countOf(std::size_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

void JsonNode::fail(const std::string& reason) const { throw JsonFileError(path_, reason); }

void JsonNode::expectObject(const std::vector<std::string>& required, const std::vector<std::string>& optional) const {
  if (!json_.is_object()) fail("expected an object");
  std::vector<std::string> valid = required;
  valid.insert(valid.end(), optional.begin(), optional.end());
  for (const auto& [key, value] : json_.items()) {
    if (std::find(valid.begin(), valid.end(), key) != valid.end()) continue;
    const std::string near = nearestName(key, valid);
    fail("unknown key \"" + key + "\"" + (near.empty() ? "" : ", did you mean \"" + near + "\"?"));
  }
  for (const std::string& key : required)
    if (!json_.contains(key)) fail("\"" + key + "\" is missing");
}

std::size_t JsonNode::size() const {
  if (!json_.is_array()) fail("expected an array");
  return json_.size();
}

std::vector<std::string> JsonNode::keys() const {
  if (!json_.is_object()) fail("expected an object");
  std::vector<std::string> keys;
  for (const auto& [key, value] : json_.items()) keys.push_back(key);
  return keys;
}

std::string JsonNode::text() const {
  if (!json_.is_string()) fail("expected a text");
  return json_.get<std::string>();
}

bool JsonNode::flag() const {
  if (!json_.is_boolean()) fail("expected true or false");
  return json_.get<bool>();
}

double JsonNode::number() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (non_finite_ && json_.is_string()) {
    const std::string word = json_.get<std::string>();
    if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
    if (word == "inf") return infinity;
    if (word == "-inf") return -infinity;
  }
  if (!json_.is_number()) fail("expected a number");
  const double value = json_.get<double>();
  if (!std::isfinite(value)) fail("expected a finite number");
  return value;
}

int JsonNode::integer(int least, int most) const {
  const double value = number();
  if (!(value == std::floor(value) && value >= least && value <= most))
    fail("expected an integer from " + std::to_string(least));
  return static_cast<int>(value);
}

std::vector<int> JsonNode::integers() const {
  std::vector<int> values;
  for (std::size_t i = 0; i < size(); ++i)
    values.push_back(at(i).integer(-std::numeric_limits<int>::max(), std::numeric_limits<int>::max()));
  return values;
}

Eigen::VectorXd JsonNode::vector(int size) const {
  expectCount(size);
  Eigen::VectorXd values(size);
  for (int i = 0; i < size; ++i) values[i] = at(static_cast<std::size_t>(i)).number();
  return values;
}

Eigen::VectorXd JsonNode::limits(int size, double infinity) const {
  expectCount(size);
  Eigen::VectorXd values(size);
  for (int i = 0; i < size; ++i) {
    const JsonNode entry = at(static_cast<std::size_t>(i));
    values[i] = entry.json_.is_null() ? infinity : entry.number();
  }
  return values;
}

Eigen::MatrixXd JsonNode::rows(int columns) const {
  Eigen::MatrixXd matrix(size(), columns);
  for (std::size_t r = 0; r < size(); ++r) {
    const JsonNode row = at(r);
    if (row.size() != static_cast<std::size_t>(columns))
      fail("row " + std::to_string(r + 1) + " has " + countOf(row.size(), "number") + ", expected " +
           std::to_string(columns));
    matrix.row(r) = row.vector(columns).transpose();
  }
  return matrix;
}

void JsonNode::expectCount(int expected) const {
  if (size() != static_cast<std::size_t>(expected))
    fail("has " + countOf(size(), "number") + ", expected " + std::to_string(expected));
}

Json parseJson(const std::string& text) {
  // nlohmann keeps the last of repeated keys in silence.
  std::vector<std::set<std::string>> keys;
  std::string repeated;
  const auto watch = [&](int, Json::parse_event_t event, Json& value) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second)
      repeated = value.get<std::string>();
    return true;
  };
  Json json;
  try {
    json = Json::parse(text, watch);
  } catch (const nlohmann::json::exception& error) {
    const std::string what = error.what();                         // "[json.exception.…] parse error at line 1, …"
    const std::size_t end = what.find("] ");
    throw JsonFileError("", "not JSON: " + (end == std::string::npos ? what : what.substr(end + 2)));
  }
  if (!repeated.empty()) throw JsonFileError("", "key \"" + repeated + "\" is repeated in one object");
  return json;
}

}  // namespace tactus::dsl
