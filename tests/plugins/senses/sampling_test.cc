// What taxels and wires make of a number: sampled, late, noisy, cut and stepped.

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <random>

#include "plugins/senses/drift.h"
#include "plugins/senses/sampler.h"
#include "plugins/senses/taxel_response.h"

namespace tactus::plugins {
namespace {

constexpr double kPeriod = 0.001;

/// What is told in each of `ticks` ticks of a number that is the tick's own.
std::vector<int> told(double rate, double delay, int ticks) {
  Sampler sampler(1, rate, delay, kPeriod);
  std::vector<int> told;
  for (int k = 0; k < ticks; ++k) {
    const double time = k * kPeriod;
    if (sampler.isDue(time)) sampler.take(time)[0] = k;
    sampler.tell(time);
    told.push_back(static_cast<int>(sampler.told()[0]));
  }
  return told;
}

TEST(Sampler, WithoutRateAndDelayTellsEveryTick) {
  const auto all = told(0, 0, 2000);
  for (int k = 0; k < 2000; ++k) EXPECT_EQ(all[static_cast<std::size_t>(k)], k);
}

TEST(Sampler, HoldsBetweenSamples) {
  const auto all = told(20, 0, 3000);
  for (int k = 0; k < 3000; ++k) EXPECT_EQ(all[static_cast<std::size_t>(k)], k / 50 * 50);
}

TEST(Sampler, IsLateToTheTick) {
  const auto all = told(0, 0.007, 3000);
  for (int k = 0; k < 3000; ++k) EXPECT_EQ(all[static_cast<std::size_t>(k)], std::max(0, k - 7));
}

TEST(Sampler, KeepsTheRateOfOneThatNoTickMeets) {
  const auto all = told(300, 0, 30000);
  int samples = 0;
  for (int k = 1; k < 30000; ++k) {
    EXPECT_LE(k - all[static_cast<std::size_t>(k)], 3);
    samples += all[static_cast<std::size_t>(k)] != all[static_cast<std::size_t>(k - 1)];
  }
  EXPECT_NEAR(samples, 9000, 1);
}

// The newest sample that is old enough, found by looking at all of them.
TEST(Sampler, IsWhatItsDefinitionSays) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 40; ++trial) {
    const int every = 1 + static_cast<int>(random() % 30), late = static_cast<int>(random() % 60);
    const auto all = told(1 / (every * kPeriod), late * kPeriod, 500);
    for (int k = 0; k < 500; ++k)
      EXPECT_EQ(all[static_cast<std::size_t>(k)], k < late ? 0 : (k - late) / every * every) << every << " " << late;
  }
}

TEST(Drift, StaysWithinItsLimitAndFillsIt) {
  const Drift drift(0.1, 0.05);
  control::SplitMix64 random(1);
  double d = 0, sum = 0, squares = 0;
  const int steps = 2000000;
  for (int k = 0; k < steps; ++k) {
    d = drift.next(d, kPeriod, random);
    ASSERT_LE(std::abs(d), 0.05);
    sum += d;
    squares += d * d;
  }
  EXPECT_NEAR(sum / steps, 0, 0.004);
  EXPECT_NEAR(std::sqrt(squares / steps), 0.05 / std::sqrt(3.0), 0.002) << "uniform in its range";
}

TEST(Drift, GrowsWithTheRootOfTime) {
  const Drift drift(0.01, 10);
  control::SplitMix64 random(2);
  double squares = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    double d = 0;
    for (int k = 0; k < 400; ++k) d = drift.next(d, 0.01, random);
    squares += d * d;
  }
  EXPECT_NEAR(std::sqrt(squares / 2000), 0.02, 0.001);
}

Eigen::VectorXd respond(TaxelResponse& response, const Eigen::VectorXd& forces) {
  Eigen::VectorXd values(forces.size());
  response.respond(forces, kPeriod, values);
  return values;
}

TEST(Response, SaturatesStepsAndCutsOff) {
  TaxelResponse response(6, {.gain = 2, .range = 1, .levels = 10, .threshold = 0.25}, {}, 1);
  Eigen::VectorXd forces(6), expected(6);
  forces << 0, 0.1, 0.13, 0.24, 0.5, 7;
  expected << 0, 0, 0.3, 0.5, 1, 1;
  EXPECT_LT((respond(response, forces) - expected).norm(), 1e-12);
}

TEST(Response, DrawsAsManyDeadOnesAsTheShareSays) {
  const Eigen::VectorXd forces = Eigen::VectorXd::Ones(200);
  TaxelResponse response(200, {.dead = 0.1}, {}, 5), other(200, {.dead = 0.1}, {}, 6), listed(200, {}, {3, 199}, 5);
  const Eigen::VectorXd values = respond(response, forces);
  EXPECT_EQ((values.array() == 0).count(), 20);
  EXPECT_NE(values, respond(other, forces)) << "of the seed";
  const Eigen::VectorXd rest = respond(listed, forces);
  EXPECT_EQ((rest.array() == 0).count(), 2);
  EXPECT_EQ(rest[3] + rest[199], 0);
}

TEST(Response, HasTheNoiseThatItSays) {
  TaxelResponse response(100, {.noise = 0.03}, {}, 1);
  double sum = 0, squares = 0;
  const int samples = 500;
  for (int k = 0; k < samples; ++k) {
    const Eigen::VectorXd error = respond(response, Eigen::VectorXd::Ones(100)) - Eigen::VectorXd::Ones(100);
    sum += error.sum();
    squares += error.squaredNorm();
  }
  EXPECT_NEAR(sum / (100 * samples), 0, 5 * 0.03 / std::sqrt(100.0 * samples));
  EXPECT_NEAR(std::sqrt(squares / (100 * samples)), 0.03, 0.0005);
}

TEST(Response, LeavesNoiseAroundNothingAsItsHeaderSays) {
  TaxelResponse response(100, {.noise = 0.03}, {}, 1), quiet(100, {.noise = 0.03, .threshold = 0.18}, {}, 1);
  double sum = 0, above = 0;
  for (int k = 0; k < 500; ++k) {
    sum += respond(response, Eigen::VectorXd::Zero(100)).sum();
    above += respond(quiet, Eigen::VectorXd::Zero(100)).sum();
  }
  EXPECT_NEAR(sum / 50000, 0.03 / std::sqrt(2 * M_PI), 0.0005);
  EXPECT_EQ(above, 0) << "of a threshold of six deviations";
}

TEST(Response, OfTaxelsDiffersByTheSpreadOfGains) {
  TaxelResponse response(5000, {.gain = 2, .gain_spread = 0.1}, {}, 1);
  const Eigen::ArrayXd gains = respond(response, Eigen::VectorXd::Ones(5000)).array();
  EXPECT_NEAR(gains.mean(), 2, 0.01);
  EXPECT_NEAR(std::sqrt((gains - gains.mean()).square().mean()), 0.2, 0.01);
}

TEST(Response, RepeatsWithItsSeed) {
  const TaxelResponse::Options options = {
      .gain_spread = 0.1, .noise = 0.1, .drift = 0.1, .drift_limit = 1, .dead = 0.3};
  TaxelResponse first(50, options, {}, 9), second(50, options, {}, 9);
  for (int k = 0; k < 10; ++k)
    EXPECT_EQ(respond(first, Eigen::VectorXd::Ones(50)), respond(second, Eigen::VectorXd::Ones(50)));
}

}  // namespace
}  // namespace tactus::plugins
