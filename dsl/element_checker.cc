#include "dsl/element_checker.h"

#include <algorithm>
#include <set>

#include "dsl/nearest_name.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ChildRow;
using control::ElementRow;
using control::ElementValues;
using control::Origin;
using control::Value;

std::string tag(const std::string& name) { return std::string("<").append(name).append(">"); }

std::string allListed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The first dozen.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 12;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < most; ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > most ? text + ", …" : text;
}

std::string kindOf(const ChildRow& child) {
  if (child.element.starts_with('@')) return child.element.substr(1);
  return tag(child.element);
}

std::vector<std::string> attributeNames(const ElementRow& row, const ElementRow* more) {
  std::vector<std::string> names;
  for (const AttributeRow& attribute : row.attributes) names.push_back(attribute.name);
  if (more)
    for (const AttributeRow& attribute : more->attributes) names.push_back(attribute.name);
  return names;
}

}  // namespace

std::vector<const CheckedElement*> CheckedElement::all(std::string_view name) const {
  std::vector<const CheckedElement*> found;
  for (const CheckedElement& child : children)
    if (child.row->name == name) found.push_back(&child);
  return found;
}

const CheckedElement* CheckedElement::first(std::string_view name) const {
  const auto found = all(name);
  return found.empty() ? nullptr : found.front();
}

control::ElementValues valuesWithin(const CheckedElement& element) {
  control::ElementValues values = element.values;
  values.place = element.xml->place();
  for (const CheckedElement& child : element.children) values.children.push_back(valuesWithin(child));
  return values;
}

CheckedElement ElementChecker::check(const XmlElement& root) {
  readClasses(root);
  return checkElement(root, *table_.find(root.name));
}

void ElementChecker::readClasses(const XmlElement& stack) {
  for (const auto& child : stack.children) {
    const XmlAttribute* name = child->name == "defaults" ? child->attribute("class") : nullptr;
    if (!name) continue;
    const auto [place, is_new] = classes_.emplace(name->value, DefaultsClass{child.get(), "", {}});
    if (!is_new) {
      findings_.errorAtValue(code::duplicate_name, *child, *name,
                             "the stack has a class '" + name->value + "' already");
      continue;
    }
    if (const XmlAttribute* base = child->attribute("base")) place->second.base = base->value;
    readPrototypes(*child, place->second);
  }
  checkBases();
}

void ElementChecker::readPrototypes(const XmlElement& defaults, DefaultsClass& into) {
  for (const auto& child : defaults.children) {
    const ElementRow* row = table_.find(child->name);
    if (!row) continue;  // the grammar says so
    if (into.prototypes.count(child->name)) {
      findings_.error(code::too_many_elements, *child, "this class gives values for " + tag(child->name) + " already");
      continue;
    }
    ElementValues values(*row);
    checkGivenAttributes(*child, *row, values);
    Prototype& prototype = into.prototypes[child->name];
    for (const auto& [name, value] : values.all()) {
      if (name == "name" || name == "class") {
        findings_.errorAtName(code::unknown_attribute, *child, *child->attribute(name),
                              "an element in <defaults> has no attribute '" + name + "'");
        continue;
      }
      Value inherited = value;
      inherited.origin.kind = Origin::Kind::defaults_class;
      inherited.origin.detail = defaults.attribute("class")->value;
      prototype.emplace(name, std::move(inherited));
    }
  }
}

void ElementChecker::checkBases() {
  std::vector<std::string> names;
  for (const auto& [name, found] : classes_) names.push_back(name);
  for (auto& [name, found] : classes_) {
    if (found.base.empty()) continue;
    const XmlAttribute& base = *found.xml->attribute("base");
    if (!classes_.count(found.base)) {
      findings_.errorAtValue(code::unknown_class, *found.xml, base, "the stack has no class '" + found.base + "'",
                             nearestName(found.base, names));
      found.base.clear();
      continue;
    }
    std::set<std::string> seen{name};
    for (std::string at = found.base; !at.empty(); at = classes_.at(at).base) {
      if (seen.insert(at).second && classes_.count(at)) continue;
      if (at == name)
        findings_.errorAtValue(code::reference_cycle, *found.xml, base,
                               "class '" + name + "' is its own base, directly or through others");
      found.base.clear();
      break;
    }
  }
}

std::vector<std::string> ElementChecker::allowedChildren(const ElementRow& row) const {
  std::vector<std::string> names;
  for (const ChildRow& child : row.children)
    for (const ElementRow& candidate : table_.rows())
      if (child.allows(candidate)) names.push_back(candidate.name);
  return names;
}

const ElementRow* ElementChecker::backEndOf(const XmlElement& element) const {
  const XmlAttribute* name = element.attribute("backend");
  return name ? table_.findBackEnd(name->value) : nullptr;
}

