#include "apps/tactus/json_place.h"

#include <algorithm>

#include "framework/runtime/file_error.h"

namespace tactus::app {

using nlohmann::ordered_json;

void JsonPlace::refuse(const std::string& expected) const {
  const std::string found = exists() ? value_->type_name() : "nothing";
  const std::string where = where_.empty() ? "/" : where_;
  throw runtime::FileError(file_, "at '" + where + "': expected " + expected + ", found " + found);
}

JsonPlace JsonPlace::at(const std::string& key) const {
  if (!exists()) return {*this, key, nullptr};
  if (!value_->is_object()) refuse("an object");
  const auto member = value_->find(key);
  return {*this, key, member == value_->end() ? nullptr : &*member};
}

std::vector<std::pair<std::string, JsonPlace>> JsonPlace::members() const {
  std::vector<std::pair<std::string, JsonPlace>> members;
  if (!exists()) return members;
  if (!value_->is_object()) refuse("an object");
  for (const auto& [key, value] : value_->items()) members.emplace_back(key, JsonPlace(*this, key, &value));
  return members;
}

std::vector<JsonPlace> JsonPlace::items() const {
  std::vector<JsonPlace> items;
  if (!exists()) return items;
  if (!value_->is_array()) refuse("an array");
  for (size_t i = 0; i < value_->size(); ++i) items.push_back({*this, std::to_string(i), &(*value_)[i]});
  return items;
}

std::optional<double> JsonPlace::number() const {
  if (!exists()) return std::nullopt;
  if (!value_->is_number()) refuse("a number");
  return value_->get<double>();
}

std::string JsonPlace::text() const {
  if (!exists() || !value_->is_string()) refuse("a text");
  return value_->get<std::string>();
}

ordered_json readJson(const std::string& path) {
  const std::string content = runtime::readFile(path);
  try {
    return ordered_json::parse(content);
  } catch (const ordered_json::parse_error& error) {
    const std::string before = content.substr(0, error.byte > 0 ? error.byte - 1 : 0);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const size_t column = before.size() - (before.rfind('\n') + 1) + 1;
    throw runtime::FileError(path, "line " + std::to_string(line) + ", column " + std::to_string(column) +
                                       ": is not JSON");
  } catch (const ordered_json::exception&) {
    throw runtime::FileError(path, "holds a number that cannot be represented");
  }
}

}  // namespace tactus::app
