#include "dsl/diagnostic.h"

#include <gtest/gtest.h>

namespace tactus::dsl {
namespace {

Diagnostic example() {
  Diagnostic diagnostic;
  diagnostic.code = "E012";
  diagnostic.message = "<a> has no attribute 'bb'";
  diagnostic.place = {"f.xml", 7, 5};
  diagnostic.length = 2;
  diagnostic.source_line = "\t<a bb=\"1\"/>";
  return diagnostic;
}

TEST(Diagnostic, NothingSteersTheTerminal) {
  Diagnostic diagnostic = example();
  diagnostic.source_line = "<a \x1B[31mbb\x7F=\"1\"/>";
  diagnostic.message = "a \x07 bell";
  const std::string text = render(diagnostic);
  EXPECT_NE(text.find("a ? bell"), std::string::npos);
  EXPECT_NE(text.find("<a ?[31mbb?=\"1\"/>"), std::string::npos);
}

TEST(Diagnostic, IsRenderedWithItsLineAndACaretBelowTheColumn) {
  EXPECT_EQ(render(example()),
            "f.xml:7:5: error[E012]: <a> has no attribute 'bb'\n"
            "  7 | \t<a bb=\"1\"/>\n"
            "    | \t   ^^\n");
}

TEST(Diagnostic, ShowsSuggestionPathAndIncludes) {
  Diagnostic diagnostic = example();
  diagnostic.severity = Severity::warning;
  diagnostic.suggestion = "bar";
  diagnostic.path = "/stack/a";
  diagnostic.included_from = {{"g.xml", 3, 1}, {"h.xml", 4, 2}};
  EXPECT_EQ(render(diagnostic),
            "f.xml:7:5: warning[E012]: <a> has no attribute 'bb'\n"
            "  7 | \t<a bb=\"1\"/>\n"
            "    | \t   ^^ did you mean 'bar'?\n"
            "  in /stack/a, included from g.xml:3:1, included from h.xml:4:2\n");
}

TEST(Diagnostic, WithoutALineTheSuggestionStandsAlone) {
  Diagnostic diagnostic = example();
  diagnostic.source_line.clear();
  diagnostic.suggestion = "bar";
  EXPECT_EQ(render(diagnostic), "f.xml:7:5: error[E012]: <a> has no attribute 'bb'\n  did you mean 'bar'?\n");
}

TEST(Diagnostic, CaretsStopWhereTheLineDoes) {
  Diagnostic diagnostic = example();
  diagnostic.length = 1000;
  EXPECT_NE(render(diagnostic).find("   ^^^^^^^^\n"), std::string::npos);
}

TEST(InvalidStack, SaysAllThatItHolds) {
  const InvalidStack invalid({example(), example()});
  EXPECT_EQ(invalid.what(), render(example()) + render(example()));
}

}  // namespace
}  // namespace tactus::dsl
