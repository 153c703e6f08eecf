// The regression against its closed form (Rasmussen and Williams 2006, 2.23–2.26), and what more points do to it.
#include "plugins/exploration/gaussian_process.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "framework/control/random.h"

namespace tactus::exploration {
namespace {

Eigen::Vector3d anyPoint(control::SplitMix64& random) {
  return {random.symmetric(), random.symmetric(), random.symmetric()};
}

double kernel(const Covariance& c, const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return c.deviation * c.deviation * std::exp(-(p - q).squaredNorm() / (2 * c.length * c.length));
}

TEST(GaussianProcess, MeetsTheClosedForm) {
  control::SplitMix64 random(1);
  for (int n = 0; n <= 40; ++n) {
    const Covariance c{0.3 + random.uniform(), 0.5 + random.uniform(), 0.05};
    const double m = random.symmetric();
    GaussianProcess process(c, m, 40);
    Eigen::Matrix3Xd X(3, n);
    Eigen::VectorXd y(n);
    for (int i = 0; i < n; ++i) {
      X.col(i) = anyPoint(random);
      y[i] = random.symmetric();
      ASSERT_TRUE(process.observe(X.col(i), y[i]));
    }
    Eigen::MatrixXd K(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) K(i, j) = kernel(c, X.col(i), X.col(j)) + (i == j ? c.noise * c.noise : 0);
    const Eigen::MatrixXd inverse = K.inverse();
    for (int k = 0; k < 10; ++k) {
      const Eigen::Vector3d p = anyPoint(random);
      Eigen::VectorXd k_p(n);
      for (int i = 0; i < n; ++i) k_p[i] = kernel(c, p, X.col(i));
      const Eigen::VectorXd centred = y.array() - m;
      EXPECT_NEAR(process.mean(p), m + k_p.dot(inverse * centred), 1e-9);
      EXPECT_NEAR(process.variance(p), c.deviation * c.deviation - k_p.dot(inverse * k_p), 1e-9);
    }
  }
}

TEST(GaussianProcess, OfOnePointByHand) {
  GaussianProcess process({1, 2, 1}, 0, 1);
  ASSERT_TRUE(process.observe(Eigen::Vector3d::Zero(), 5));
  // k = 4, σ_n² = 1: mean 4/5 · 5, variance 4 − 16/5.
  EXPECT_NEAR(process.mean(Eigen::Vector3d::Zero()), 4, 1e-12);
  EXPECT_NEAR(process.variance(Eigen::Vector3d::Zero()), 0.8, 1e-12);
  // At distance ℓ k = 4 e^-½.
  EXPECT_NEAR(process.mean(Eigen::Vector3d::UnitX()), 4 * std::exp(-0.5), 1e-12);
  EXPECT_FALSE(process.observe(Eigen::Vector3d::Ones(), 1)) << "it is full";
}

TEST(GaussianProcess, TheGradientIsThatOfTheMean) {
  control::SplitMix64 random(2);
  GaussianProcess process({0.5, 1, 0.1}, 1, 20);
  for (int i = 0; i < 20; ++i) process.observe(anyPoint(random), random.symmetric());
  for (int k = 0; k < 20; ++k) {
    const Eigen::Vector3d p = anyPoint(random);
    Eigen::Vector3d gradient;
    EXPECT_NEAR(process.mean(p, gradient), process.mean(p), 1e-12);
    constexpr double h = 1e-5;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
      EXPECT_NEAR(gradient[i], (process.mean(p + step) - process.mean(p - step)) / (2 * h), 1e-7);
    }
  }
}

TEST(GaussianProcess, EveryPointLowersTheVarianceEverywhere) {
  control::SplitMix64 random(3);
  GaussianProcess process({0.4, 1, 0.1}, 0, 60);
  Eigen::Matrix3Xd places(3, 30);
  for (int k = 0; k < 30; ++k) places.col(k) = anyPoint(random);
  Eigen::VectorXd last = Eigen::VectorXd::Ones(30);
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(process.observe(anyPoint(random), 0));
    for (int k = 0; k < 30; ++k) {
      const double now = process.variance(places.col(k));
      EXPECT_LE(now, last[k] + 1e-12);
      last[k] = now;
    }
  }
  EXPECT_LT(last.minCoeff(), 0.3) << "and somewhere it did, by much";
}

// An implicit surface as the surface map makes it: 0 on the sphere, −1 a depth behind, prior mean 1.
TEST(GaussianProcess, ReconstructsASphereFromTouchedPoints) {
  constexpr double radius = 0.1, depth = 0.03;
  control::SplitMix64 random(4);
  GaussianProcess process({0.06, 1, 0.05}, 1, 400);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d n = anyPoint(random).normalized();
    process.observe(radius * n, 0);
    process.observe((radius - depth) * n, -1);
  }
  double worst = 0;
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector3d n = anyPoint(random).normalized();
    double inner = radius - 0.02, outer = radius + 0.02;           // bisection along the ray
    ASSERT_LT(process.mean(inner * n), 0);
    ASSERT_GT(process.mean(outer * n), 0);
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (inner + outer);
      (process.mean(middle * n) < 0 ? inner : outer) = middle;
    }
    worst = std::max(worst, std::abs(inner - radius));
  }
  EXPECT_LT(worst, 0.003) << "m";
}

}  // namespace
}  // namespace tactus::exploration
