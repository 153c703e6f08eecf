#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "framework/control/element_table.h"
#include "framework/description/place.h"

namespace tactus::control {

/// Where a value came from: the attribute itself, a class, --set, or the table's default.
struct Origin {
  enum class Kind { table_default, defaults_class, attribute, command_line } kind = Kind::table_default;
  std::string detail;                                              ///< class name, or the --set text
  description::Place place;                                        ///< of the value's first character, where it has one
};

struct Value {
  std::string text;                                                ///< after ${…}
  std::vector<double> numbers;                                     ///< integer, real, reals, points (flat); flag as 0/1
  Origin origin;
};

/// The checked values of one element: every attribute of its row that is given or has a default.
/// The getters throw std::logic_error for an attribute that the row does not have or that has no value:
/// that is a mistake of the program, never of the user.
class ElementValues {
 public:
  ElementValues() = default;
  explicit ElementValues(const ElementRow& row) : row_(&row) {}

  const ElementRow& row() const { return *row_; }
  void set(const std::string& attribute, Value value) { values_[attribute] = std::move(value); }
  bool has(std::string_view attribute) const;
  const Value& value(std::string_view attribute) const;
  /// Notes from now on which attributes somebody asks for; `reads` must outlive this and its copies.
  void watch(std::set<std::string, std::less<>>* reads) { reads_ = reads; }
  const std::map<std::string, Value, std::less<>>& all() const { return values_; }

  const std::string& text(std::string_view attribute) const { return value(attribute).text; }
  double real(std::string_view attribute) const;
  int integer(std::string_view attribute) const;
  bool flag(std::string_view attribute) const;
  const std::vector<double>& numbers(std::string_view attribute) const { return value(attribute).numbers; }
  Eigen::Vector3d vector3(std::string_view attribute) const;

  /// The ports that a signal offers: those of its row, where "@phase" stands for one for each <phase> inside, by its
  /// name.
  std::vector<PortRow> ports() const;

  std::vector<ElementValues> children;                             ///< of the elements inside, in their order
  description::Place place;                                        ///< of the element's '<'; line 0 = made in code

 private:
  const ElementRow* row_ = nullptr;
  std::set<std::string, std::less<>>* reads_ = nullptr;
  std::map<std::string, Value, std::less<>> values_;
};

/// Turns `text` into a Value by the row's type, range, count and choices: full-match, locale-free.
/// On failure returns what was wrong and what was expected, as one sentence, in `error`.
std::optional<Value> parseValue(const AttributeRow& row, const std::string& text, std::string& error);

/// The shortest text that reads back to the same double, whatever the locale.
std::string formatNumber(double number);

/// Values of `row` from plain pairs, for tests and for `tactus solve`; throws std::invalid_argument with the sentence.
ElementValues makeValues(const ElementRow& row, const std::map<std::string, std::string>& given = {});

}  // namespace tactus::control
