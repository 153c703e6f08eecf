#include "dsl/schema.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "dsl/element_text.h"
#include "framework/runtime/version.h"

namespace tactus::dsl {
namespace {

using control::AttributeRow;
using control::ElementKind;
using control::ElementRow;
using control::ElementTable;
using control::ValueType;

std::string escape(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

// ---- XML Schema.

constexpr const char* parameter = ".*[$]\\{[^{}]*\\}.*";               // ${name} somewhere
constexpr const char* number = "[+\\-]?([0-9]+(\\.[0-9]*)?|\\.[0-9]+)([eE][+\\-]?[0-9]+)?";

std::string patternType(const std::string& name, const std::string& pattern) {
  return "  <xs:simpleType name=\"" + name + "\">\n    <xs:restriction base=\"xs:string\">\n      <xs:pattern value=\"" +
         escape(pattern) + "\"/>\n    </xs:restriction>\n  </xs:simpleType>\n";
}

/// Types that many attributes share; numbers of a list are not told apart, which keeps editors quick.
std::string sharedTypes() {
  const std::string or_parameter = std::string("|") + parameter;
  return patternType("parameter", parameter) + patternType("identifier", "[A-Za-z][A-Za-z0-9_\\-]*" + or_parameter) +
         patternType("integer", "\\s*[+\\-]?[0-9]+\\s*" + or_parameter) +
         patternType("real", std::string("\\s*") + number + "\\s*" + or_parameter) +
         patternType("reals", "[0-9+\\-.eE\\s]*" + or_parameter) +
         patternType("points", "[0-9+\\-.eE;\\s]*" + or_parameter) +
         "  <xs:simpleType name=\"flag\">\n    <xs:union memberTypes=\"parameter\">\n      <xs:simpleType>\n"
         "        <xs:restriction base=\"xs:string\">\n          <xs:enumeration value=\"true\"/>\n"
         "          <xs:enumeration value=\"false\"/>\n        </xs:restriction>\n      </xs:simpleType>\n"
         "    </xs:union>\n  </xs:simpleType>\n";
}

std::string documentation(const std::string& indent, const std::string& text) {
  return indent + "<xs:annotation><xs:documentation>" + escape(text) + "</xs:documentation></xs:annotation>\n";
}

std::string hint(const AttributeRow& row) {
  std::string text = typeText(row);
  if (!unitText(row.unit).empty()) text += ", " + row.unit;
  if (!rangeText(row).empty()) text += ", " + rangeText(row);
  if (row.default_text) text += ", default " + (row.default_text->empty() ? "empty" : *row.default_text);
  if (!row.deprecated.empty()) text += ". DEPRECATED: " + row.deprecated;
  return row.description + " (" + text + ")";
}

std::string typeName(const AttributeRow& row) {
  switch (row.type) {
    case ValueType::identifier: return "identifier";
    case ValueType::flag: return "flag";
    case ValueType::integer: return "integer";
    case ValueType::real: return "real";
    case ValueType::reals: return "reals";
    case ValueType::points: return "points";
    default: return "xs:string";
  }
}

std::string attributeXsd(const std::string& indent, const AttributeRow& row, bool required) {
  std::string out = indent + "<xs:attribute name=\"" + row.name + "\"";
  const bool words = !row.choices.empty();
  if (!words) out += " type=\"" + typeName(row) + "\"";
  if (required) out += " use=\"required\"";
  out += ">\n" + documentation(indent + "  ", hint(row));
  if (words) {
    // Other texts stay possible where the words are only some of what may be written.
    const std::string others = row.type == ValueType::choice ? "parameter" : "xs:string";
    out += indent + "  <xs:simpleType><xs:union memberTypes=\"" + others + "\"><xs:simpleType>" +
           "<xs:restriction base=\"xs:string\">\n";
    for (const std::string& word : row.choices) out += indent + "    <xs:enumeration value=\"" + escape(word) + "\"/>\n";
    out += indent + "  </xs:restriction></xs:simpleType></xs:union></xs:simpleType>\n";
  }
  return out + indent + "</xs:attribute>\n";
}

/// The options of all back ends, each once; of two that share a name, the first describes it.
std::vector<AttributeRow> optionsOfBackEnds(const ElementTable& table, const ElementRow& row) {
  std::vector<AttributeRow> options;
  std::set<std::string> names;
  for (const AttributeRow& own : row.attributes) names.insert(own.name);
  for (const ElementRow& back_end : table.rows()) {
    if (back_end.kind != ElementKind::back_end) continue;
    for (AttributeRow option : back_end.attributes) {
      if (!names.insert(option.name).second) continue;
      option.type = ValueType::text;                               // another back end may want another type
      option.choices.clear();
      options.push_back(std::move(option));
    }
  }
  return options;
}

/// `prototype`: the element as it stands in <defaults>, without children, name and class.
std::string complexType(const ElementTable& table, const ElementRow& row, const std::string& indent, bool prototype) {
  std::string out = indent + "<xs:complexType>\n";
  std::vector<std::string> children;
  for (const ElementRow& candidate : table.rows())
    for (const control::ChildRow& child : row.children)
      if (child.allows(candidate)) children.push_back(candidate.name);
  if (!prototype && !children.empty()) {
    out += indent + "  <xs:choice minOccurs=\"0\" maxOccurs=\"unbounded\">\n";
    for (const std::string& child : children) {
      const ElementRow& element = *table.find(child);
      if (row.name == "defaults") {
        out += indent + "    <xs:element name=\"" + child + "\">\n" + complexType(table, element, indent + "      ", true) +
               indent + "    </xs:element>\n";
      } else {
        out += indent + "    <xs:element ref=\"" + child + "\"/>\n";
      }
    }
    out += indent + "  </xs:choice>\n";
  }
  const bool from_class = row.attribute("class") && row.attribute("class")->type == ValueType::element_class;
  for (const AttributeRow& attribute : row.attributes) {
    if (prototype && (attribute.name == "name" || attribute.name == "class")) continue;
    // A class may give what is required; an included <stack> or <level> has no attributes of its own.
    const bool can_be_included = row.name == "level" || row.name == "stack";
    const bool required = attribute.required && !prototype && !can_be_included && (!from_class || attribute.name == "name");
    out += attributeXsd(indent + "  ", attribute, required);
  }
  if (row.takes_back_end_options)
    for (const AttributeRow& option : optionsOfBackEnds(table, row)) out += attributeXsd(indent + "  ", option, false);
  return out + indent + "</xs:complexType>\n";
}

// ---- The manual.

std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += "\\|";
    else if (c == '<') out += "&lt;";
    else out += c;
  }
  return out;
}

std::string code(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '|' ? std::string("\\|") : std::string(1, c);
  return out.empty() ? "" : "`" + out + "`";
}

std::string meaning(const AttributeRow& row) {
  std::string text = cell(row.description);
  if (row.type == ValueType::choice || !row.choices.empty()) {
    text += row.type == ValueType::choice ? " One of " : " Or ";
    for (std::size_t i = 0; i < row.choices.size(); ++i) text += (i == 0 ? "" : ", ") + code(row.choices[i]);
    text += ".";
  }
  if (!row.since.empty()) text += " Since " + cell(row.since) + ".";
  if (!row.deprecated.empty()) text += " **Deprecated**: " + cell(row.deprecated);
  for (const std::string& former : row.formerly) text += " Formerly " + code(former) + ".";
  return text;
}

/// "press", "`press` or `sweep`"
std::string anchor(const std::string& name) {
  std::string out;
  for (const char c : name)
    if (c != '.') out += c;
  return out;
}

std::string attributesTable(const ElementRow& row) {
  std::string out = "| attribute | type | unit | range | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const AttributeRow& attribute : row.attributes) {
    const std::string given = attribute.required        ? "**required**"
                              : attribute.default_text ? (attribute.default_text->empty() ? "empty" : code(*attribute.default_text))
                                                       : "";
    out += "| `" + attribute.name + "` | " + cell(typeText(attribute)) + " | " + cell(unitText(attribute.unit)) + " | " +
           cell(rangeText(attribute)) + " | " + given + " | " + meaning(attribute) + " |\n";
  }
  return out;
}

