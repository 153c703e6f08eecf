#include "dsl/xml_scan.h"

#include <algorithm>

#include "dsl/source_text.h"

namespace tactus::dsl {
namespace {

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

bool isNameStart(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' || byte >= 0x80;
}

bool isNameCharacter(char c) { return isNameStart(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; }

class Scanner {
 public:
  Scanner(std::string_view text, std::size_t begin) : text_(text), at_(begin) {}

  ScannedXml run() {
    if (startsWith("<?xml")) skipPast("?>", "the XML declaration is not closed by '?>'");
    while (!failed() && at_ < text_.size()) {
      if (text_[at_] == '<')
        scanMarkup();
      else
        scanCharacter();
    }
    if (!failed() && !open_.empty()) {
      const ScannedElement& element = result_.elements[open_.back()];
      fail(element.at, "<" + element.name + "> is never closed");
    }
    return std::move(result_);
  }

 private:
  bool failed() const { return result_.error.has_value(); }
  void fail(std::size_t at, std::string message, bool several_roots = false) {
    if (!failed()) result_.error = ScanError{at, std::move(message), several_roots};
  }
  /// "line 4, column 7"
  std::string placeText(std::size_t at) const {
    const description::Place place = SourceText("", std::string(text_)).place(at);
    return "line " + std::to_string(place.line) + ", column " + std::to_string(place.column);
  }
  bool startsWith(std::string_view word) const { return text_.substr(at_, word.size()) == word; }
  void skipBlanks() {
    while (at_ < text_.size() && isBlank(text_[at_])) ++at_;
  }
  void skipPast(std::string_view closing, const char* message) {
    const std::size_t found = text_.find(closing, at_);
    if (found == std::string_view::npos) return fail(at_, message);
    for (std::size_t i = at_; i < found; ++i) checkControl(i);
    at_ = found + closing.size();
  }
  void checkControl(std::size_t at) {
    if (static_cast<unsigned char>(text_[at]) < 0x20 && !isBlank(text_[at]))
      fail(at, "a control character stands here");
  }
  std::string_view scanName() {
    const std::size_t start = at_;
    if (at_ < text_.size() && isNameStart(text_[at_]))
      while (at_ < text_.size() && isNameCharacter(text_[at_])) ++at_;
    return text_.substr(start, at_ - start);
  }

  void scanMarkup() {
    if (startsWith("<!--")) {
      const std::size_t start = at_;
      at_ += 4;
      skipPast("-->", "the comment is not closed by '-->'");
      if (failed()) result_.error->at = std::min(result_.error->at, start);
    } else if (startsWith("<![CDATA[")) {
      noteText(at_);
      skipPast("]]>", "the CDATA section is not closed by ']]>'");
    } else if (startsWith("<!")) {
      fail(at_, "document type declarations are not allowed");
    } else if (startsWith("<?")) {
      skipPast("?>", "the processing instruction is not closed by '?>'");
    } else if (startsWith("</")) {
      scanClosingTag();
    } else {
      scanOpeningTag();
    }
  }

  void scanCharacter() {
    checkControl(at_);
    if (text_[at_] == '&') scanReference(text_.size());
    if (failed()) return;
    if (!isBlank(text_[at_])) noteText(at_);
    ++at_;
  }

  void noteText(std::size_t at) {
    if (open_.empty())
      return fail(at, result_.elements.empty() ? "text stands before the outermost element"
                                               : "text stands after the outermost element");
    std::size_t& text_at = result_.elements[open_.back()].text_at;
    if (text_at == nowhere) text_at = at;
  }

  /// Checks "&…;" at at_; stays there.
  void scanReference(std::size_t limit) {
    const std::size_t end = text_.find(';', at_);
    const std::string_view name =
        end == std::string_view::npos || end >= limit ? "" : text_.substr(at_ + 1, end - at_ - 1);
    for (std::string_view known : {"lt", "gt", "amp", "quot", "apos"})
      if (name == known) return;
    if (isCharacterReference(name)) return;
    fail(at_, "'&' starts no known entity: write '&amp;' for the character itself");
  }

  static bool isCharacterReference(std::string_view name) {
    if (!name.starts_with('#') || name.size() > 8) return false;
    const bool hexadecimal = name.size() > 1 && name[1] == 'x';
    const std::string_view digits = name.substr(hexadecimal ? 2 : 1);
    long code = 0;
    for (char c : digits) {
      const int digit = c >= '0' && c <= '9'                  ? c - '0'
                        : hexadecimal && c >= 'a' && c <= 'f' ? c - 'a' + 10
                        : hexadecimal && c >= 'A' && c <= 'F' ? c - 'A' + 10
                                                              : -1;
      if (digit < 0) return false;
      code = code * (hexadecimal ? 16 : 10) + digit;
    }
    const bool control = code < 0x20 && code != '\t' && code != '\n' && code != '\r';
    const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
    return !digits.empty() && !control && !surrogate && code <= 0x10FFFF;
  }

  void scanClosingTag() {
    const std::size_t start = at_;
    at_ += 2;
    const std::string_view name = scanName();
    skipBlanks();
    if (at_ >= text_.size() || text_[at_] != '>') return fail(start, "the closing tag is not ended by '>'");
    ++at_;
    if (open_.empty()) return fail(start, "</" + std::string(name) + "> closes nothing");
    ScannedElement& element = result_.elements[open_.back()];
    if (element.name != name)
      return fail(start, "</" + std::string(name) + "> stands where </" + element.name + "> was expected: <" +
                             element.name + "> was opened in " + placeText(element.at));
    element.end = at_;
    open_.pop_back();
  }

  void scanOpeningTag() {
    ScannedElement element;
    element.at = at_++;
    element.name = scanName();
    if (element.name.empty()) return fail(element.at, "'<' starts no tag: write '&lt;' for the character itself");
    if (open_.empty() && !result_.elements.empty())
      return fail(element.at, "<" + element.name + "> is a second outermost element: a file has one", true);
    element.parent = open_.empty() ? -1 : open_.back();
    while (!failed()) {
      const std::size_t before = at_;
      skipBlanks();
      if (at_ >= text_.size()) return fail(element.at, "the tag <" + element.name + "> is not ended by '>'");
      if (text_[at_] == '>' || startsWith("/>")) break;
      if (at_ == before)
        return fail(at_, "a blank was expected before the next attribute of <" + element.name + ">" +
                             lastValue(element));
      scanAttribute(element);
    }
    if (failed()) return;
    const bool closed = text_[at_] == '/';
    at_ += closed ? 2 : 1;
    element.end = at_;
    result_.elements.push_back(std::move(element));
    if (!closed) open_.push_back(static_cast<int>(result_.elements.size()) - 1);
  }

  /// Where the value before began: its quote may have been meant to close earlier.
  std::string lastValue(const ScannedElement& element) const {
    if (element.attributes.empty()) return "";
    const ScannedAttribute& last = element.attributes.back();
    return ": the value of attribute '" + last.name + "', opened in " + placeText(last.value_at - 1) + ", ends here";
  }

  void scanAttribute(ScannedElement& element) {
    ScannedAttribute attribute;
    attribute.name_at = at_;
    attribute.name = scanName();
    if (attribute.name.empty()) return fail(at_, "the name of an attribute of <" + element.name + "> was expected");
    skipBlanks();
    const std::string what = "attribute '" + attribute.name + "'";
    if (at_ >= text_.size() || text_[at_] != '=') return fail(attribute.name_at, what + " has no '='");
    ++at_;
    skipBlanks();
    const char quote = at_ < text_.size() ? text_[at_] : '\0';
    if (quote != '"' && quote != '\'') return fail(attribute.name_at, what + " has no value in quotes");
    attribute.value_at = ++at_;
    const std::size_t end = text_.find(quote, at_);
    if (end == std::string_view::npos)
      return fail(attribute.name_at, "the value of " + what + " has no closing quote: it was opened in " +
                                         placeText(attribute.value_at - 1));
    attribute.value_size = end - at_;
    for (; at_ < end && !failed(); ++at_) {
      checkControl(at_);
      if (text_[at_] == '<')
        fail(at_, "'<' stands in the value of " + what + ", whose quote was opened in " +
                      placeText(attribute.value_at - 1) + ": write '&lt;', or close the quote before it");
      if (text_[at_] == '&') scanReference(end);
    }
    if (failed()) return;
    at_ = end + 1;
    for (const ScannedAttribute& other : element.attributes)
      if (other.name == attribute.name) return fail(attribute.name_at, what + " is given twice");
    element.attributes.push_back(std::move(attribute));
  }

  std::string_view text_;
  std::size_t at_;
  std::vector<int> open_;
  ScannedXml result_;
};

}  // namespace

ScannedXml scanXml(std::string_view text, std::size_t begin) { return Scanner(text, begin).run(); }

}  // namespace tactus::dsl
