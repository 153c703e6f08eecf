#include "dsl/element_text.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/control/element_values.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ElementKind;
using control::ElementRow;
using control::ValueType;
using nlohmann::ordered_json;

const char* nameOf(ValueType type) {
  switch (type) {
    case ValueType::text: return "text";
    case ValueType::identifier: return "name";
    case ValueType::flag: return "true or false";
    case ValueType::integer: return "integer";
    case ValueType::real: return "number";
    case ValueType::reals: return "numbers";
    case ValueType::points: return "points";
    case ValueType::choice: return "choice";
    case ValueType::port: return "port";
    case ValueType::link: return "link";
    case ValueType::links: return "links or groups";
    case ValueType::joints: return "joints or groups";
    case ValueType::object: return "object";
    case ValueType::element_class: return "class";
    case ValueType::file: return "file";
  }
  return "";
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string quotedList(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "'" : ", '") + name + "'";
  return text;
}

/// What is the same for elements and attributes.
template <class Row>
void addHistory(const Row& row, ordered_json& json) {
  if (!row.since.empty()) json["since"] = row.since;
  if (!row.deprecated.empty()) json["deprecated"] = row.deprecated;
  if (!row.formerly.empty()) json["formerly"] = row.formerly;
}

ordered_json attributeJson(const AttributeRow& row) {
  ordered_json json{{"name", row.name}, {"type", typeText(row)}, {"required", row.required}};
  if (!row.unit.empty()) json["unit"] = row.unit;
  if (row.default_text) json["default"] = *row.default_text;
  if (std::isfinite(row.lower)) json[row.lower_open ? "greater_than" : "lower"] = row.lower;
  if (std::isfinite(row.upper)) json["upper"] = row.upper;
  if (!row.choices.empty()) json["choices"] = row.choices;
  addHistory(row, json);
  json["description"] = row.description;
  return json;
}

/// One attribute: what may be written on the first line, what it means below.
std::string attributeText(const AttributeRow& row) {
  std::vector<std::string> facts{typeText(row)};
  if (const std::string unit = unitText(row.unit); !unit.empty()) facts.push_back(unit);
  if (!rangeText(row).empty()) facts.push_back(rangeText(row));
  if (!row.choices.empty())
    facts.push_back((row.type == ValueType::choice ? "one of " : "or ") + joined(row.choices, " | "));
  if (row.required) facts.push_back("required");
  if (row.default_text) facts.push_back("default " + (row.default_text->empty() ? "empty" : *row.default_text));
  if (!row.since.empty()) facts.push_back("since " + row.since);
  return "  " + row.name + ": " + joined(facts, "; ") + "\n" +
         (row.deprecated.empty() ? "" : "      DEPRECATED: " + row.deprecated + "\n") +
         (row.description.empty() ? "" : "      " + row.description + "\n");
}

}  // namespace

const std::vector<KindText>& kindTexts() {
  static const std::vector<KindText> kinds{{ElementKind::structure, "structure", "structure"},
                                           {ElementKind::shape, "shape", "shapes, in <object>"},
                                           {ElementKind::sensor, "sensor", "sensors, in <sensors>"},
                                           {ElementKind::signal, "signal", "signals, in <signals>"},
                                           {ElementKind::task, "task", "tasks, in <level>"},
                                           {ElementKind::controller, "controller", "controllers, alone in a <level>"},
                                           {ElementKind::measure, "measure", "measures, in <run>"},
                                           {ElementKind::recorder, "recorder", "recorders, in <run>"},
                                           {ElementKind::back_end, "back-end", "back ends, by <controller backend>"}};
  return kinds;
}

const KindText& textOf(ElementKind kind) {
  return *std::find_if(kindTexts().begin(), kindTexts().end(), [&](const KindText& text) { return text.kind == kind; });
}

std::string typeText(const AttributeRow& row) {
  const std::string count = std::to_string(row.count);
  if (row.type == ValueType::reals && row.count > 0) return count + " numbers";
  if (row.type == ValueType::points) return "points of " + count + " numbers, separated by ';'";
  if (row.type == ValueType::port) return "port of type " + row.port_type;
  return nameOf(row.type);
}