std::string elementSection(const ElementTable& table, const ElementRow& row) {
  const bool back_end = row.kind == ElementKind::back_end;
  std::string out = "\n## " + row.name + "\n\n" + cell(row.description) + "\n";
  if (!row.source.empty()) out += "\nSource: " + cell(row.source) + ".\n";
  if (!row.since.empty()) out += "\nSince " + cell(row.since) + ".\n";
  if (!row.deprecated.empty()) out += "\n**Deprecated**: " + cell(row.deprecated) + "\n";
  for (const std::string& former : row.formerly) out += "\nFormerly " + code("<" + former + ">") + ".\n";
  if (!back_end) {
    std::string parents;
    for (const std::string& parent : parentsOf(table, row)) parents += (parents.empty() ? "" : ", ") + code("<" + parent + ">");
    if (!parents.empty()) out += "\nStands in " + parents + ".\n";
  }
  if (!row.children.empty()) {
    out += "\nHolds ";
    for (std::size_t i = 0; i < row.children.size(); ++i) out += (i == 0 ? "" : ", ") + cell(childText(row.children[i]));
    out += ".\n";
  }
  if (!row.attributes.empty()) out += "\n" + attributesTable(row);
  if (row.takes_back_end_options) out += "\nFurther attributes: the [options](back-ends.md) of the back end that it names.\n";
  for (const control::PresenceRule& rule : row.presence) out += "\nRule: " + cell(presenceText(rule)) + ".\n";
  if (!row.ports.empty()) {
    out += "\n| port | type | unit | gives |\n|---|---|---|---|\n";
    for (const control::PortRow& port : row.ports)
      out += "| `" + port.name + "` | " + cell(port.type) + " | " + cell(unitText(port.unit)) + " | " +
             cell(port.description) + " |\n";
  }
  return out;
}

