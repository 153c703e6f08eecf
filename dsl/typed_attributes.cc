#include "dsl/typed_attributes.h"

#include <algorithm>

#include "dsl/nearest_name.h"

namespace tactus::dsl {

const XmlAttribute* requireAttribute(const XmlElement& element, const std::string& name, Findings& findings) {
  const XmlAttribute* attribute = element.attribute(name);
  if (!attribute)
    findings.error(code::missing_attribute, element, "<" + element.name + "> needs the attribute '" + name + "'");
  return attribute;
}

const XmlElement* requireChild(const XmlElement& element, const std::string& name, Findings& findings) {
  const XmlElement* child = element.child(name);
  if (!child) findings.error(code::missing_element, element, "<" + element.name + "> needs a <" + name + ">");
  return child;
}

std::vector<double> readNumbers(const XmlElement& element, const std::string& name, const control::AttributeRow& row,
                                Findings& findings) {
  const XmlAttribute* attribute = element.attribute(name);
  if (!attribute) return {};
  std::string error;
  if (auto value = control::parseValue(row, attribute->value, error)) return value->numbers;
  findings.errorAtValue(code::bad_value, element, *attribute, "attribute '" + name + "': " + error);
  return {};
}

std::vector<double> readRequiredNumbers(const XmlElement& element, const std::string& name,
                                        const control::AttributeRow& row, Findings& findings) {
  return requireAttribute(element, name, findings) ? readNumbers(element, name, row, findings) : std::vector<double>{};
}

void refuseOtherAttributes(const XmlElement& element, const std::vector<std::string>& known, Findings& findings) {
  for (const XmlAttribute& attribute : element.attributes)
    if (std::find(known.begin(), known.end(), attribute.name) == known.end())
      findings.errorAtName(code::unknown_attribute, element, attribute,
                           "<" + element.name + "> has no attribute '" + attribute.name + "'",
                           nearestName(attribute.name, known));
}

std::vector<std::string> splitWords(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::vector<std::string> words;
  for (std::size_t at = text.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    words.emplace_back(text.substr(at, end - at));
    at = text.find_first_not_of(blanks, end);
  }
  return words;
}

}  // namespace tactus::dsl
