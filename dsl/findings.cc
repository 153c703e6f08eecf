#include "dsl/findings.h"

#include <algorithm>

namespace tactus::dsl {
namespace {

/// Bytes of "<name".
std::size_t tagLength(const XmlElement& element) { return element.name.size() + 1; }

/// Lines and columns from the outermost file to the finding: the order in which one reads.
std::vector<std::pair<int, int>> wayOf(const Diagnostic& diagnostic) {
  std::vector<std::pair<int, int>> way;
  for (auto place = diagnostic.included_from.rbegin(); place != diagnostic.included_from.rend(); ++place)
    way.emplace_back(place->line, place->column);
  way.emplace_back(diagnostic.place.line, diagnostic.place.column);
  return way;
}

}  // namespace

Diagnostic Findings::make(const Code& code, const XmlSource& source, std::size_t at, std::size_t length,
                          const std::string& message) const {
  Diagnostic diagnostic;
  diagnostic.code = code.id;
  diagnostic.message = message;
  diagnostic.place = source.text.place(at);
  const std::string& text = source.text.text();
  const std::size_t begin = std::min(at, text.size());
  diagnostic.length = std::max(1, countCharacters(std::string_view(text).substr(begin, length)));
  diagnostic.source_line = source.text.line(at);
  diagnostic.included_from = source.included_from;
  return diagnostic;
}

void Findings::error(const Code& code, const XmlSource& source, std::size_t at, std::size_t length,
                     const std::string& message) {
  add(make(code, source, at, length, message));
}

void Findings::error(const Code& code, const XmlElement& element, const std::string& message,
                     const std::string& suggestion) {
  Diagnostic diagnostic = make(code, *element.source, element.at, tagLength(element), message);
  diagnostic.suggestion = suggestion;
  diagnostic.path = element.path();
  add(std::move(diagnostic));
}

void Findings::errorAtName(const Code& code, const XmlElement& element, const XmlAttribute& attribute,
                           const std::string& message, const std::string& suggestion) {
  Diagnostic diagnostic = make(code, *element.source, attribute.name_at, attribute.name.size(), message);
  diagnostic.suggestion = suggestion;
  diagnostic.path = element.path();
  add(std::move(diagnostic));
}

void Findings::errorAtValue(const Code& code, const XmlElement& element, const XmlAttribute& attribute,
                            const std::string& message, const std::string& suggestion) {
  const std::string from = attribute.brought_by.empty() ? "" : "; the value comes from " + attribute.brought_by;
  Diagnostic diagnostic = make(code, *element.source, attribute.value_at, attribute.value_size, message + from);
  diagnostic.suggestion = suggestion;
  diagnostic.path = element.path();
  add(std::move(diagnostic));
}

void Findings::errorAtWord(const Code& code, const XmlElement& element, const XmlAttribute& attribute,
                           std::size_t index, const std::string& message, const std::string& suggestion) {
  constexpr std::string_view blanks = " \t\r\n";
  const std::string_view written =
      std::string_view(element.source->text.text()).substr(attribute.value_at, attribute.value_size);
  XmlAttribute word = attribute;
  std::size_t at = written.find_first_not_of(blanks);
  for (std::size_t i = 0; i < index && at != std::string_view::npos; ++i)
    at = written.find_first_not_of(blanks, written.find_first_of(blanks, at));
  const bool as_written = written.find_first_of("$&") == std::string_view::npos;  // else words may stand elsewhere
  if (as_written && at != std::string_view::npos) {
    word.value_at += at;
    word.value_size = std::min(written.find_first_of(blanks, at), written.size()) - at;
  }
  errorAtValue(code, element, word, message, suggestion);
}

void Findings::warning(const Code& code, const XmlElement& element, const std::string& message,
                       const std::string& suggestion) {
  Diagnostic diagnostic = make(code, *element.source, element.at, tagLength(element), message);
  diagnostic.severity = Severity::warning;
  diagnostic.suggestion = suggestion;
  diagnostic.path = element.path();
  add(std::move(diagnostic));
}

void Findings::warningAtName(const Code& code, const XmlElement& element, const XmlAttribute& attribute,
                             const std::string& message, const std::string& suggestion) {
  Diagnostic diagnostic = make(code, *element.source, attribute.name_at, attribute.name.size(), message);
  diagnostic.severity = Severity::warning;
  diagnostic.suggestion = suggestion;
  diagnostic.path = element.path();
  add(std::move(diagnostic));
}

void Findings::add(Diagnostic diagnostic) {
  auto& list = diagnostic.severity == Severity::error ? errors_ : warnings_;
  const auto same = [&](const Diagnostic& other) {
    return other.code == diagnostic.code && other.message == diagnostic.message &&
           other.place.file == diagnostic.place.file && other.place.line == diagnostic.place.line &&
           other.place.column == diagnostic.place.column;
  };
  if (std::any_of(list.begin(), list.end(), same)) return;  // a class's value is met by each of its users
  if (list.size() < most) list.push_back(std::move(diagnostic));
}

void Findings::throwErrors() const {
  if (errors_.empty()) return;
  std::vector<Diagnostic> sorted = errors_;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return wayOf(a) < wayOf(b);
  });
  throw InvalidStack(std::move(sorted));
}

}  // namespace tactus::dsl
