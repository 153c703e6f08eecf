#include "framework/runtime/percentile.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::runtime {
namespace {

TEST(Percentile, NearestRank) {
  const std::vector<double> values{9, 1, 5, 3, 7};
  EXPECT_EQ(percentile(values, 0), 1);
  EXPECT_EQ(percentile(values, 0.2), 1);
  EXPECT_EQ(percentile(values, 0.21), 3);
  EXPECT_EQ(percentile(values, 0.5), 5);
  EXPECT_EQ(percentile(values, 0.99), 9);
  EXPECT_EQ(percentile(values, 1), 9);
}

TEST(Percentile, OfAThousandIsExact) {
  std::vector<double> values;
  for (int i = 1000; i >= 1; --i) values.push_back(i);
  EXPECT_EQ(percentile(values, 0.5), 500);
  EXPECT_EQ(percentile(values, 0.99), 990);
  EXPECT_EQ(percentile(values, 0.999), 999);
}

TEST(Percentile, OneValueIsEveryPercentile) { EXPECT_EQ(percentile({4}, 0.01), 4); }

TEST(Percentile, OfNothingIsNotANumber) { EXPECT_TRUE(std::isnan(percentile({}, 0.5))); }

}  // namespace
}  // namespace tactus::runtime
