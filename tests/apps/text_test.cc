#include "apps/tactus/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "apps/tactus/command.h"

namespace tactus::app {
namespace {

using ::testing::ElementsAre;

TEST(Text, NumbersBetweenCommasAndBlanks) {
  EXPECT_THAT(parseNumbers("1,-2.5e-3, 4", "--q"), ElementsAre(1, -0.0025, 4));
  EXPECT_TRUE(parseNumbers("", "--q").empty());
  for (const char* wrong : {"1,x", "1.5abc", "nan", "inf", "0x10", "1;2"}) {
    EXPECT_THROW(parseNumbers(wrong, "--q"), UsageError) << wrong;
  }
}

TEST(Text, WhatIsNoListOfNumbersIsTold) {
  const auto said = [](const char* text) {
    try {
      parseNumbers(text, "--q");
      return std::string("nothing");
    } catch (const UsageError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_EQ(said("1,2,,0"), "--q: number 3 is empty");
  EXPECT_EQ(said("1,2,"), "--q: number 3 is empty");
  EXPECT_EQ(said(" ,1"), "--q: number 1 is empty");
  EXPECT_EQ(said("1 2, 3"), "nothing");
  EXPECT_EQ(said("1,3x"), "--q: '3x' is not a number");
  EXPECT_EQ(said("inf"), "--q: 'inf' is not a finite number");
  EXPECT_EQ(said("1e999"), "--q: '1e999' is too large or too small a number");
}

TEST(Text, Counted) {
  EXPECT_EQ(counted(1, "number", "numbers"), "1 number");
  EXPECT_EQ(counted(2, "number", "numbers"), "2 numbers");
  EXPECT_EQ(counted(0, "number", "numbers"), "0 numbers");
}

TEST(Text, RoundedToSignificantDigits) {
  EXPECT_EQ(rounded(3.14159265), "3.142");
  EXPECT_EQ(rounded(0.000123456), "0.0001235");
  EXPECT_EQ(rounded(35), "35");
  EXPECT_EQ(rounded(std::nan("")), "–");
}

TEST(Text, TablesAreAligned) {
  EXPECT_EQ(textTable({{"metric", "value"}, {"a", "12.5"}, {"µ", "–"}}),
            "metric  value\na        12.5\nµ           –\n");
}

TEST(Text, SplitAndJoin) {
  EXPECT_THAT(split("a,,b", ','), ElementsAre("a", "", "b"));
  EXPECT_EQ(joined({"a", "b"}), "a, b");
}

}  // namespace
}  // namespace tactus::app
