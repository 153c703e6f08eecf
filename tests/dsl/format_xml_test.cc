// One layout for the same document: what it says stays, and formatting again changes nothing.

#include "dsl/format_xml.h"

#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "dsl/source_text.h"
#include "dsl/xml_scan.h"

namespace tactus::dsl {
namespace {

/// The document as tinyxml2 understands it, comments included, layout not.
std::string meaning(const std::string& text) {
  tinyxml2::XMLDocument document(true, tinyxml2::COLLAPSE_WHITESPACE);
  EXPECT_EQ(document.Parse(text.c_str()), tinyxml2::XML_SUCCESS) << text;
  tinyxml2::XMLPrinter printer(nullptr, true);
  document.Print(&printer);
  return printer.CStr();
}

void expectFormats(const std::string& text, const std::string& wanted) {
  const std::string formatted = formatXml(text);
  EXPECT_EQ(formatted, wanted);
  EXPECT_EQ(formatXml(formatted), formatted) << "formatting again changes it";
  EXPECT_EQ(meaning(formatted), meaning(text));
}

TEST(FormatXml, OneElementALine) {
  expectFormats("<a  x = '1'><b/><c></c>\n</a>", "<a x='1'>\n  <b/>\n  <c/>\n</a>\n");
}

TEST(FormatXml, CommentsKeepTheirPlaceAndWords) {
  expectFormats("<?xml version=\"1.0\"?>\n<!--  head -->\n<a>\n<b/>   <!-- behind -->\n\n\n <!-- two\n   lines -->\n<c/></a>\n<!-- end -->",
                "<?xml version=\"1.0\"?>\n<!--  head -->\n<a>\n  <b/>  <!-- behind -->\n\n  <!-- two\n   lines -->\n  <c/>\n</a>\n"
                "<!-- end -->\n");
}

TEST(FormatXml, ShortElementsStayOnTheirLine) {
  expectFormats("<a>\n  <b><c/><d x=\"1\"/></b>\n  <e>\n<f/></e>\n</a>\n", "<a>\n  <b><c/><d x=\"1\"/></b>\n  <e>\n    <f/>\n  </e>\n</a>\n");
}

TEST(FormatXml, LongTagsBreakBetweenAttributes) {
  const std::string value(50, 'v');
  expectFormats("<a><bb one=\"" + value + "\" two=\"" + value + "\" three=\"3\"/></a>",
                "<a>\n  <bb one=\"" + value + "\" two=\"" + value + "\"\n      three=\"3\"/>\n</a>\n");
}

TEST(FormatXml, ValuesStayAsWritten) {
  expectFormats("<a x='\"quoted\"' y=\"1\n2\" z=\"&lt;&amp;\"/>", "<a x='\"quoted\"' y=\"1\n2\" z=\"&lt;&amp;\"/>\n");
}

TEST(FormatXml, LineEndsOfOtherSystemsAndAMark) {
  EXPECT_EQ(formatXml("\xEF\xBB\xBF<a>\r\n<b/>\r\n</a>\r\n"), "\xEF\xBB\xBF<a>\n  <b/>\n</a>\n");
}

TEST(FormatXml, EveryFileOfTheProjectKeepsItsMeaning) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TACTUS_SOURCE_DIR)) {
    const std::string path = entry.path().string();
    if (path.find("/build/") != std::string::npos || !(path.ends_with(".xml") || path.ends_with(".urdf"))) continue;
    const std::string text = readFile(path).value_or("");
    if (scanXml(text).error || scanXml(text).elements.empty()) continue;  // tests of what is no XML
    const std::string formatted = formatXml(text);
    EXPECT_EQ(formatXml(formatted), formatted) << path;
    EXPECT_EQ(meaning(formatted), meaning(text)) << path;
    ++files;
  }
  EXPECT_GT(files, 60);
}

}  // namespace
}  // namespace tactus::dsl