CheckedElement ElementChecker::checkElement(const XmlElement& element, const ElementRow& row) {
  CheckedElement checked;
  checked.xml = &element;
  checked.row = &row;
  checked.values = ElementValues(row);
  checkText(element);
  if (!row.deprecated.empty())
    findings_.warning(code::deprecated_part, element, tag(row.name) + " is deprecated: " + row.deprecated);
  checked.complete = checkGivenAttributes(element, row, checked.values);
  const bool prototype = element.parent && element.parent->name == "defaults";
  if (!prototype) {
    fillFromClass(element, checked.values);
    if (!checkPresence(element, row, checked.values)) checked.complete = false;
    if (!fillDefaults(element, row, checked.values)) checked.complete = false;
  }
  if (prototype) {
    for (const auto& child : element.children)
      findings_.error(code::misplaced_element, *child, "an element in <defaults> gives attributes only");
  } else {
    checkChildren(element, row, checked);
  }
  return checked;
}

void ElementChecker::checkText(const XmlElement& element) {
  if (element.text_at != nowhere)
    findings_.error(code::stray_text, *element.source, element.text_at, 1,
                    "text must not stand in " + tag(element.name) + ": values are given as attributes");
}

void ElementChecker::checkChildren(const XmlElement& element, const ElementRow& row, CheckedElement& into) {
  std::map<std::string, int> counts;
  bool some_unknown = false;
  const auto ruleFor = [&](const ElementRow* child) {
    return std::find_if(row.children.begin(), row.children.end(),
                        [&](const ChildRow& candidate) { return child && candidate.allows(*child); });
  };
  for (const auto& child : element.children) {
    const ElementRow* child_row = table_.find(child->name);
    const auto rule = ruleFor(child_row);
    if (rule == row.children.end()) {
      const auto allowed = allowedChildren(row);
      sayMisplaced(*child, element, allowed);
      const auto meant = ruleFor(table_.find(nearestName(child->name, allowed)));
      if (meant != row.children.end()) ++counts[meant->element];
      if (!child_row) some_unknown = true;
      continue;
    }
    const int count = ++counts[rule->element];
    if (rule->max >= 0 && count == rule->max + 1)
      findings_.error(code::too_many_elements, *child,
                      tag(element.name) + " takes at most " + std::to_string(rule->max) + " " + kindOf(*rule));
    into.children.push_back(checkElement(*child, *child_row));
  }
  // What an unknown element may have been meant as is not called missing, too.
  for (const ChildRow& rule : row.children)
    if (counts[rule.element] < rule.min && !element.incomplete && !(some_unknown && rule.element.starts_with('@')))
      findings_.error(code::missing_element, element,
                      tag(element.name) + " needs " + (rule.min == 1 ? "a " : std::to_string(rule.min) + " ") +
                          kindOf(rule));
}

void ElementChecker::sayMisplaced(const XmlElement& child, const XmlElement& parent,
                                  const std::vector<std::string>& allowed) {
  const ElementRow* row = table_.find(child.name);
  if (!row) {
    std::string message = "there is no element " + tag(child.name);
    if (child.name.find('.') != std::string::npos) message += " (is its plugin named by a <plugin>?)";
    message += allowed.empty() ? "; " + tag(parent.name) + " takes none" : "; here may stand: " + listed(allowed);
    return findings_.error(code::unknown_element, child, message, nearestName(child.name, allowed));
  }
  std::vector<std::string> homes;
  for (const ElementRow& candidate : table_.rows())
    for (const ChildRow& rule : candidate.children)
      if (candidate.name != "defaults" && rule.allows(*row)) homes.push_back(tag(candidate.name));
  findings_.error(code::misplaced_element, child,
                  tag(child.name) + " must not stand in " + tag(parent.name) +
                      (homes.empty() ? "" : ": it belongs in " + listed(homes)));
}

