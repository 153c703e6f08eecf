#pragma once

#include <vector>

/// Tests of whether paired differences have a centre other than 0.  All p are two-sided.
namespace tactus::app {

/// Student's t test on differences d₁ … dₙ ("The probable error of a mean", Biometrika 6, 1908).
struct StudentTest {
  double t = 0;                                                    ///< mean / (sd / √n)
  double degrees = 0;                                              ///< n − 1
  double p = 0;
  double effect = 0;                                               ///< Cohen's d_z = mean / sd
  double lower = 0, upper = 0;                                     ///< 95 % confidence interval of the mean difference
};

/// Wilcoxon's signed rank test ("Individual comparisons by ranking methods", Biometrics Bulletin 1, 1945).
struct WilcoxonTest {
  long n = 0;                                                      ///< differences other than 0; zeros are left out
  double positive = 0;                                             ///< W⁺, sum of the ranks of positive differences
  double p = 0;
  bool exact = true;
};

/// All NaN for fewer than 2 differences, and where they are all the same: then there is no scatter to judge by.
StudentTest studentTest(const std::vector<double>& differences);

/// Equal sizes share the mean of their ranks.  Up to 50 differences p is exact, from all 2ⁿ signs that these ranks can
/// have; beyond, from the normal approximation with corrections for ties and continuity.  p is NaN without any
/// difference other than 0.
WilcoxonTest wilcoxonTest(const std::vector<double>& differences);

/// Holm's correction ("A simple sequentially rejective multiple test procedure", Scand. J. Stat. 6, 1979): p values
/// that hold for all tests at once, in the order given.  NaN stays NaN and counts as no test.
std::vector<double> holm(const std::vector<double>& p);

/// P(|T| ≥ |t|) of Student's distribution, to 1e-8 up to a million degrees of freedom, to 1e-12 up to a thousand.
double studentTwoSided(double t, double degrees);

}  // namespace tactus::app
