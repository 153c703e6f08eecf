#pragma once

#include <string>
#include <vector>

#include "dsl/findings.h"
#include "framework/control/element_values.h"

/// Small steps of a strict reader: each asks for one thing and says at its place when it is missing or wrong.
namespace tactus::dsl {

const XmlAttribute* requireAttribute(const XmlElement& element, const std::string& name, Findings& findings);
const XmlElement* requireChild(const XmlElement& element, const std::string& name, Findings& findings);
/// The numbers of an attribute, by type, range and count of `row`; empty when it is absent or wrong.
std::vector<double> readNumbers(const XmlElement& element, const std::string& name, const control::AttributeRow& row,
                                Findings& findings);
std::vector<double> readRequiredNumbers(const XmlElement& element, const std::string& name,
                                        const control::AttributeRow& row, Findings& findings);
/// An error for every attribute that is not one of `known`.
void refuseOtherAttributes(const XmlElement& element, const std::vector<std::string>& known, Findings& findings);
/// Words separated by blanks.
std::vector<std::string> splitWords(std::string_view text);

}  // namespace tactus::dsl
