#include "apps/tactus/tolerances.h"

#include <tinyxml2.h>

#include <charconv>
#include <cmath>

#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

[[noreturn]] void refuse(const std::string& path, int line, const std::string& reason) {
  throw runtime::FileError(path, "line " + std::to_string(line) + ": " + reason);
}

double parseTolerance(const std::string& path, const tinyxml2::XMLAttribute& attribute) {
  const std::string text = attribute.Value();
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value) || value < 0) {
    refuse(path, attribute.GetLineNum(), std::string(attribute.Name()) + "=\"" + text + "\" is not a number ≥ 0");
  }
  return value;
}

runtime::Tolerance readTolerance(const std::string& path, const tinyxml2::XMLElement& element) {
  if (element.Name() != std::string_view("tolerance")) {
    refuse(path, element.GetLineNum(), std::string("<") + element.Name() + ">: expected <tolerance>");
  }
  runtime::Tolerance tolerance;
  for (const auto* attribute = element.FirstAttribute(); attribute; attribute = attribute->Next()) {
    const std::string_view name = attribute->Name();
    if (name == "columns") {
      tolerance.columns = attribute->Value();
    } else if (name == "atol") {
      tolerance.atol = parseTolerance(path, *attribute);
    } else if (name == "rtol") {
      tolerance.rtol = parseTolerance(path, *attribute);
    } else {
      refuse(path, attribute->GetLineNum(),
             "<tolerance> has no attribute '" + std::string(name) + "'; expected columns, atol, rtol");
    }
  }
  if (tolerance.columns.empty()) refuse(path, element.GetLineNum(), "<tolerance> needs columns=\"GLOB\"");
  return tolerance;
}

}  // namespace

std::vector<runtime::Tolerance> readTolerances(const std::string& path) {
  tinyxml2::XMLDocument document;
  const std::string content = runtime::readFile(path);
  if (document.Parse(content.data(), content.size()) != tinyxml2::XML_SUCCESS) {
    refuse(path, document.ErrorLineNum(), "is not well-formed XML");
  }
  const tinyxml2::XMLElement* root = document.RootElement();
  if (!root || root->Name() != std::string_view("tolerances")) refuse(path, 1, "expected the element <tolerances>");
  std::vector<runtime::Tolerance> tolerances;
  for (const auto* element = root->FirstChildElement(); element; element = element->NextSiblingElement()) {
    tolerances.push_back(readTolerance(path, *element));
  }
  return tolerances;
}

std::string defaultTolerances() {
  return R"(<tolerances>
  <!-- |actual − expected| ≤ atol + rtol·|expected|; the last match of a column counts.  On one machine a run repeats
       to the byte; what is granted here is for other processors' mathematics libraries. -->
  <tolerance columns="*" atol="1e-6" rtol="1e-4"/>
</tolerances>
)";
}

}  // namespace tactus::app
