#include "dsl/xml_file.h"

#include <tinyxml2.h>

#include <algorithm>

#include "dsl/codes.h"
#include "dsl/findings.h"

namespace tactus::dsl {
namespace {

/// tinyxml2 knows lines only: the first character of that line which is not blank.
std::size_t startOfLine(const std::string& text, int line) {
  std::size_t at = 0;
  for (int i = 1; i < line && at < text.size(); ++i) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    at = end + 1;
  }
  return std::min(text.find_first_not_of(" \t", at), text.size());
}

const tinyxml2::XMLElement* nextInDocument(const tinyxml2::XMLElement* element) {
  if (const auto* child = element->FirstChildElement()) return child;
  for (; element; element = element->Parent()->ToElement()) {
    if (const auto* sibling = element->NextSiblingElement()) return sibling;
  }
  return nullptr;
}

}  // namespace

const XmlAttribute* XmlElement::attribute(std::string_view wanted) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const auto& attribute) { return attribute.name == wanted; });
  return found == attributes.end() ? nullptr : &*found;
}

const XmlElement* XmlElement::child(std::string_view wanted) const {
  const auto found =
      std::find_if(children.begin(), children.end(), [&](const auto& child) { return child->name == wanted; });
  return found == children.end() ? nullptr : found->get();
}

std::string XmlElement::path() const {
  std::string text = "/" + name;
  if (parent) {  // one outermost element needs no telling apart
    for (const char* key : {"name", "priority", "class"})
      if (const XmlAttribute* found = attribute(key)) {
        text += std::string("[@") + key + "=" + found->value + "]";
        break;
      }
    return parent->path() + text;
  }
  return text;
}

bool isSchemaHint(const XmlAttribute& attribute) {
  return attribute.name == "xmlns:xsi" || attribute.name == "xsi:noNamespaceSchemaLocation";
}

std::unique_ptr<XmlElement> parseXml(std::shared_ptr<const XmlSource> source, Findings& findings) {
  const std::string& text = source->text.text();
  if (const auto bad = source->text.firstBadByte()) {
    findings.error(code::not_utf8, *source, *bad, 1, "the text is not UTF-8: save the file in that encoding");
    return nullptr;
  }
  const ScannedXml scan = scanXml(text, source->text.begin());
  if (scan.error) {
    findings.error(scan.error->several_roots ? code::several_roots : code::not_xml, *source, scan.error->at, 1,
                   scan.error->message);
    return nullptr;
  }
  if (scan.elements.empty()) {
    findings.error(code::empty_file, *source, source->text.begin(), 1, "the file holds no element");
    return nullptr;
  }
  tinyxml2::XMLDocument document;
  if (document.Parse(text.c_str(), text.size()) != tinyxml2::XML_SUCCESS) {
    const bool deep = document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    findings.error(code::not_xml, *source, startOfLine(text, document.ErrorLineNum()), 1,
                   deep ? "elements are nested too deeply"
                        : std::string("the text is not well-formed XML: ") + document.ErrorName());
    return nullptr;
  }

  std::vector<XmlElement*> made;
  std::unique_ptr<XmlElement> root;
  const tinyxml2::XMLElement* node = document.RootElement();
  for (const ScannedElement& scanned : scan.elements) {
    auto element = std::make_unique<XmlElement>();
    element->name = scanned.name;
    element->source = source;
    element->at = scanned.at;
    element->end = scanned.end;
    element->text_at = scanned.text_at;
    if (!node || scanned.name != node->Name()) {
      findings.error(code::not_xml, *source, scanned.at, 1, "the text is not well-formed XML near this element");
      return nullptr;
    }
    for (const ScannedAttribute& attribute : scanned.attributes) {
      const char* value = node->Attribute(attribute.name.c_str());
      element->attributes.push_back(
          {attribute.name, value ? value : "", attribute.name_at, attribute.value_at, attribute.value_size, "", ""});
    }
    made.push_back(element.get());
    if (scanned.parent < 0) {
      root = std::move(element);
    } else {
      element->parent = made[static_cast<std::size_t>(scanned.parent)];
      made[static_cast<std::size_t>(scanned.parent)]->children.push_back(std::move(element));
    }
    node = nextInDocument(node);
  }
  return root;
}

}  // namespace tactus::dsl
