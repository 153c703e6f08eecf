#pragma once

#include <string>
#include <vector>

#include "dsl/codes.h"
#include "dsl/diagnostic.h"
#include "dsl/xml_file.h"

namespace tactus::dsl {

/// Gathers what is found wrong with a user's files: at most 50 errors, then it stays silent.
class Findings {
 public:
  static constexpr std::size_t most = 50;

  /// At a stretch of a file; `length` in bytes.
  void error(const Code& code, const XmlSource& source, std::size_t at, std::size_t length, const std::string& message);
  /// At an element's '<' and name.  `suggestion` is what was probably meant, "" when nothing is near.
  void error(const Code& code, const XmlElement& element, const std::string& message,
             const std::string& suggestion = "");
  /// At an attribute's name.
  void errorAtName(const Code& code, const XmlElement& element, const XmlAttribute& attribute,
                   const std::string& message, const std::string& suggestion = "");
  /// At the first character of an attribute's value.
  void errorAtValue(const Code& code, const XmlElement& element, const XmlAttribute& attribute,
                    const std::string& message, const std::string& suggestion = "");
  /// At the word of that index in an attribute's value.
  void errorAtWord(const Code& code, const XmlElement& element, const XmlAttribute& attribute, std::size_t index,
                   const std::string& message, const std::string& suggestion = "");
  void warning(const Code& code, const XmlElement& element, const std::string& message,
               const std::string& suggestion = "");
  void warningAtName(const Code& code, const XmlElement& element, const XmlAttribute& attribute,
                     const std::string& message, const std::string& suggestion = "");
  void add(Diagnostic diagnostic);

  bool hasErrors() const { return !errors_.empty(); }
  const std::vector<Diagnostic>& errors() const { return errors_; }
  const std::vector<Diagnostic>& warnings() const { return warnings_; }
  /// Throws InvalidStack when there are errors.
  void throwErrors() const;

 private:
  Diagnostic make(const Code& code, const XmlSource& source, std::size_t at, std::size_t length,
                  const std::string& message) const;

  std::vector<Diagnostic> errors_;
  std::vector<Diagnostic> warnings_;
};

}  // namespace tactus::dsl
