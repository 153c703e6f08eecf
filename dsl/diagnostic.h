#pragma once

#include <iosfwd>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/description/place.h"

namespace tactus::dsl {

enum class Severity { warning, error };

/// One finding about a file that the user wrote.
struct Diagnostic {
  Severity severity = Severity::error;
  std::string code;                                               ///< stable: "E012"; the manual has a section per code
  std::string message;                                            ///< what is wrong and what was expected, one sentence
  description::Place place;                                      ///< line and column count from 1; an empty file is 1:1
  int length = 1;                                                  ///< characters to underline
  std::string suggestion;                                          ///< nearest valid name, "" when none is near
  std::string path;                                               ///< "/stack/level[@priority=1]/impedance[@name=hand]"
  std::string source_line;                                         ///< the line as written, "" when there is none
  std::vector<description::Place> included_from;                   ///< innermost first
  int exit_code = 3;                                               ///< 3 invalid stack, 4 plugin
};

/// gcc's style: file:line:column: error[code]: message, the source line with a caret, the suggestion, the path.
std::string render(const Diagnostic& diagnostic);

/// Thrown when reading or compiling found errors; holds all of them (at most 50), in file order.
class InvalidStack : public std::runtime_error {
 public:
  explicit InvalidStack(std::vector<Diagnostic> diagnostics);
  std::vector<Diagnostic> diagnostics;
};

}  // namespace tactus::dsl