struct Page {
  ElementKind kind;
  const char* file;
  const char* title;
  const char* introduction;
};

constexpr Page pages[] = {
    {ElementKind::structure, "structure.md", "Structure",
     "What a stack is made of, from the outermost element inwards."},
    {ElementKind::shape, "shapes.md", "Shapes", "What an `<object>` of the scene is the union of."},
    {ElementKind::sensor, "sensors.md", "Sensors",
     "What stands between the plant and the controller, in `<sensors>`; read as `name.port`."},
    {ElementKind::signal, "signals.md", "Signals", "Sources of values, in `<signals>`; read as `name.port`."},
    {ElementKind::task, "tasks.md", "Tasks", "What the robot should do, in a `<level>`."},
    {ElementKind::controller, "controllers.md", "Controllers", "What owns a whole `<level>`."},
    {ElementKind::measure, "measures.md", "Measures", "What judges a run by what truly happened, in `<run>`: figures and columns that no task can read."},
    {ElementKind::recorder, "recorders.md", "Recorders", "What else a run writes into its folder, in `<run>`."},
    {ElementKind::back_end, "back-ends.md", "Back ends",
     "What solves a tick: `<controller backend=\"…\">`, with these options as further attributes."}};

constexpr const char* made = "<!-- Made by `tactus schema md --out docs/reference` from the element table; not to be edited. -->\n";

}  // namespace

std::string schemaXsd(const ElementTable& table) {
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                    "<!-- Made by `tactus schema xsd` from the element table; not to be edited. -->\n"
                    "<xs:schema xmlns:xs=\"http://www.w3.org/2001/XMLSchema\">\n" + sharedTypes();
  for (const ElementRow& row : table.rows()) {
    if (row.kind == ElementKind::back_end) continue;
    out += "  <xs:element name=\"" + row.name + "\">\n" + documentation("    ", row.description) +
           complexType(table, row, "    ", false) + "  </xs:element>\n";
  }
  return out + "</xs:schema>\n";
}

std::string schemaJson(const ElementTable& table) {
  nlohmann::ordered_json elements = nlohmann::ordered_json::array();
  for (const ElementRow& row : table.rows()) elements.push_back(elementJson(row));
  return nlohmann::ordered_json{{"format", 1}, {"version", TACTUS_VERSION}, {"elements", elements}}.dump(2) + "\n";
}

std::map<std::string, std::string> referencePages(const ElementTable& table) {
  std::map<std::string, std::string> texts;
  std::string index = std::string(made) + "# Reference\n\nEverything that may stand in a stack. `tactus explain NAME` says the "
                      "same on a terminal. [Messages](../messages.md) has every error and warning.\n";
  for (const Page& page : pages) {
    const auto isOfPage = [&](const ElementRow& row) { return row.kind == page.kind; };
    if (std::none_of(table.rows().begin(), table.rows().end(), isOfPage)) continue;
    std::string& text = texts[page.file];
    text = std::string(made) + "# " + page.title + "\n\n" + page.introduction + "\n";
    index += "\n## [" + std::string(page.title) + "](" + page.file + ")\n\n" + page.introduction + "\n\n";
    for (const ElementRow& row : table.rows()) {
      if (row.kind != page.kind) continue;
      text += elementSection(table, row);
      index += "- [" + row.name + "](" + page.file + "#" + anchor(row.name) + "): " + cell(row.description) + "\n";
    }
  }
  texts["README.md"] = index;
  return texts;
}

}  // namespace tactus::dsl
