// Figures and tests of samples, against worked examples that are in print and cases that have a closed form.

#include "apps/tactus/paired_tests.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apps/tactus/sample.h"

namespace tactus::app {
namespace {

/// Hours of sleep gained by ten patients, the second drug less the first: Cushny & Peebles (1905), Student's own
/// example (1908).
const std::vector<double> sleep{1.9 - 0.7, 0.8 + 1.6, 1.1 + 0.2, 0.1 + 1.2, -0.1 + 0.1,
                                4.4 - 3.4, 5.5 - 3.7, 1.6 - 0.8, 4.6 - 0.0, 3.4 - 2.0};

/// Heights of cross- less self-fertilised maize, eighths of an inch: Darwin (1876), in Fisher, The Design of
/// Experiments (1935), § 17.
const std::vector<double> maize{49, -67, 8, 16, 6, 23, 28, 41, 14, 29, 56, 24, 75, 60, -48};

/// Hamilton depression scale before less after tranquilliser: Hollander & Wolfe, Nonparametric Statistical Methods
/// (1973), table 3.1.
const std::vector<double> depression{1.83 - 0.878, 0.50 - 0.647, 1.62 - 0.598, 2.48 - 2.05, 1.68 - 1.06,
                                     1.88 - 1.29,  1.55 - 1.06,  3.06 - 3.14,  1.30 - 1.29};

TEST(StudentTest, SleepOfCushnyAndPeebles) {
  const StudentTest test = studentTest(sleep);
  EXPECT_NEAR(test.t, 4.0621, 5e-5);
  EXPECT_EQ(test.degrees, 9);
  EXPECT_NEAR(test.p, 0.002833, 5e-7);
  EXPECT_NEAR(test.effect, 4.0621 / std::sqrt(10.0), 2e-5);
  EXPECT_NEAR(test.lower, 0.7001142, 5e-8);
  EXPECT_NEAR(test.upper, 2.4598858, 5e-8);
}

TEST(StudentTest, MaizeOfDarwinAndFisher) {
  const StudentTest test = studentTest(maize);
  EXPECT_NEAR(figuresOf(maize).mean, 20.933, 5e-4);
  EXPECT_NEAR(test.t, 2.148, 5e-4);
  EXPECT_NEAR(test.p, 0.0497, 5e-5);
}

/// One and two degrees of freedom have closed forms.
TEST(StudentTest, DistributionMeetsItsClosedForms) {
  for (const double t : {1e-9, 0.01, 0.3, 1.0, 2.5, 40.0, 1e6}) {
    const double cauchy = 2 / std::numbers::pi * std::atan(1 / t);
    EXPECT_NEAR(studentTwoSided(t, 1), cauchy, 1e-13 * cauchy) << t;
    const double two = t < 100 ? 1 - t / std::sqrt(2 + t * t) : 1 / (t * t);
    EXPECT_NEAR(studentTwoSided(t, 2), two, 1e-11 * two + 1e-16) << t;
    EXPECT_EQ(studentTwoSided(-t, 7), studentTwoSided(t, 7));
  }
  EXPECT_EQ(studentTwoSided(0, 5), 1);
  // Many degrees of freedom: the normal distribution and the first term beyond (Abramowitz & Stegun 26.7).
  const double z = 1.959963984540054, density = std::exp(-z * z / 2) / std::sqrt(2 * std::numbers::pi);
  EXPECT_NEAR(studentTwoSided(z, 1e5), 0.05 + density * z * (z * z + 1) / (2 * 1e5), 1e-9);
}

TEST(StudentTest, WithoutScatterThereIsNoTest) {
  for (const std::vector<double>& differences : {std::vector<double>{}, {1}, {0, 0, 0}, {0.1, 0.1, 0.1}}) {
    const StudentTest test = studentTest(differences);
    for (const double figure : {test.t, test.degrees, test.p, test.effect, test.lower, test.upper})
      EXPECT_TRUE(std::isnan(figure)) << differences.size();
  }
}

TEST(WilcoxonTest, DepressionOfHollanderAndWolfe) {
  const WilcoxonTest test = wilcoxonTest(depression);
  EXPECT_EQ(test.positive, 40);
  EXPECT_EQ(test.n, 9);
  EXPECT_TRUE(test.exact);
  EXPECT_EQ(test.p, 20.0 / 512);                                   // 10 of 512 sums reach 40
}

TEST(WilcoxonTest, MaizeOfDarwin) {
  const WilcoxonTest test = wilcoxonTest(maize);
  EXPECT_EQ(test.positive, 120 - 24);
  EXPECT_EQ(test.p, 0.041259765625);
}

/// Every sign pattern counted one by one, with ties and zeros.
TEST(WilcoxonTest, ExactIsTheCountOfAllSigns) {
  const std::vector<std::vector<double>> cases{
      {1, 2, 3, 4}, {1, -1, 1, 2}, {0, 0, 3, -1, 2, 2}, {-5, -5, -5, -5, -5}, {0.5, -1.5, 1.5, 2.5, -2.5, 7, 8, -0.5}};
  for (const std::vector<double>& differences : cases) {
    std::vector<double> sizes;
    double w = 0;
    for (const double difference : differences)
      if (difference != 0) sizes.push_back(std::abs(difference));
    const auto rank = [&](double size) {
      double below = 0, same = 0;
      for (const double other : sizes) (other < size ? below : same) += other <= size;
      return below + (same + 1) / 2;
    };
    for (const double difference : differences) w += difference > 0 ? rank(difference) : 0;
    double low = 0, high = 0;
    const unsigned all = 1u << sizes.size();
    for (unsigned signs = 0; signs < all; ++signs) {
      double sum = 0;
      for (size_t i = 0; i < sizes.size(); ++i) sum += signs >> i & 1 ? rank(sizes[i]) : 0;
      low += sum <= w;
      high += sum >= w;
    }
    const WilcoxonTest test = wilcoxonTest(differences);
    EXPECT_EQ(test.positive, w);
    EXPECT_EQ(test.p, std::min(1.0, 2 * std::min(low, high) / all));
  }
}

/// Where the exact count ends, the approximation goes on at the same place.
TEST(WilcoxonTest, ApproximationMeetsTheExactCount) {
  std::vector<double> differences;
  for (int i = 1; i <= 50; ++i) differences.push_back(i % 3 == 0 ? -i : i);
  const WilcoxonTest exact = wilcoxonTest(differences);
  differences.push_back(-51);
  const WilcoxonTest normal = wilcoxonTest(differences);
  differences.back() = 51;
  const WilcoxonTest other = wilcoxonTest(differences);
  EXPECT_TRUE(exact.exact);
  EXPECT_FALSE(normal.exact);
  EXPECT_LT(other.p, exact.p);
  EXPECT_GT(normal.p, exact.p);
  EXPECT_TRUE(std::isnan(wilcoxonTest({0, 0}).p));
}

TEST(Holm, StepsDownAndNeverFalls) {
  const std::vector<double> corrected = holm({0.01, 0.04, NAN, 0.03, 0.005});
  const std::vector<double> expected{0.03, 0.06, NAN, 0.06, 0.02};
  for (size_t i = 0; i < expected.size(); ++i) {
    if (std::isnan(expected[i])) {
      EXPECT_TRUE(std::isnan(corrected[i]));
    } else {
      EXPECT_DOUBLE_EQ(corrected[i], expected[i]) << i;
    }
  }
  EXPECT_EQ(holm({0.9, 0.8}), (std::vector<double>{1, 1}));
  EXPECT_TRUE(holm({}).empty());
}

TEST(Sample, FiguresOfSmallSamples) {
  const SampleFigures four = figuresOf({4, 1, 3, 2});
  EXPECT_EQ(four.n, 4);
  EXPECT_EQ(four.mean, 2.5);
  EXPECT_DOUBLE_EQ(four.sd, std::sqrt(5.0 / 3));
  EXPECT_EQ(four.minimum, 1);
  EXPECT_EQ(four.lower_quartile, 1.75);
  EXPECT_EQ(four.median, 2.5);
  EXPECT_EQ(four.upper_quartile, 3.25);
  EXPECT_EQ(four.maximum, 4);
  EXPECT_TRUE(std::isnan(figuresOf({7}).sd));
  EXPECT_EQ(figuresOf({7}).median, 7);
  EXPECT_TRUE(std::isnan(figuresOf({}).mean));
  EXPECT_EQ(figuresOf({0.1, 0.1, 0.1}).mean, 0.1);
  EXPECT_EQ(figuresOf({0.1, 0.1, 0.1}).sd, 0);
}

TEST(Sample, OrderChangesNoBit) {
  const SampleFigures one = figuresOf({0.1, 1e16, 0.3, -1e16, 0.7}), other = figuresOf({-1e16, 0.7, 0.3, 0.1, 1e16});
  EXPECT_EQ(one.mean, other.mean);
  EXPECT_EQ(one.sd, other.sd);
}

}  // namespace
}  // namespace tactus::app