bool ElementChecker::checkGivenAttributes(const XmlElement& element, const ElementRow& row, ElementValues& values) {
  bool right = true;
  const ElementRow* back_end = row.takes_back_end_options ? backEndOf(element) : nullptr;
  for (const XmlAttribute& attribute : element.attributes) {
    const AttributeRow* known = row.attribute(attribute.name);
    if (!known && back_end) known = back_end->attribute(attribute.name);
    if (!known && !element.parent && isSchemaHint(attribute)) continue;
    if (!known) {
      right = false;
      if (row.takes_back_end_options && !back_end) continue;  // which options there are depends on the back end
      const std::string whose = back_end ? "back end '" + back_end->name + "'" : tag(element.name);
      const auto names = attributeNames(row, back_end);
      const std::string nearest = nearestName(attribute.name, names);
      std::string message = whose + " has no " + (back_end ? "option '" : "attribute '") + attribute.name + "'";
      if (nearest.empty()) message += names.empty() ? "; it takes none" : "; it takes " + allListed(names);
      findings_.errorAtName(code::unknown_attribute, element, attribute, message, nearest);
      continue;
    }
    if (!known->deprecated.empty())
      findings_.warningAtName(code::deprecated_part, element, attribute,
                              "attribute '" + attribute.name + "' is deprecated: " + known->deprecated);
    if (attribute.value.find("${") != std::string::npos) {
      right = false;
      continue;
    }
    std::string error;
    auto value = control::parseValue(*known, attribute.value, error);
    if (!value) {
      right = false;
      findings_.errorAtValue(
          code::bad_value, element, attribute, "attribute '" + attribute.name + "': " + error,
          known->type == control::ValueType::choice ? nearestName(attribute.value, known->choices) : "");
      continue;
    }
    value->origin.kind = attribute.setting.empty() ? Origin::Kind::attribute : Origin::Kind::command_line;
    value->origin.detail = attribute.setting;
    value->origin.place = element.source->text.place(attribute.value_at);
    values.set(attribute.name, std::move(*value));
  }
  return right;
}

void ElementChecker::fillFromClass(const XmlElement& element, ElementValues& values) {
  const AttributeRow* row = values.row().attribute("class");
  if (!row || row->type != control::ValueType::element_class || !values.has("class")) return;
  std::string name = values.text("class");
  if (!classes_.count(name)) {
    std::vector<std::string> names;
    for (const auto& [known, found] : classes_) names.push_back(known);
    return findings_.errorAtValue(code::unknown_class, element, *element.attribute("class"),
                                  "the stack has no class '" + name + "'", nearestName(name, names));
  }
  for (; !name.empty(); name = classes_.at(name).base) {
    const auto& prototypes = classes_.at(name).prototypes;
    const auto found = prototypes.find(element.name);
    if (found == prototypes.end()) continue;
    for (const auto& [attribute, value] : found->second)
      if (!values.has(attribute) && !element.attribute(attribute)) values.set(attribute, value);
  }
}

/// The values at hand are those of the element and its classes; a wrong one counts as given, too.
bool ElementChecker::checkPresence(const XmlElement& element, const ElementRow& row, const ElementValues& values) {
  bool right = true;
  const auto isGiven = [&](const std::string& name) { return values.has(name) || element.attribute(name); };
  for (const control::PresenceRule& rule : row.presence) {
    std::vector<std::string> given, missing;
    for (const std::string& name : rule.attributes) (isGiven(name) ? given : missing).push_back("'" + name + "'");
    const auto say = [&](const Code& code, const std::string& message) {
      right = false;
      const std::string at = given.empty() ? "" : given.back().substr(1, given.back().size() - 2);
      const XmlAttribute* written = at.empty() ? nullptr : element.attribute(at);
      if (written)
        findings_.errorAtName(code, element, *written, message);
      else
        findings_.error(code, element, message);
    };
    std::string all;
    for (const std::string& name : rule.attributes) all += (all.empty() ? "'" : ", '") + name + "'";
    switch (rule.kind) {
      case control::Presence::exclusive:
        if (given.size() > 1) say(code::attributes_clash, tag(row.name) + " takes at most one of " + all);
        break;
      case control::Presence::together:
        if (!given.empty() && !missing.empty())
          say(code::attributes_clash, tag(row.name) + " takes " + all + " together: " + allListed(missing) + " is missing");
        break;
      case control::Presence::any_of:
        if (given.empty()) say(code::missing_attribute, tag(row.name) + " needs at least one of " + all);
        break;
      case control::Presence::one_of:
        if (given.empty()) say(code::missing_attribute, tag(row.name) + " needs one of " + all);
        if (given.size() > 1) say(code::attributes_clash, tag(row.name) + " takes only one of " + all);
        break;
      case control::Presence::needs:
        if (isGiven(rule.attributes.front()) && !missing.empty())
          say(code::attributes_clash, "'" + rule.attributes.front() + "' needs " + allListed(missing) + ", too");
        break;
    }
  }
  return right;
}

bool ElementChecker::fillDefaults(const XmlElement& element, const ElementRow& row, ElementValues& values) {
  bool complete = true;
  for (const AttributeRow& attribute : row.attributes) {
    if (values.has(attribute.name) || element.attribute(attribute.name)) continue;
    std::string error;
    if (attribute.default_text) {
      values.set(attribute.name, control::parseValue(attribute, *attribute.default_text, error).value());
    } else if (attribute.required) {
      complete = false;
      findings_.error(code::missing_attribute, element,
                      tag(element.name) + " needs the attribute '" + attribute.name + "'");
    }
  }
  return complete;
}

}  // namespace tactus::dsl
