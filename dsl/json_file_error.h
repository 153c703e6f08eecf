#pragma once

#include <stdexcept>
#include <string>

namespace tactus::dsl {

/// What is wrong with a JSON file of Tactus; the message starts with the JSON path, e.g.
/// "levels[1].tasks[0].jacobian: row 2 has 8 numbers, expected 9" (rows count from 1).
class JsonFileError : public std::runtime_error {
 public:
  JsonFileError(std::string json_path, const std::string& reason)
      : std::runtime_error(json_path.empty() ? reason : json_path + ": " + reason), json_path(std::move(json_path)) {}
  std::string json_path;                                           ///< "" = the file as a whole
};

}  // namespace tactus::dsl
