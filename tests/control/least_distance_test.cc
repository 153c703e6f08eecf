// Least-distance programmes: optimality by its own conditions, contradictions, and what releasing rows is for.
#include "framework/control/least_distance.h"

#include <gtest/gtest.h>

#include <random>

namespace tactus::control {
namespace {

class LeastDistanceTest : public testing::Test {
 protected:
  RowMajorMatrix unitColumns(int n, int count) {
    RowMajorMatrix columns = RowMajorMatrix::NullaryExpr(n, count, [this] { return normal_(random_); });
    for (int j = 2; j < count; ++j)
      if (integer(0, 3) == 0)
        columns.col(j) = columns.col(j - 1) - 2 * columns.col(j - 2);
      else if (integer(0, 4) == 0)
        columns.col(j) = (integer(0, 1) ? 1 : -1) * columns.col(integer(0, j - 1));
    columns.colwise().normalize();
    return columns;
  }
  Eigen::VectorXd gaussian(int n) {
    return Eigen::VectorXd::NullaryExpr(n, [this] { return normal_(random_); });
  }
  int integer(int lower, int upper) { return std::uniform_int_distribution<>(lower, upper)(random_); }

  std::mt19937 random_{1};
  std::normal_distribution<> normal_;
};

TEST_F(LeastDistanceTest, MeetsTheOptimalityConditions) {
  int released = 0;
  int active = 0;
  for (int k = 0; k < 3000; ++k) {
    const int n = integer(1, 26);
    const int m = integer(0, 40);
    const RowMajorMatrix rows = unitColumns(n, m);
    const Eigen::VectorXd inside = gaussian(n);                    // keeps every row
    const Eigen::VectorXd d = rows.transpose() * inside + gaussian(m).cwiseAbs() * (k % 2);
    const Eigen::VectorXd c = 3 * gaussian(n);
    LeastDistance solver(26, 40);
    ASSERT_EQ(solver.solve(rows, d, c), LeastDistance::Outcome::solved);
    const Eigen::VectorXd x = solver.x();
    const Eigen::VectorXd lambda = solver.multipliers();
    const double size = c.norm() + inside.norm();
    EXPECT_LE((x + rows * lambda - c).norm(), 1e-9 * (size + lambda.norm()));
    for (int j = 0; j < m; ++j) {
      const double slack = d[j] - rows.col(j).dot(x);
      EXPECT_GE(slack, -1e-9 * size);
      EXPECT_GE(lambda[j], -1e-9 * size);
      EXPECT_LE(std::abs(lambda[j] * slack), 1e-9 * size * (size + lambda.norm()));
    }
    released += solver.releasedCount();
    active += solver.activeCount();
  }
  EXPECT_GE(active, 1000);
  EXPECT_GE(released, 100);
}

TEST_F(LeastDistanceTest, SaysWhenRowsContradictEachOther) {
  LeastDistance solver(2, 3);
  RowMajorMatrix opposed(2, 2);
  opposed << 1, -1, 0, 0;
  EXPECT_EQ(solver.solve(opposed, Eigen::Vector2d(-1, -1), Eigen::Vector2d(0, 0)), LeastDistance::Outcome::infeasible);
  EXPECT_EQ(solver.solve(opposed, Eigen::Vector2d(1, -1), Eigen::Vector2d(5, 2)), LeastDistance::Outcome::solved);
  EXPECT_EQ(solver.x(), Eigen::Vector2d(1, 2));
  // Three rows that close a triangle around nothing.
  RowMajorMatrix triangle(2, 3);
  triangle << 1, -0.5, -0.5, 0, std::sqrt(0.75), -std::sqrt(0.75);
  EXPECT_EQ(solver.solve(triangle, Eigen::Vector3d(-1, -1, -1), Eigen::Vector2d(0, 0)),
            LeastDistance::Outcome::infeasible);
}

TEST_F(LeastDistanceTest, WithoutReleaseTheAnswerIsFartherAway) {
  int farther = 0;
  for (int k = 0; k < 300; ++k) {
    // Rows that lie nearly in three of eight dimensions get in each other's way.
    RowMajorMatrix rows = 0.2 * unitColumns(8, 12);
    rows.topRows(3) += unitColumns(3, 12);
    rows.colwise().normalize();
    const Eigen::VectorXd c = gaussian(8);
    LeastDistance solver(8, 12);
    ASSERT_EQ(solver.solve(rows, Eigen::VectorXd::Zero(12), c), LeastDistance::Outcome::solved);
    const double nearest = (solver.x() - c).norm();
    ASSERT_EQ(solver.solve(rows, Eigen::VectorXd::Zero(12), c, false), LeastDistance::Outcome::solved);
    EXPECT_GE((solver.x() - c).norm(), nearest * (1 - 1e-12));
    farther += (solver.x() - c).norm() > nearest * (1 + 1e-6);
  }
  EXPECT_GE(farther, 50);
}

}  // namespace
}  // namespace tactus::control
