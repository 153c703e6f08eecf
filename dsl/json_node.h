#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

/// JSON files of Tactus, read strictly: what is wrong becomes a JsonFileError with the path of the value.
namespace tactus::dsl {

using Json = nlohmann::ordered_json;

/// A value of the document with the path that leads to it.  Every reading member throws JsonFileError.
class JsonNode {
 public:
  JsonNode(const Json& json, std::string path, bool non_finite = false)
      : json_(json), path_(std::move(path)), non_finite_(non_finite) {}

  [[noreturn]] void fail(const std::string& reason) const;
  /// Checks that this is an object with the required keys and no others than the allowed ones.
  void expectObject(const std::vector<std::string>& required, const std::vector<std::string>& optional) const;

  bool has(const char* key) const { return json_.contains(key); }
  JsonNode at(const char* key) const { return {json_.at(key), path_.empty() ? key : path_ + "." + key, non_finite_}; }
  JsonNode at(std::size_t index) const {
    return {json_.at(index), path_ + "[" + std::to_string(index) + "]", non_finite_};
  }
  std::size_t size() const;                                        ///< of an array
  std::vector<std::string> keys() const;                           ///< of an object, in the order of the file

  std::string text() const;
  bool flag() const;
  /// Finite; where the document is one that may hold others, also "nan", "inf" and "-inf".
  double number() const;
  int integer(int least, int most = 1'000'000) const;
  std::vector<int> integers() const;                               ///< each with its negative
  Eigen::VectorXd vector(int size) const;
  /// null stands for `infinity`.
  Eigen::VectorXd limits(int size, double infinity) const;
  Eigen::MatrixXd rows(int columns) const;

 private:
  void expectCount(int expected) const;

  const Json& json_;
  std::string path_;
  bool non_finite_;
};

/// "1 row", "3 rows"
std::string countOf(std::size_t n, const std::string& noun);

/// The document; throws JsonFileError for what is not JSON, or repeats a key in one object.
Json parseJson(const std::string& text);

}  // namespace tactus::dsl
