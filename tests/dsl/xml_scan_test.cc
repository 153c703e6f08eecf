// Strategy: the place of everything is found again in the text itself, in texts with all that disturbs counting;
// then one text for each breach of well-formedness.

#include "dsl/xml_scan.h"

#include <gtest/gtest.h>

namespace tactus::dsl {
namespace {

/// At every place that the scan tells, the text holds what the scan says stands there.
void expectPlacesTrue(const std::string& text, std::size_t begin = 0) {
  const ScannedXml scan = scanXml(text, begin);
  ASSERT_FALSE(scan.error) << scan.error->message;
  for (const ScannedElement& element : scan.elements) {
    EXPECT_EQ(text.substr(element.at, element.name.size() + 1), "<" + element.name);
    EXPECT_EQ(text[element.end - 1], '>');
    for (const ScannedAttribute& attribute : element.attributes) {
      EXPECT_EQ(text.substr(attribute.name_at, attribute.name.size()), attribute.name);
      EXPECT_EQ(text[attribute.value_at - 1], text[attribute.value_at + attribute.value_size]);
    }
  }
}

std::string errorOf(const std::string& text) {
  const ScannedXml scan = scanXml(text);
  return scan.error ? std::to_string(scan.error->at) + ": " + scan.error->message : "none";
}

TEST(XmlScan, PlacesAreTrueUnderTabsCommentsCdataAndUmlauts) {
  const std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\r\n<!-- <not an=\"element\"> -->\r\n"
      "<a\tb = 'x>y'\r\n\tc=\"ü '\">\r\n  <![CDATA[ <b q=\"1\"> ]]><?pi <c> ?>\r\n\t<d.e/><f-g   h=\"&lt;\" ></f-g "
      ">\r\n</a>\r\n";
  expectPlacesTrue(text);
  const ScannedXml scan = scanXml(text);
  ASSERT_EQ(scan.elements.size(), 3u);
  EXPECT_EQ(scan.elements[0].attributes.size(), 2u);
  EXPECT_EQ(text.substr(scan.elements[0].attributes[0].value_at, 3), "x>y");
  EXPECT_EQ(scan.elements[0].text_at, text.find("<![CDATA["));
  EXPECT_EQ(scan.elements[1].name, "d.e");
  EXPECT_EQ(scan.elements[2].parent, 0);
  EXPECT_EQ(scan.elements[2].end, text.find("</a>") - 2);
  EXPECT_EQ(scan.elements[0].end, text.size() - 2);
}

TEST(XmlScan, AByteOrderMarkIsSteppedOver) { expectPlacesTrue("\xEF\xBB\xBF<?xml version='1.0'?><a b=''/>", 3); }

TEST(XmlScan, NotesTextButNotBlanksOrComments) {
  const ScannedXml scan = scanXml("<a> <!-- no --> <b> x </b>&#65;</a>");
  EXPECT_EQ(scan.elements[0].text_at, 26u);
  EXPECT_EQ(scan.elements[1].text_at, 20u);
  EXPECT_EQ(scanXml("<a> \n\t<b/></a>").elements[0].text_at, nowhere);
}

TEST(XmlScan, SaysWhatIsNotWellFormedAndWhere) {
  EXPECT_EQ(errorOf("<a><b></a>"), "6: </a> stands where </b> was expected: <b> was opened in line 1, column 4");
  EXPECT_EQ(errorOf("<a><b/>"), "0: <a> is never closed");
  EXPECT_EQ(errorOf("<a/></a>"), "4: </a> closes nothing");
  EXPECT_EQ(errorOf("<a/><b/>"), "4: <b> is a second outermost element: a file has one");
  EXPECT_EQ(errorOf("<a b></a>"), "3: attribute 'b' has no '='");
  EXPECT_EQ(errorOf("<a b=1></a>"), "3: attribute 'b' has no value in quotes");
  EXPECT_EQ(errorOf("<a b=\"1></a>"),
            "3: the value of attribute 'b' has no closing quote: it was opened in line 1, column 6");
  EXPECT_EQ(errorOf("<a b='1' b='2'/>"), "9: attribute 'b' is given twice");
  EXPECT_EQ(errorOf("<a b='1'c='2'/>"), "8: a blank was expected before the next attribute of <a>: the value of attribute "
                                        "'b', opened in line 1, column 6, ends here");
  EXPECT_EQ(errorOf("<a b=\"1 c=\"2\"/>"), "11: a blank was expected before the next attribute of <a>: the value of "
                                          "attribute 'b', opened in line 1, column 6, ends here");
  EXPECT_EQ(errorOf("<a =''/>"), "3: the name of an attribute of <a> was expected");
  EXPECT_EQ(errorOf("<a b='x & y'/>"), "8: '&' starts no known entity: write '&amp;' for the character itself");
  EXPECT_EQ(errorOf("<a>&evil;</a>"), "3: '&' starts no known entity: write '&amp;' for the character itself");
  EXPECT_EQ(errorOf("<a b='x<y'/>"),
            "7: '<' stands in the value of attribute 'b', whose quote was opened in line 1, column 6: write '&lt;', or "
            "close the quote before it");
  EXPECT_EQ(errorOf("<!DOCTYPE a><a/>"), "0: document type declarations are not allowed");
  EXPECT_EQ(errorOf("<a><!-- </a>"), "3: the comment is not closed by '-->'");
  EXPECT_EQ(errorOf("<a><![CDATA[ </a>"), "3: the CDATA section is not closed by ']]>'");
  EXPECT_EQ(errorOf("<a><?pi </a>"), "3: the processing instruction is not closed by '?>'");
  EXPECT_EQ(errorOf("<a "), "0: the tag <a> is not ended by '>'");
  EXPECT_EQ(errorOf("<a></a"), "3: the closing tag is not ended by '>'");
  EXPECT_EQ(errorOf("< a/>"), "0: '<' starts no tag: write '&lt;' for the character itself");
  EXPECT_EQ(errorOf("x<a/>"), "0: text stands before the outermost element");
  EXPECT_EQ(errorOf("<a/>x"), "4: text stands after the outermost element");
  EXPECT_EQ(errorOf(std::string("<a>\0</a>", 8)), "3: a control character stands here");
  EXPECT_EQ(errorOf("<a b='&#0;'/>"), "6: '&' starts no known entity: write '&amp;' for the character itself");
}

TEST(XmlScan, DepthCostsNoStack) {
  std::string text;
  for (int i = 0; i < 200000; ++i) text += "<a>";
  for (int i = 0; i < 200000; ++i) text += "</a>";
  EXPECT_EQ(scanXml(text).elements.size(), 200000u);
}

}  // namespace
}  // namespace tactus::dsl
