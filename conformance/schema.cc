#include "conformance/laws.h"

namespace tactus::conformance {
namespace {

using control::AttributeRow;
using control::ValueType;

bool isNumeric(const AttributeRow& row) {
  return row.type == ValueType::real || row.type == ValueType::reals || row.type == ValueType::points;
}

void checkRow(const control::ElementRow& row) {
  if (row.description.empty()) throw Broken{"the element has no description"};
  for (const AttributeRow& attribute : row.attributes) {
    const std::string where = "attribute '" + attribute.name + "' ";
    if (attribute.description.empty()) throw Broken{where + "has no description"};
    if (isNumeric(attribute) && attribute.unit.empty())
      throw Broken{where + "is a number without a unit; write \"1\" where it has none"};
    std::string error;
    if (attribute.default_text && !control::parseValue(attribute, *attribute.default_text, error))
      throw Broken{where + "has a default that does not parse: " + error};
  }
  for (const control::PortRow& port : row.ports) {
    const std::string where = "port '" + port.name + "' ";
    if (port.description.empty()) throw Broken{where + "has no description"};
    if (port.type.empty()) throw Broken{where + "has no type"};
    if (port.type == control::PortType<double>::name && port.unit.empty())
      throw Broken{where + "is a number without a unit; write \"1\" where it has none"};
  }
}

}  // namespace

void checkSchema(const control::ElementRow& row, Report& report) {
  const dsl::Stack none;
  const control::Registry empty;
  judge({none, empty, row.name, ""}, "schema", report, [&] { checkRow(row); });
}

}  // namespace tactus::conformance