std::string rangeText(const AttributeRow& row) {
  std::string text;
  if (std::isfinite(row.lower)) text += (row.lower_open ? "> " : "≥ ") + control::formatNumber(row.lower);
  if (std::isfinite(row.upper)) text += (text.empty() ? "≤ " : ", ≤ ") + control::formatNumber(row.upper);
  return text;
}

std::string unitText(const std::string& unit) { return unit == "1" ? "" : unit; }

std::string childText(const control::ChildRow& child) {
  const bool kind = child.element.starts_with("@");
  const std::string text = kind ? "any " + child.element.substr(1) : "<" + child.element + ">";
  const std::string least = std::to_string(child.min), most = std::to_string(child.max);
  if (child.min == child.max) return text + " (" + least + ")";
  if (child.min > 0) return text + " (at least " + least + ")";
  return child.max < 0 ? text : text + " (at most " + most + ")";
}

std::string presenceText(const control::PresenceRule& rule) {
  const std::string all = quotedList(rule.attributes);
  switch (rule.kind) {
    case control::Presence::exclusive: return "at most one of " + all;
    case control::Presence::together: return all + " together or not at all";
    case control::Presence::any_of: return "at least one of " + all;
    case control::Presence::one_of: return "exactly one of " + all;
    case control::Presence::needs:
      return "'" + rule.attributes.front() + "' needs " +
             quotedList({rule.attributes.begin() + 1, rule.attributes.end()}) + ", too";
  }
  return "";
}

std::vector<std::string> parentsOf(const control::ElementTable& table, const ElementRow& row) {
  std::vector<std::string> parents;
  for (const ElementRow& candidate : table.rows())
    for (const control::ChildRow& child : candidate.children)
      if (candidate.name != "defaults" && child.allows(row)) parents.push_back(candidate.name);
  return parents;
}

std::string elementText(const ElementRow& row) {
  const bool back_end = row.kind == ElementKind::back_end;
  std::string out = (back_end ? "backend=\"" + row.name + "\"" : "<" + row.name + ">") + ": " + row.description + "\n";
  if (!row.source.empty()) out += "source: " + row.source + "\n";
  if (!row.since.empty()) out += "since: " + row.since + "\n";
  if (!row.deprecated.empty()) out += "DEPRECATED: " + row.deprecated + "\n";
  if (!row.attributes.empty()) out += back_end ? "\noptions, attributes of <controller>\n" : "\nattributes\n";
  for (const AttributeRow& attribute : row.attributes) out += attributeText(attribute);
  if (row.takes_back_end_options) out += "  and the options of the back end that `backend` names\n";
  for (const control::PresenceRule& rule : row.presence) out += "  " + presenceText(rule) + "\n";
  if (!row.ports.empty()) out += "\nports, read as signal.port\n";
  for (const control::PortRow& port : row.ports) {
    const std::string unit = unitText(port.unit);
    out += "  " + port.name + ": " + port.type + (unit.empty() ? "" : "; " + unit) + "\n" +
           (port.description.empty() ? "" : "      " + port.description + "\n");
  }
  if (!row.children.empty()) out += "\nchildren\n";
  for (const control::ChildRow& child : row.children) out += "  " + childText(child) + "\n";
  return out;
}

ordered_json elementJson(const ElementRow& row) {
  ordered_json json{{"name", row.name}, {"kind", textOf(row.kind).key}, {"description", row.description}};
  if (!row.source.empty()) json["source"] = row.source;
  addHistory(row, json);
  json["attributes"] = ordered_json::array();
  for (const AttributeRow& attribute : row.attributes) json["attributes"].push_back(attributeJson(attribute));
  json["presence"] = ordered_json::array();
  for (const control::PresenceRule& rule : row.presence) json["presence"].push_back(presenceText(rule));
  json["ports"] = ordered_json::array();
  for (const control::PortRow& port : row.ports) {
    json["ports"].push_back(
        {{"name", port.name}, {"type", port.type}, {"unit", port.unit}, {"description", port.description}});
  }
  json["children"] = ordered_json::array();
  for (const control::ChildRow& child : row.children)
    json["children"].push_back({{"element", child.element}, {"min", child.min}, {"max", child.max}});
  return json;
}

}  // namespace tactus::dsl
