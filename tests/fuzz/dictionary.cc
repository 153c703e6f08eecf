// Prints what the element table knows as a dictionary of libFuzzer: elements, attributes, choices, defaults, ports.

#include <iostream>
#include <set>
#include <string>

#include "apps/tactus/program.h"

using namespace tactus;

namespace {

/// libFuzzer takes printable ASCII as it is and any byte as \xAB.
std::string quoted(const std::string& text) {
  static const char* digits = "0123456789ABCDEF";
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F && c != '"' && c != '\\')
      quoted += c;
    else
      quoted += std::string("\\x") + digits[byte >> 4] + digits[byte & 15];
  }
  return quoted + "\"";
}

}  // namespace

int main() {
  app::Program program;
  std::set<std::string> words{"${", "}", "-->", "<!--", "<![CDATA[", "&amp;", "&#x41;", "nan", "1e308", "-1", ";", "."};
  for (const control::ElementRow& row : program.registry().elements().rows()) {
    words.insert("<" + row.name + " ");
    words.insert("</" + row.name + ">");
    for (const control::AttributeRow& attribute : row.attributes) {
      words.insert(" " + attribute.name + "=\"" + attribute.default_text.value_or("") + "\"");
      for (const std::string& choice : attribute.choices) words.insert(choice);
    }
    for (const control::PortRow& port : row.ports) words.insert("." + port.name);
  }
  for (const std::string& word : words) std::cout << quoted(word) << "\n";
}
