#include "dsl/reference_checker.h"

#include <algorithm>

#include "dsl/nearest_name.h"
#include "dsl/typed_attributes.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ValueType;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::vector<std::string> namesOf(const std::vector<description::Group>& groups) {
  std::vector<std::string> names;
  for (const auto& group : groups) names.push_back(group.name);
  return names;
}

std::vector<std::string> linkNames(const description::Robot& robot, bool with_groups) {
  std::vector<std::string> names = with_groups ? namesOf(robot.link_groups) : std::vector<std::string>{};
  for (const auto& link : robot.links) names.push_back(link.name);
  return names;
}

std::string unitText(const std::string& unit) { return unit == "1" ? "a number without unit" : unit; }

std::vector<std::string> jointNames(const description::Robot& robot) {
  std::vector<std::string> names = namesOf(robot.joint_groups);
  for (int i : robot.movingJoints()) names.push_back(robot.joints[static_cast<std::size_t>(i)].name);
  return names;
}

}  // namespace

void ReferenceChecker::say(const Code& code, const CheckedElement& element, const AttributeRow& row,
                           const std::string& message, const std::string& suggestion, std::size_t word) {
  if (const XmlAttribute* written = element.xml->attribute(row.name))
    return findings_.errorAtWord(code, *element.xml, *written, word, message, suggestion);
  // From a class: told by the element that uses it, since another robot or scene might suit.
  const std::string& of = element.values.value(row.name).origin.detail;
  findings_.error(code, *element.xml, "attribute '" + row.name + "' from class '" + of + "': " + message, suggestion);
}

void ReferenceChecker::checkAll(const CheckedElement& element) {
  check(element);
  for (const CheckedElement& child : element.children) checkAll(child);
}

void ReferenceChecker::check(const CheckedElement& element) {
  for (const AttributeRow& row : element.row->attributes)
    if (element.values.has(row.name)) checkValue(element, row);
}

void ReferenceChecker::checkValue(const CheckedElement& element, const AttributeRow& row) {
  const std::string& text = element.values.text(row.name);
  // What stands in the table by default may be missing as long as the element does not ask for it.
  const bool by_default = element.values.value(row.name).origin.kind == control::Origin::Kind::table_default;
  if (by_default) {
    if (row.type == ValueType::port) read_signals_.push_back(text.substr(0, text.find('.')));
    return;
  }
  switch (row.type) {
    case ValueType::link:
      if (robot_known_) checkWords(element, row, linkNames(stack_.robot, false), code::unknown_link, "link");
      break;
    case ValueType::links:
      if (robot_known_)
        checkWords(element, row, linkNames(stack_.robot, true), code::unknown_link, "link or group of links");
      break;
    case ValueType::joints:
      if (robot_known_)
        checkWords(element, row, jointNames(stack_.robot), code::unknown_joint, "moving joint or group of joints");
      break;
    case ValueType::object: {
      std::vector<std::string> names;
      for (const auto& object : stack_.objects) names.push_back(object.object.name);
      if (!contains(names, text))
        say(code::unknown_object, element, row, "the scene has no object '" + text + "'", nearestName(text, names));
      break;
    }
    case ValueType::port:
      checkPort(element, row);
      break;
    default: break;
  }
}

void ReferenceChecker::checkWords(const CheckedElement& element, const AttributeRow& row,
                                  const std::vector<std::string>& names, const Code& unknown, const std::string& what) {
  const std::string& text = element.values.text(row.name);
  auto words = row.type == ValueType::link ? std::vector<std::string>{text} : splitWords(text);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (contains(names, word)) continue;
    if (contains(row.choices, word)) {
      if (words.size() > 1)
        say(code::bad_value, element, row, "'" + word + "' stands alone, with no other names", "", i);
      continue;
    }
    if (row.type == ValueType::link && contains(namesOf(stack_.robot.link_groups), word)) {
      say(code::unknown_link, element, row, "'" + word + "' is a group of links: one link is taken here");
      continue;
    }
    std::vector<std::string> candidates = names;
    candidates.insert(candidates.end(), row.choices.begin(), row.choices.end());
    say(unknown, element, row, "the robot has no " + what + " '" + word + "'", nearestName(word, candidates), i);
  }
}

void ReferenceChecker::checkPort(const CheckedElement& element, const AttributeRow& row) {
  const std::string& text = element.values.text(row.name);
  if (contains(row.choices, text)) return;
  const std::size_t dot = text.find('.');
  const std::string signal = text.substr(0, dot), port = text.substr(dot + 1);
  const ElementInstance* found = stack_.source(signal);
  if (!found) {
    std::vector<std::string> ports;
    for (const ElementInstance* instance : stack_.sources())
      for (const control::PortRow& candidate : instance->values.ports())
        if (candidate.type == row.port_type) ports.push_back(instance->name + "." + candidate.name);
    return say(code::unknown_port, element, row, "the stack has no signal '" + signal + "'", nearestName(text, ports));
  }
  read_signals_.push_back(signal);
  std::vector<std::string> of_type, all;
  const std::vector<control::PortRow> ports = found->values.ports();
  for (const control::PortRow& candidate : ports) {
    all.push_back(candidate.name);
    if (candidate.type == row.port_type) of_type.push_back(candidate.name);
  }
  const auto known =
      std::find_if(ports.begin(), ports.end(), [&](const auto& candidate) { return candidate.name == port; });
  if (known == ports.end()) {
    const std::string nearest = nearestName(port, all);
    std::string listed;
    for (const std::string& name : all) listed += (listed.empty() ? "" : ", ") + name;
    return say(
        code::unknown_port, element, row,
        "signal '" + signal + "' has no port '" + port + "'" + (listed.empty() ? "" : ": its ports are " + listed),
        nearest.empty() ? "" : signal + "." + nearest);
  }
  if (known->type != row.port_type)
    return say(code::wrong_port_type, element, row,
               "'" + text + "' is a " + known->type + ", but '" + row.name + "' takes a " + row.port_type,
               of_type.size() == 1 ? signal + "." + of_type.front() : "");
  if (!row.unit.empty() && !known->unit.empty() && known->unit != row.unit)
    return say(code::wrong_port_unit, element, row,
               "'" + text + "' is " + (known->unit == "1" ? "" : "in ") + unitText(known->unit) +
                   ", but '" + row.name + "' takes " + unitText(row.unit));
  if (row.count > 0 && known->dimension > 0 && known->dimension != row.count)
    say(code::wrong_port_unit, element, row,
        "'" + text + "' has " + std::to_string(known->dimension) + " numbers, but '" + row.name + "' takes " +
            std::to_string(row.count));
}

void ReferenceChecker::warnOfUnusedSignals(const std::vector<const CheckedElement*>& signals) {
  for (const CheckedElement* signal : signals) {
    // A sensor also changes what is felt; what it reads may be for the log alone.
    if (!signal->values.has("name") || signal->row->kind != control::ElementKind::signal) continue;
    const bool reads =
        std::any_of(signal->row->attributes.begin(), signal->row->attributes.end(),
                    [&](const auto& row) { return row.type == ValueType::port && signal->values.has(row.name); });
    if (!reads && !contains(read_signals_, signal->values.text("name")))
      findings_.warning(code::unused_signal, *signal->xml,
                        "nothing reads the signal '" + signal->values.text("name") + "'");
  }
}

}  // namespace tactus::dsl
