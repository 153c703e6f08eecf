// The factor against dense singular value decompositions: what it holds, what it leaves, which rank it sees.
#include "framework/control/priority_factor.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <random>

namespace tactus::control {
namespace {

class PriorityFactorTest : public testing::Test {
 protected:
  RowMajorMatrix gaussian(int rows, int columns) {
    return RowMajorMatrix::NullaryExpr(rows, columns, [this] { return normal_(random_); });
  }
  int integer(int lower, int upper) { return std::uniform_int_distribution<>(lower, upper)(random_); }

  // Unit columns, some of them combinations of others.
  RowMajorMatrix unitColumns(int n, int count) {
    RowMajorMatrix columns = gaussian(n, count);
    for (int j = 2; j < count; ++j)
      if (integer(0, 2) == 0) columns.col(j) = gaussian(1, 1)(0) * columns.col(j - 1) - 2 * columns.col(j - 2);
    columns.colwise().normalize();
    return columns;
  }

  static Eigen::MatrixXd projector(PriorityFactor& factor) {
    RowMajorMatrix P = RowMajorMatrix::Identity(factor.dimension(), factor.dimension());
    factor.advance(P);
    factor.embed(P);
    return P;
  }

  std::mt19937 random_{1};
  std::normal_distribution<> normal_;
};

TEST_F(PriorityFactorTest, LeavesTheOrthogonalComplementOfAllRows) {
  int deficient = 0;
  for (int k = 0; k < 200; ++k) {
    const int n = integer(3, 25);
    PriorityFactor factor(n, 40, 4, {});
    Eigen::MatrixXd all(n, 0);
    for (int stage = 0; stage < 3; ++stage) {
      RowMajorMatrix columns = unitColumns(n, integer(0, 12));
      const Eigen::Index before = all.cols();
      all.conservativeResize(n, before + columns.cols());
      all.rightCols(columns.cols()) = columns;
      factor.advance(columns);
      deficient += factor.hold(columns).deficient;
    }
    int rank = 0;
    Eigen::MatrixXd expected = Eigen::MatrixXd::Identity(n, n);
    if (all.cols() > 0) {
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(all, Eigen::ComputeThinU);
      for (const double sigma : svd.singularValues()) rank += sigma > 1e-7;
      expected -= svd.matrixU().leftCols(rank) * svd.matrixU().leftCols(rank).transpose();
    }
    EXPECT_EQ(factor.held(), rank);
    EXPECT_LE((projector(factor) - expected).norm(), 1e-10);
  }
  EXPECT_GE(deficient, 100);
}

TEST_F(PriorityFactorTest, KeepsWhatEachSingularDirectionIsFadedBy) {
  const RankOptions options{0.2, 0.8};
  int faded = 0;
  for (int k = 0; k < 200; ++k) {
    const int n = integer(3, 12);
    RowMajorMatrix columns = gaussian(n, integer(1, 10));
    columns.colwise().normalize();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(Eigen::MatrixXd(columns), Eigen::ComputeThinU);
    Eigen::MatrixXd expected = Eigen::MatrixXd::Identity(n, n);
    int rank = 0;
    for (int i = 0; i < svd.singularValues().size(); ++i) {
      const double weight = fadeWeight(svd.singularValues()[i], options);
      faded += weight > 0 && weight < 1;
      rank += weight > 0;
      expected -= weight * svd.matrixU().col(i) * svd.matrixU().col(i).transpose();
    }
    PriorityFactor factor(n, 10, 1, options);
    EXPECT_EQ(factor.hold(columns).rank, rank);
    EXPECT_LE((projector(factor) - expected).norm(), 1e-12);
  }
  EXPECT_GE(faded, 100);
}

TEST_F(PriorityFactorTest, SeesSmallSingularValuesWherePivotsAreMisleading) {
  // Kahan's matrix: no pivot comes near the least singular value.
  const int n = 23;
  RowMajorMatrix kahan = RowMajorMatrix::Zero(n, n);
  const double s = std::sin(1.2), c = std::cos(1.2);
  for (int i = 0; i < n; ++i) {
    kahan(i, i) = std::pow(s, i);
    for (int j = i + 1; j < n; ++j) kahan(i, j) = -c * std::pow(s, i);
  }
  const double least = Eigen::JacobiSVD<Eigen::MatrixXd>(Eigen::MatrixXd(kahan)).singularValues()[n - 1];
  const double pivot = std::pow(s, n - 1);
  ASSERT_LT(least, 0.01 * pivot);
  PriorityFactor factor(n, n, 1, {0.05 * pivot, 0.1 * pivot});
  RowMajorMatrix columns = kahan;
  EXPECT_EQ(factor.hold(columns).rank, n - 1);
}

TEST_F(PriorityFactorTest, TheFadeIsSmoothAndMonotonic) {
  const RankOptions options{1e-3, 1e-1};
  EXPECT_EQ(fadeWeight(1e-3, options), 0);
  EXPECT_EQ(fadeWeight(1e-1, options), 1);
  EXPECT_NEAR(fadeWeight(0.5 * (1e-3 + 1e-1), options), 0.5, 1e-12);
  for (double sigma = 0; sigma < 0.12; sigma += 1e-3)
    EXPECT_LE(fadeWeight(sigma, options), fadeWeight(sigma + 1e-3, options));
  EXPECT_EQ(fadeWeight(1, {1e-8, 1e-8}), 1);
  EXPECT_EQ(fadeWeight(1e-9, {1e-8, 1e-8}), 0);
}

TEST_F(PriorityFactorTest, AStageCanBeTakenBack) {
  PriorityFactor factor(5, 5, 2, {});
  RowMajorMatrix first = unitColumns(5, 2);
  factor.hold(first);
  const Eigen::MatrixXd before = projector(factor);
  RowMajorMatrix second = gaussian(5, 2);
  second.colwise().normalize();
  factor.advance(second);
  factor.hold(second);
  EXPECT_GT((projector(factor) - before).norm(), 0.1);
  factor.dropLastStage();
  EXPECT_EQ(projector(factor), before);
}

}  // namespace
}  // namespace tactus::control
