#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::app {

/// A place in a JSON file that somebody may have changed: what stands there is asked for by its kind, and a value of
/// another kind is a FileError that names file, place and both kinds.  A place where nothing stands is no error until
/// something is required of it; null counts as nothing.
class JsonPlace {
 public:
  /// The whole document, which must outlive its places.
  JsonPlace(const std::string& file, const nlohmann::ordered_json& value) : file_(file), value_(&value) {}

  bool exists() const { return value_ && !value_->is_null(); }
  JsonPlace at(const std::string& key) const;                      ///< a member; of nothing: nothing
  std::vector<std::pair<std::string, JsonPlace>> members() const;  ///< none of nothing
  std::vector<JsonPlace> items() const;                            ///< none of nothing
  std::optional<double> number() const;
  std::string text() const;                                        ///< required
  std::string text(const std::string& otherwise) const { return exists() ? text() : otherwise; }
  /// Throws FileError: something else was expected here.
  [[noreturn]] void refuse(const std::string& expected) const;

 private:
  JsonPlace(const JsonPlace& parent, const std::string& step, const nlohmann::ordered_json* value)
      : file_(parent.file_), where_(parent.where_ + "/" + step), value_(value) {}

  std::string file_;
  std::string where_;                                              ///< "/ticks/total"
  const nlohmann::ordered_json* value_ = nullptr;
};

/// Parses a JSON file; throws FileError with line and column of what is not JSON.
nlohmann::ordered_json readJson(const std::string& path);

}  // namespace tactus::app
