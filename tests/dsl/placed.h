#pragma once

#include <algorithm>
#include <string>

#include "dsl/diagnostic.h"

namespace tactus::dsl_test {

/// What a refusal of `text`, read from `file`, lacks of what every refusal has: a code of an error, a message, and a
/// place inside a file that was read.  "" = nothing.
inline std::string lackOf(const dsl::InvalidStack& refusal, const std::string& file, const std::string& text) {
  if (refusal.diagnostics.empty()) return "no finding";
  const long lines = std::count(text.begin(), text.end(), '\n') + 1;
  for (const dsl::Diagnostic& found : refusal.diagnostics) {
    const description::Place& place = found.place;
    const auto lacks = [&](const char* what) { return std::string(what) + ": " + dsl::render(found); };
    if (found.message.empty()) return lacks("no message");
    if (!found.code.starts_with('E')) return lacks("no code of an error");
    if (place.file.empty()) return lacks("no file");
    if (place.line < 1 || place.column < 1 || (place.file == file && place.line > lines))
      return lacks("a place outside of the file");
  }
  return "";
}

}  // namespace tactus::dsl_test
