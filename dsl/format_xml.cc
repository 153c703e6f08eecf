#include "dsl/format_xml.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "dsl/source_text.h"
#include "dsl/xml_scan.h"

namespace tactus::dsl {
namespace {

constexpr int widest = 120;

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

struct Node {
  enum class Kind { element, verbatim } kind = Kind::verbatim;    // verbatim: comment, instruction, text
  std::string text;                                                // of an element: its start tag without "<", ">", "/>"
  std::vector<std::string> attributes;                             // name="value" as written
  std::vector<Node> children;
  bool blank_before = false;                                       // a line was left free before it
  bool starts_line = true;
  bool one_line = false;                                           // the whole element stood on one line
};

/// From a text and its scan to nodes.
class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text), scan_(scanXml(text, begin())) {}

  std::vector<Node> run() {
    at_ = begin();
    return nodes(text_.size());
  }
  std::size_t begin() const { return text_.rfind("\xEF\xBB\xBF", 0) == 0 ? 3 : 0; }

 private:
  bool startsWith(std::string_view word) const { return std::string_view(text_).substr(at_, word.size()) == word; }
  void skipPast(std::string_view closing) { at_ = std::min(text_.find(closing, at_), text_.size()) + closing.size(); }

  /// Nodes up to a closing tag or the end.
  std::vector<Node> nodes(std::size_t end) {
    std::vector<Node> found;
    bool after_one = false;
    while (at_ < end) {
      const std::size_t from = at_;
      while (at_ < end && isBlank(text_[at_])) ++at_;
      const auto lines = std::count(text_.begin() + static_cast<long>(from), text_.begin() + static_cast<long>(at_), '\n');
      if (at_ >= end || startsWith("</")) break;
      Node node = startsWith("<") && !startsWith("<!") && !startsWith("<?") ? element() : verbatim();
      node.blank_before = lines > 1 && after_one;
      node.starts_line = lines > 0 || !after_one;
      found.push_back(std::move(node));
      after_one = true;
    }
    return found;
  }

  Node verbatim() {
    const std::size_t from = at_;
    if (startsWith("<!--")) {
      at_ += 4;
      skipPast("-->");
    } else if (startsWith("<?")) {
      skipPast("?>");
    } else if (startsWith("<![CDATA[")) {
      skipPast("]]>");
    } else {
      at_ = std::min(text_.find('<', at_), text_.size());
    }
    std::size_t end = std::min(at_, text_.size());
    while (end > from && isBlank(text_[end - 1])) --end;
    Node node;
    node.text = text_.substr(from, end - from);
    at_ = end;
    return node;
  }

  Node element() {
    const ScannedElement& scanned = scan_.elements[next_++];
    Node node;
    node.kind = Node::Kind::element;
    node.text = scanned.name;
    node.one_line = text_.substr(scanned.at, scanned.end - scanned.at).find('\n') == std::string::npos;
    at_ = scanned.at + 1 + scanned.name.size();
    for (const ScannedAttribute& attribute : scanned.attributes) {
      const std::size_t quote = attribute.value_at - 1;
      node.attributes.push_back(attribute.name + "=" + text_.substr(quote, attribute.value_size + 2));
      at_ = attribute.value_at + attribute.value_size + 1;
    }
    while (isBlank(text_[at_])) ++at_;
    const bool closed = text_[at_] == '/';
    at_ += closed ? 2 : 1;
    if (closed) return node;
    node.children = nodes(scanned.end);
    at_ = scanned.end;
    return node;
  }

  const std::string& text_;
  ScannedXml scan_;
  std::size_t next_ = 0;
  std::size_t at_ = 0;
};

std::string closing(const Node& node) { return node.children.empty() ? "/>" : ">"; }

std::string flat(const Node& node) {
  if (node.kind == Node::Kind::verbatim) return node.text;
  std::string out = "<" + node.text;
  for (const std::string& attribute : node.attributes) out += " " + attribute;
  out += closing(node);
  if (node.children.empty()) return out;
  for (const Node& child : node.children) out += flat(child);
  return out + "</" + node.text + ">";
}

/// Only elements within elements: a comment inside keeps its line.
bool isPlain(const Node& node) {
  return node.kind == Node::Kind::element && std::all_of(node.children.begin(), node.children.end(), isPlain);
}

bool fits(const std::string& line, int indent) {
  return line.find('\n') == std::string::npos && indent + countCharacters(line) <= widest;
}

class Writer {
 public:
  std::string run(const std::vector<Node>& nodes) {
    write(nodes, 0);
    return out_ + "\n";
  }

 private:
  void write(const std::vector<Node>& nodes, int indent) {
    for (const Node& node : nodes) {
      if (!node.starts_line && node.kind == Node::Kind::verbatim && !out_.empty()) {
        out_ += "  " + node.text;                                  // a remark behind something
        continue;
      }
      if (!out_.empty()) out_ += node.blank_before ? "\n\n" : "\n";
      out_.append(static_cast<std::size_t>(indent), ' ');
      if (node.kind == Node::Kind::verbatim)
        out_ += node.text;
      else
        writeElement(node, indent);
    }
  }

  void writeElement(const Node& node, int indent) {
    if (node.one_line && isPlain(node)) {
      if (const std::string line = flat(node); fits(line, indent)) {
        out_ += line;
        return;
      }
    }
    writeStart(node, indent);
    if (node.children.empty()) return;
    write(node.children, indent + 2);
    out_ += "\n" + std::string(static_cast<std::size_t>(indent), ' ') + "</" + node.text + ">";
  }

  /// Attributes below each other, as many as fit on each line.
  void writeStart(const Node& node, int indent) {
    const std::string open = "<" + node.text;
    const std::string further = std::string(static_cast<std::size_t>(indent) + open.size() + 1, ' ');
    std::string line = std::string(static_cast<std::size_t>(indent), ' ') + open;
    out_ += open;
    for (std::size_t i = 0; i < node.attributes.size(); ++i) {
      const std::string end = i + 1 == node.attributes.size() ? closing(node) : "";
      const std::string word = " " + node.attributes[i];
      if (i > 0 && countCharacters(line + word + end) > widest) {
        out_ += "\n" + further + node.attributes[i];
        line = further + node.attributes[i];
      } else {
        out_ += word;
        line += word;
      }
      if (const std::size_t last = line.rfind('\n'); last != std::string::npos) line.erase(0, last + 1);
    }
    out_ += closing(node);
  }

  std::string out_;
};

}  // namespace

std::string formatXml(const std::string& text) {
  // Line ends of other systems become ours, in the text as in what is kept of it.
  std::string unix_text;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (!(text[i] == '\r' && i + 1 < text.size() && text[i + 1] == '\n')) unix_text += text[i];
  Parser parser(unix_text);
  return unix_text.substr(0, parser.begin()) + Writer().run(parser.run());
}

}  // namespace tactus::dsl
