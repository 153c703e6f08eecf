#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dsl/source_text.h"
#include "dsl/xml_scan.h"

namespace tactus::dsl {

class Findings;

/// A file that was read, and the way to it.
struct XmlSource {
  SourceText text;
  std::vector<description::Place> included_from;                   ///< innermost first
};

struct XmlAttribute {
  std::string name;
  std::string value;                                               ///< entities decoded
  std::size_t name_at = 0;                                         ///< offsets into the source's text
  std::size_t value_at = 0;
  std::size_t value_size = 0;
  std::string setting;                                             ///< "--set name=value" that reached it, "" = none
  std::string brought_by;                                          ///< "parameter 'press' at stack.xml:3:28", "" = none
};

/// An element that knows where it stands.  Values come from tinyxml2, places from Tactus's own scan.
struct XmlElement {
  std::string name;
  std::shared_ptr<const XmlSource> source;
  std::size_t at = 0;                                              ///< offset of '<'
  std::size_t end = 0;                                             ///< just past its last '>'
  std::size_t text_at = nowhere;                                   ///< text directly inside, if any
  const XmlElement* parent = nullptr;
  bool incomplete = false;                                         ///< an include inside it could not be read
  std::vector<XmlAttribute> attributes;
  std::vector<std::unique_ptr<XmlElement>> children;

  const XmlAttribute* attribute(std::string_view wanted) const;
  const XmlElement* child(std::string_view wanted) const;          ///< the first of that name, or null
  description::Place place() const { return source->text.place(at); }
  /// "/stack/level[@priority=1]/impedance[@name=hand]"
  std::string path() const;
};

/// Attributes by which editors find the schema: they mean nothing to us, on an outermost element.
bool isSchemaHint(const XmlAttribute& attribute);

/// Parses text that has been read.  Null, and one error in `findings`, when it is not one XML element.
std::unique_ptr<XmlElement> parseXml(std::shared_ptr<const XmlSource> source, Findings& findings);

}  // namespace tactus::dsl
