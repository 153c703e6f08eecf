#include "dsl/source_text.h"

#include <gtest/gtest.h>

namespace tactus::dsl {
namespace {

std::string at(const SourceText& text, std::size_t offset) {
  const auto place = text.place(offset);
  return std::to_string(place.line) + ":" + std::to_string(place.column);
}

TEST(SourceText, CountsLinesAndColumnsFromOne) {
  const SourceText text("f.xml", "ab\ncd\n\nx");
  EXPECT_EQ(text.place(0).file, "f.xml");
  EXPECT_EQ(at(text, 0), "1:1");
  EXPECT_EQ(at(text, 2), "1:3");
  EXPECT_EQ(at(text, 3), "2:1");
  EXPECT_EQ(at(text, 6), "3:1");
  EXPECT_EQ(at(text, 7), "4:1");
  EXPECT_EQ(at(text, 100), "4:2");
  EXPECT_EQ(at(SourceText("f", ""), 0), "1:1");
}

TEST(SourceText, ATabAndAnUmlautAreOneColumnEach) {
  const SourceText text("f", "\tü€x");
  EXPECT_EQ(at(text, 1), "1:2");
  EXPECT_EQ(at(text, 3), "1:3");
  EXPECT_EQ(at(text, 6), "1:4");
}

TEST(SourceText, CarriageReturnsEndNoLineButBelongToItsEnd) {
  const SourceText text("f", "ab\r\ncd\r\n");
  EXPECT_EQ(at(text, 4), "2:1");
  EXPECT_EQ(text.line(1), "ab");
  EXPECT_EQ(text.line(5), "cd");
  EXPECT_EQ(text.lineAt(2), "cd");
  EXPECT_EQ(text.lineAt(4), "");
  EXPECT_EQ(text.lineAt(0), "");
}

TEST(SourceText, AByteOrderMarkTakesNoColumn) {
  const SourceText text("f", "\xEF\xBB\xBF<a/>");
  EXPECT_EQ(text.begin(), 3u);
  EXPECT_EQ(at(text, 3), "1:1");
  EXPECT_EQ(at(text, 0), "1:1");
  EXPECT_EQ(text.line(3), "<a/>");
}

TEST(SourceText, FindsWhatIsNotUtf8) {
  EXPECT_FALSE(SourceText("f", "aü€\xF0\x9F\x98\x80").firstBadByte());
  EXPECT_EQ(SourceText("f", "ab\xFF").firstBadByte(), 2u);
  EXPECT_EQ(SourceText("f", "\xC3").firstBadByte(), 0u);           // cut off
  EXPECT_EQ(SourceText("f", "a\xC0\x80").firstBadByte(), 1u);      // overlong
  EXPECT_EQ(SourceText("f", "\xED\xA0\x80").firstBadByte(), 0u);   // surrogate
  EXPECT_EQ(SourceText("f", "\xF4\x90\x80\x80").firstBadByte(), 0u);
}

}  // namespace
}  // namespace tactus::dsl
