#include "framework/control/element_table.h"

#include <algorithm>
#include <set>

#include "framework/control/element_values.h"

namespace tactus::control {
namespace {

bool isNameCharacter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// An XML name without colons; dots part a vendor from its element: "acme.wiggle".
bool isElementName(std::string_view name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  bool at_start = true;
  for (char c : name) {
    if (at_start ? !letter(c) : !(isNameCharacter(c) || c == '.')) return false;
    at_start = c == '.';
  }
  return !at_start;
}

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

void checkAttribute(const std::string& where, const AttributeRow& row) {
  const std::string attribute = where + ": attribute '" + row.name + "'";
  if (!isElementName(row.name)) refuse(where + ": '" + row.name + "' is not a name for an attribute");
  if (row.type == ValueType::choice && row.choices.empty()) refuse(attribute + " is a choice without choices");
  if (row.type == ValueType::port && row.port_type.empty()) refuse(attribute + " is a port without a port type");
  if (row.type == ValueType::points && row.count <= 0) refuse(attribute + " has points without a count");
  if (row.lower > row.upper) refuse(attribute + " has an empty range");
  if (!row.reached_by.empty() && row.type != ValueType::reals && row.type != ValueType::points)
    refuse(attribute + " is reached by a link, but holds no places");
  if (!row.default_text) return;
  if (row.required) refuse(attribute + " is required and has a default");
  std::string error;
  if (!parseValue(row, *row.default_text, error)) refuse(attribute + ": its default is not valid: " + error);
}

void checkRow(const ElementRow& row) {
  const std::string where = "<" + row.name + ">";
  if (!isElementName(row.name)) refuse("'" + row.name + "' is not a name for an element");
  std::set<std::string> names;
  for (const AttributeRow& attribute : row.attributes) {
    checkAttribute(where, attribute);
    if (!names.insert(attribute.name).second) refuse(where + ": attribute '" + attribute.name + "' stands twice");
  }
  for (const AttributeRow& attribute : row.attributes)
    for (const std::string& former : attribute.formerly)
      if (!isElementName(former) || !names.insert(former).second)
        refuse(where + ": attribute '" + attribute.name + "' cannot once have been '" + former + "'");
  for (const PresenceRule& rule : row.presence) {
    if (rule.attributes.size() < 2) refuse(where + ": a presence rule has at least two attributes");
    for (const std::string& name : rule.attributes)
      if (!row.attribute(name)) refuse(where + ": a presence rule names '" + name + "', which is no attribute");
  }
  std::set<std::string> ports;
  for (const PortRow& port : row.ports) {
    const bool of_children = port.name.starts_with('@');
    if (!isElementName(std::string_view(port.name).substr(of_children ? 1 : 0))) refuse(where + ": '" + port.name + "' is not a name for a port");
    if (!ports.insert(port.name).second) refuse(where + ": port '" + port.name + "' stands twice");
  }
  const bool sensor = row.kind == ElementKind::sensor;
  if (row.kind != ElementKind::signal && !sensor && !row.ports.empty())
    refuse(where + ": only signals and sensors have ports");
  for (const AttributeRow& attribute : row.attributes)
    if (sensor && attribute.type == ValueType::port)
      refuse(where + ": attribute '" + attribute.name + "': a sensor stands before all signals and reads no ports");
  for (const PortRow& port : row.ports)
    if (sensor && port.type != "scalar" && port.type != "vector")
      refuse(where + ": port '" + port.name + "' of a sensor is a scalar or a vector");
  for (const ChildRow& child : row.children)
    if (child.min < 0 || (child.max >= 0 && child.max < child.min))
      refuse(where + ": child '" + child.element + "' has an empty range");
}

}  // namespace

bool ChildRow::allows(const ElementRow& row) const {
  switch (row.kind) {
    case ElementKind::shape: return element == "@shape";
    case ElementKind::sensor: return element == "@sensor" || element == row.name;
    case ElementKind::signal: return element == "@signal";
    case ElementKind::task: return element == "@task";
    case ElementKind::controller: return element == "@controller";
    case ElementKind::measure: return element == "@measure";
    case ElementKind::recorder: return element == "@recorder";
    case ElementKind::structure: return element == row.name;
    case ElementKind::back_end: break;                             // no element of its own
  }
  return false;
}

const AttributeRow* ElementRow::attribute(std::string_view wanted) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const AttributeRow& attribute) { return attribute.name == wanted; });
  return found == attributes.end() ? nullptr : &*found;
}

const AttributeRow* ElementRow::formerAttribute(std::string_view name) const {
  for (const AttributeRow& attribute : attributes)
    if (std::find(attribute.formerly.begin(), attribute.formerly.end(), name) != attribute.formerly.end())
      return &attribute;
  return nullptr;
}

void ElementTable::add(ElementRow row) {
  checkRow(row);
  const bool back_end = row.kind == ElementKind::back_end;
  if (back_end ? findBackEnd(row.name) : find(row.name))
    refuse((back_end ? "back end '" : "element '") + row.name + "' is in the table already");
  for (const std::string& former : row.formerly)
    if (!isElementName(former) || back_end || find(former) || findFormer(former))
      refuse("element '" + row.name + "' cannot once have been '" + former + "'");
  if (!back_end && findFormer(row.name)) refuse("element '" + row.name + "' is the former name of another one");
  rows_.push_back(std::move(row));
}

const ElementRow* ElementTable::find(std::string_view name) const {
  for (const ElementRow& row : rows_)
    if (row.kind != ElementKind::back_end && row.name == name) return &row;
  return nullptr;
}

const ElementRow* ElementTable::findBackEnd(std::string_view name) const {
  for (const ElementRow& row : rows_)
    if (row.kind == ElementKind::back_end && row.name == name) return &row;
  return nullptr;
}

const ElementRow* ElementTable::findFormer(std::string_view name) const {
  for (const ElementRow& row : rows_)
    if (std::find(row.formerly.begin(), row.formerly.end(), name) != row.formerly.end()) return &row;
  return nullptr;
}

}  // namespace tactus::control
