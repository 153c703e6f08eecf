#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "framework/control/element_table.h"

/// Rows of the element table in words: what `explain`, the reference manual and the schema say.
namespace tactus::dsl {

struct KindText {
  control::ElementKind kind;
  const char* key;                                                 ///< "back-end"
  const char* heading;                                             ///< "back ends, by <controller backend>"
};

/// In the order of a manual.
const std::vector<KindText>& kindTexts();
const KindText& textOf(control::ElementKind kind);

/// "3 numbers", "points of 3 numbers, separated by ';'", "port of type contact-set"
std::string typeText(const control::AttributeRow& row);
/// "> 0, ≤ 1"; "" where any number may stand.
std::string rangeText(const control::AttributeRow& row);
/// "" for what has none, and for pure numbers.
std::string unitText(const std::string& unit);
/// "<level> (at least 1)", "any task"
std::string childText(const control::ChildRow& child);
/// "at least one of 'lower', 'upper'"
std::string presenceText(const control::PresenceRule& rule);
/// Elements in which one may stand; <defaults> is left out.
std::vector<std::string> parentsOf(const control::ElementTable& table, const control::ElementRow& row);

/// One element as on a terminal.
std::string elementText(const control::ElementRow& row);
/// {name, kind, description, source?, since?, deprecated?, formerly?, attributes, presence, ports, children}
nlohmann::ordered_json elementJson(const control::ElementRow& row);

}  // namespace tactus::dsl
