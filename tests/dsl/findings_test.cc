#include "dsl/findings.h"

#include <gtest/gtest.h>

namespace tactus::dsl {
namespace {

Diagnostic at(int line, const std::string& message = "wrong") {
  Diagnostic diagnostic;
  diagnostic.message = message;
  diagnostic.place = {"f.xml", line, 1};
  return diagnostic;
}

TEST(Findings, KeepAtMostFiftyErrors) {
  Findings findings;
  for (int line = 1; line <= 1000; ++line) findings.add(at(line));
  EXPECT_EQ(findings.errors().size(), 50u);
}

TEST(Findings, AreThrownInTheOrderOfTheFileAndOnlyOnce) {
  Findings findings;
  findings.add(at(5));
  findings.add(at(2));
  findings.add(at(5));
  Diagnostic included = at(9, "wrong in an include");
  included.place.file = "g.xml";
  included.included_from = {{"f.xml", 3, 1}};
  findings.add(included);
  try {
    findings.throwErrors();
    FAIL() << "nothing was thrown";
  } catch (const InvalidStack& invalid) {
    ASSERT_EQ(invalid.diagnostics.size(), 3u);
    EXPECT_EQ(invalid.diagnostics[0].place.line, 2);
    EXPECT_EQ(invalid.diagnostics[1].place.file, "g.xml");
    EXPECT_EQ(invalid.diagnostics[2].place.line, 5);
  }
}

TEST(Findings, WarningsThrowNothing) {
  Findings findings;
  Diagnostic warning = at(1);
  warning.severity = Severity::warning;
  findings.add(warning);
  EXPECT_NO_THROW(findings.throwErrors());
  EXPECT_EQ(findings.warnings().size(), 1u);
}

}  // namespace
}  // namespace tactus::dsl
