#include "dsl/diagnostic.h"

#include <algorithm>

#include "dsl/source_text.h"

namespace tactus::dsl {
namespace {

std::string inPlace(const description::Place& place) {
  return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

/// Blanks up to the column, with tabs kept, so that the caret stands below its character.
std::string indentBelow(const std::string& line, int column) {
  std::string indent;
  int characters = 0;
  for (char c : line) {
    if ((static_cast<unsigned char>(c) & 0xC0) == 0x80) continue;
    if (++characters >= column) break;
    indent += c == '\t' ? '\t' : ' ';
  }
  return indent;
}

/// A stack may come from anybody: what would steer the terminal is shown as '?'.
std::string harmless(std::string text) {
  for (char& c : text)
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n') || c == 0x7F) c = '?';
  return text;
}

std::string summary(const std::vector<Diagnostic>& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += render(diagnostic);
  return text;
}

}  // namespace

std::string render(const Diagnostic& diagnostic) {
  const char* severity = diagnostic.severity == Severity::error ? "error" : "warning";
  std::string text =
      inPlace(diagnostic.place) + ": " + severity + "[" + diagnostic.code + "]: " + diagnostic.message + "\n";
  const std::string hint = diagnostic.suggestion.empty() ? "" : "did you mean '" + diagnostic.suggestion + "'?";
  if (!diagnostic.source_line.empty()) {
    const std::string number = std::to_string(diagnostic.place.line);
    const int room = countCharacters(diagnostic.source_line) - diagnostic.place.column + 1;
    const std::string carets(static_cast<std::size_t>(std::max(1, std::min(diagnostic.length, room))), '^');
    text += "  " + number + " | " + diagnostic.source_line + "\n";
    text += "  " + std::string(number.size(), ' ') + " | " +
            indentBelow(diagnostic.source_line, diagnostic.place.column) + carets + (hint.empty() ? "" : " " + hint) +
            "\n";
  } else if (!hint.empty()) {
    text += "  " + hint + "\n";
  }
  std::string where = diagnostic.path.empty() ? "" : "in " + diagnostic.path;
  for (const description::Place& place : diagnostic.included_from)
    where += (where.empty() ? "" : ", ") + ("included from " + inPlace(place));
  if (!where.empty()) text += "  " + where + "\n";
  return harmless(std::move(text));
}

InvalidStack::InvalidStack(std::vector<Diagnostic> found)
    : std::runtime_error(summary(found)), diagnostics(std::move(found)) {}

}  // namespace tactus::dsl
