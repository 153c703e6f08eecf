#include "apps/tactus/explain_stack.h"

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/tactus/text.h"
#include "dsl/element_text.h"
#include "dsl/source_text.h"

namespace tactus::app {
namespace {

using control::AttributeRow;
using control::ElementValues;
using control::Origin;
using control::Value;
using nlohmann::ordered_json;

std::string placeText(const description::Place& place) {
  return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

const char* keyOf(Origin::Kind kind) {
  switch (kind) {
    case Origin::Kind::table_default: return "default";
    case Origin::Kind::defaults_class: return "class";
    case Origin::Kind::attribute: return "attribute";
    case Origin::Kind::command_line: return "command line";
  }
  return "";
}

/// "class soft, stack.xml:4:30", "--set press=1, stack.xml:9:57"
std::string originText(const Origin& origin) {
  std::string text;
  switch (origin.kind) {
    case Origin::Kind::table_default: text = "default"; break;
    case Origin::Kind::defaults_class: text = "class " + origin.detail; break;
    case Origin::Kind::attribute: break;
    case Origin::Kind::command_line: text = origin.detail; break;
  }
  if (origin.place.line > 0) text += (text.empty() ? "" : ", ") + placeText(origin.place);
  return text;
}

std::string padded(const std::string& text, size_t width) {
  const auto characters = static_cast<size_t>(dsl::countCharacters(text));
  return text + std::string(characters < width ? width - characters : 0, ' ');
}

/// On one line, with single blanks.
std::string oneLine(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
    if (!blank) out += c;
    else if (!out.empty() && out.back() != ' ') out += ' ';
  }
  return out.empty() ? "empty" : out;
}

/// What stands on the left, and where it comes from.
struct Line {
  std::string text;
  std::string origin;
};

/// Origins in one column, to the right of every line that is not overlong.
std::string aligned(const std::vector<Line>& lines) {
  constexpr size_t most = 80;
  size_t width = 0;
  for (const Line& line : lines) {
    const auto characters = static_cast<size_t>(dsl::countCharacters(line.text));
    if (characters <= most) width = std::max(width, characters);
  }
  std::string out;
  for (const Line& line : lines) out += padded(line.text, width) + "  " + line.origin + "\n";
  return out;
}

size_t longestName(const ElementValues& values) {
  size_t longest = 0;
  for (const auto& [name, value] : values.all()) longest = std::max(longest, name.size());
  return longest;
}

void writeValues(const ElementValues& values, const std::string& indent, size_t names, std::vector<Line>& out) {
  for (const AttributeRow& row : values.row().attributes) {
    if (!values.has(row.name)) continue;
    const Value& value = values.value(row.name);
    const std::string unit = dsl::unitText(row.unit);
    const std::string shown = oneLine(value.text) + (unit.empty() ? "" : " " + unit);
    out.push_back({indent + padded(row.name, names) + "  " + shown, originText(value.origin)});
  }
}

void addValues(const ElementValues& values, ordered_json& json) {
  for (const AttributeRow& row : values.row().attributes) {
    if (!values.has(row.name)) continue;
    const Value& value = values.value(row.name);
    ordered_json entry{{"name", row.name}, {"value", value.text}};
    if (!row.unit.empty()) entry["unit"] = row.unit;
    entry["origin"] = keyOf(value.origin.kind);
    if (!value.origin.detail.empty()) entry["detail"] = value.origin.detail;
    if (value.origin.place.line > 0) {
      entry["file"] = value.origin.place.file;
      entry["line"] = value.origin.place.line;
      entry["column"] = value.origin.place.column;
    }
    json.push_back(entry);
  }
}

/// "links that touch each other: 2 pairs", then those of the links asked for that do not, and why.
void writeSelfContact(const dsl::Stack& stack, std::ostream& out) {
  if (stack.self_contact == "none") return;
  const auto names = [&](const description::LinkPair& pair) {
    return stack.robot.links[static_cast<size_t>(pair.one)].name + " and " +
           stack.robot.links[static_cast<size_t>(pair.other)].name;
  };
  const size_t count = stack.self_contacts.touching.size();
  out << "\nself-contact: " << count << (count == 1 ? " pair" : " pairs") << " of links may touch; these do not:\n";
  for (const dynamics::SelfContact::LeftOut& left_out : stack.self_contacts.left_out)
    out << "  " << names(left_out.links) << ": " << left_out.why << "\n";
}

ordered_json selfContactJson(const dsl::Stack& stack) {
  const auto names = [&](const description::LinkPair& pair) {
    return ordered_json::array({stack.robot.links[static_cast<size_t>(pair.one)].name,
                                stack.robot.links[static_cast<size_t>(pair.other)].name});
  };
  ordered_json touching = ordered_json::array(), left_out = ordered_json::array();
  for (const description::LinkPair& pair : stack.self_contacts.touching) touching.push_back(names(pair));
  for (const dynamics::SelfContact::LeftOut& one : stack.self_contacts.left_out)
    left_out.push_back({{"links", names(one.links)}, {"why", one.why}});
  return {{"touching", touching}, {"left_out", left_out}};
}

bool hasOptions(const dsl::ResolvedElement& element) { return !element.options.all().empty(); }

}  // namespace

int explainStack(const StackOptions& options, const std::vector<std::string>& plugins, bool json) {
  Program program(plugins);
  const dsl::Stack stack = readAloud(program, options);
  ordered_json elements = ordered_json::array();
  std::vector<Line> lines;
  for (const dsl::ResolvedElement& element : stack.elements) {
    const std::string indent(static_cast<size_t>(2 * element.depth), ' ');
    const size_t names = std::max(longestName(element.values), longestName(element.options));
    lines.push_back({indent + "<" + element.values.row().name + ">", placeText(element.place)});
    writeValues(element.values, indent + "  ", names, lines);
    ordered_json attributes = ordered_json::array();
    addValues(element.values, attributes);
    if (hasOptions(element)) {
      writeValues(element.options, indent + "  ", names, lines);
      addValues(element.options, attributes);
    }
    elements.push_back({{"element", element.values.row().name},
                        {"path", element.path},
                        {"file", element.place.file},
                        {"line", element.place.line},
                        {"column", element.place.column},
                        {"values", attributes}});
  }
  if (json) {
    ordered_json told{{"stack", stack.name}, {"elements", elements}};
    if (stack.self_contact != "none") told["self_contact"] = selfContactJson(stack);
    std::cout << jsonText(told, 2) << "\n";
  } else {
    std::cout << aligned(lines);
    writeSelfContact(stack, std::cout);
  }
  return exit_done;
}

}  // namespace tactus::app
