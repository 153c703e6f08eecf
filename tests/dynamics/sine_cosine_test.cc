#include "framework/dynamics/sine_cosine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/dynamics/robots.h"

namespace tactus::dynamics {
namespace {

struct Errors {
  double sine = 0, cosine = 0;
};

Errors errorsAt(double a, double b) {
  const double angles[] = {a, b};
  double sines[2], cosines[2];
  sinesAndCosines(angles, 2, sines, cosines);
  Errors errors;
  for (const int k : {0, 1}) {
    const long double exact = angles[k];
    errors.sine = std::max(errors.sine, std::abs(static_cast<double>(sines[k] - std::sin(exact))));
    errors.cosine = std::max(errors.cosine, std::abs(static_cast<double>(cosines[k] - std::cos(exact))));
  }
  return errors;
}

TEST(SineCosine, AgreesWithTheStandardLibrary) {
  test_robots::Random random(161);
  Errors worst;
  for (const double range : {0.1, 4.0, 100.0, 1e5, 1e7}) {
    for (int k = 0; k < 100000; ++k) {
      const Errors errors = errorsAt(test_robots::uniform(random, -range, range), test_robots::uniform(random, -range, range));
      worst.sine = std::max(worst.sine, errors.sine);
      worst.cosine = std::max(worst.cosine, errors.cosine);
    }
  }
  EXPECT_LE(worst.sine, 2e-16);
  EXPECT_LE(worst.cosine, 2e-16);
}

TEST(SineCosine, IsRightWhereQuartersMeet) {
  for (int quarter = -40; quarter <= 40; ++quarter) {
    const double boundary = quarter * (std::numbers::pi / 4);
    const Errors errors = errorsAt(std::nextafter(boundary, -1e9), std::nextafter(boundary, 1e9));
    EXPECT_LE(std::max(errors.sine, errors.cosine), 2e-16) << quarter;
  }
}

TEST(SineCosine, SmallAnglesKeepTheirDigits) {
  for (const double angle : {1e-300, 1e-20, 1e-8, 1e-3}) {
    const double angles[] = {angle, -angle};
    double sines[2], cosines[2];
    sinesAndCosines(angles, 2, sines, cosines);
    EXPECT_NEAR(sines[0] / std::sin(angle), 1, 3e-16);
    EXPECT_EQ(sines[1], -sines[0]);
    EXPECT_EQ(cosines[0], cosines[1]);
  }
}

TEST(SineCosine, WhatIsNotFiniteIsNotANumber) {
  const double angles[] = {std::numeric_limits<double>::infinity(), std::nan("")};
  double sines[2], cosines[2];
  sinesAndCosines(angles, 2, sines, cosines);
  for (const int k : {0, 1}) {
    EXPECT_TRUE(std::isnan(sines[k]));
    EXPECT_TRUE(std::isnan(cosines[k]));
  }
}

}  // namespace
}  // namespace tactus::dynamics
