// Each way in which a log can differ from the golden one must be found and told.

#include "framework/runtime/golden.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "framework/runtime/file_error.h"
#include "tests/runtime/temporary_folder.h"

namespace tactus::runtime {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using tactus::testing::TemporaryFolder;

CsvTable table(const std::string& content) {
  const TemporaryFolder folder;
  return CsvTable::read(folder.write("a.csv", content));
}

GoldenComparison compare(const std::string& expected, const std::string& actual,
                         const std::vector<Tolerance>& tolerances = {}) {
  return compareGolden(table(expected), table(actual), tolerances);
}

constexpr const char* log =
    "time,level/1/rank,task/sweep/error,task/hold/error\n0,3,0.5,1\n0.01,3,0.25,2\n0.02,2,0.125,3\n";

TEST(Golden, SameLogPasses) {
  const GoldenComparison comparison = compare(log, log);
  EXPECT_TRUE(comparison.passed());
  EXPECT_EQ(comparison.text(), "");
}

TEST(Golden, WithoutToleranceOneBitFails) {
  const GoldenComparison comparison = compare("time,x\n0,1\n", "time,x\n0,1.0000000000000002\n");
  ASSERT_EQ(comparison.failures.size(), 1u);
  EXPECT_TRUE(std::isinf(comparison.failures[0].worst_ratio));
}

TEST(Golden, NamesColumnTimeAndTaskThatDivergedFirst) {
  const GoldenComparison comparison =
      compare(log, "time,level/1/rank,task/sweep/error,task/hold/error\n0,3,0.5,1\n0.01,3,0.25,2.5\n0.02,2,0.5,4\n",
              {{"*", 0.1, 0}});
  EXPECT_FALSE(comparison.passed());
  ASSERT_EQ(comparison.failures.size(), 2u);
  EXPECT_EQ(comparison.failures[0].column, "task/hold/error");
  EXPECT_EQ(comparison.failures[0].time, 0.01);
  EXPECT_NEAR(comparison.failures[0].worst_ratio, 10, 1e-12);  // 1 over 0.1, at 0.02 s
  EXPECT_THAT(comparison.text(),
              StartsWith("first divergence: task/hold/error (task 'hold') at time 0.01 s: expected 2, "
                         "got 2.5\n"));
  EXPECT_THAT(comparison.text(),
              HasSubstr("  task/sweep/error: worst error is 3.75 × its tolerance, first at time 0.02 s"));
}

TEST(Golden, FirstTaskIsNamedWhenAnotherColumnDivergedBefore) {
  const GoldenComparison comparison =
      compare(log, "time,level/1/rank,task/sweep/error,task/hold/error\n0,2,0.5,1\n0.01,3,0,2\n0.02,2,0.125,3\n");
  EXPECT_THAT(comparison.text(), StartsWith("first divergence: level/1/rank at time 0 s: expected 3, got 2\n"
                                            "first task to diverge: task/sweep/error (task 'sweep') at time 0.01 s"));
}

TEST(Golden, MissingAndExtraColumnsFail) {
  const GoldenComparison comparison = compare("time,a,b\n0,1,2\n", "time,b,c\n0,2,3\n");
  EXPECT_FALSE(comparison.passed());
  EXPECT_EQ(comparison.missing, std::vector<std::string>{"a"});
  EXPECT_EQ(comparison.extra, std::vector<std::string>{"c"});
  EXPECT_THAT(comparison.text(), HasSubstr("missing column: a\nextra column: c\n"));
}

TEST(Golden, UnequalRowsFail) {
  const GoldenComparison comparison = compare("time\n0\n1\n", "time\n0\n");
  EXPECT_FALSE(comparison.passed());
  EXPECT_THAT(comparison.text(), HasSubstr("rows: expected 2, got 1"));
}

TEST(Golden, NotANumberEqualsItselfAlone) {
  const std::vector<Tolerance> wide{{"*", 1e9, 1e9}};
  EXPECT_TRUE(compare("time,x\n0,nan\n", "time,x\n0,nan\n", wide).passed());
  EXPECT_FALSE(compare("time,x\n0,1\n", "time,x\n0,nan\n", wide).passed());
  EXPECT_FALSE(compare("time,x\n0,nan\n", "time,x\n0,1\n", wide).passed());
  EXPECT_FALSE(compare("time,x\n0,1\n", "time,x\n0,inf\n", wide).passed());
}

TEST(Golden, ToleranceIsAbsolutePlusRelative) {
  const std::vector<Tolerance> tolerance{{"x", 0.25, 0.5}};  // 4 ± (0.25 + 2)
  EXPECT_TRUE(compare("time,x\n0,4\n", "time,x\n0,6.25\n", tolerance).passed());
  EXPECT_FALSE(compare("time,x\n0,4\n", "time,x\n0,6.2500001\n", tolerance).passed());
}

TEST(Golden, LastMatchingToleranceCounts) {
  const std::vector<Tolerance> tolerances{{"*", 1, 0}, {"task/*", 0.1, 0}, {"task/hold/*", 10, 0}};
  EXPECT_TRUE(compare("time,q/a\n0,0\n", "time,q/a\n0,1\n", tolerances).passed());
  EXPECT_FALSE(compare("time,task/a/error\n0,0\n", "time,task/a/error\n0,1\n", tolerances).passed());
  EXPECT_TRUE(compare("time,task/hold/error\n0,0\n", "time,task/hold/error\n0,9\n", tolerances).passed());
}

TEST(Golden, ALogNeedsTime) { EXPECT_THROW(compare("x\n0\n", "time\n0\n"), FileError); }

TEST(Glob, StarsAndQuestionMarks) {
  EXPECT_TRUE(matchesGlob("*", ""));
  EXPECT_TRUE(matchesGlob("*", "task/a/error"));
  EXPECT_TRUE(matchesGlob("task/*/error", "task/a/b/error"));
  EXPECT_TRUE(matchesGlob("q/joint_?", "q/joint_3"));
  EXPECT_TRUE(matchesGlob("a*b*c", "aXbYbZc"));
  EXPECT_FALSE(matchesGlob("q/joint_?", "q/joint_33"));
  EXPECT_FALSE(matchesGlob("task/*/error", "task/a/errors"));
  EXPECT_FALSE(matchesGlob("", "x"));
}

/// The definition, one character at a time.
bool matchesSlowly(std::string_view pattern, std::string_view text) {
  if (pattern.empty()) return text.empty();
  if (pattern[0] == '*') {
    return matchesSlowly(pattern.substr(1), text) || (!text.empty() && matchesSlowly(pattern, text.substr(1)));
  }
  return !text.empty() && (pattern[0] == '?' || pattern[0] == text[0]) &&
         matchesSlowly(pattern.substr(1), text.substr(1));
}

TEST(Glob, AgreesWithItsDefinitionOnRandomWords) {
  std::mt19937 random(7);
  int matches = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string pattern, text;
    for (auto n = random() % 6; n > 0; --n) pattern += "ab*?"[random() % 4];
    for (auto n = random() % 7; n > 0; --n) text += "ab"[random() % 2];
    EXPECT_EQ(matchesGlob(pattern, text), matchesSlowly(pattern, text)) << pattern << " " << text;
    matches += matchesGlob(pattern, text);
  }
  EXPECT_GT(matches, 1000);
}

}  // namespace
}  // namespace tactus::runtime
