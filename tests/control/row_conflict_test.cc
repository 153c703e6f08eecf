// Contradictions between groups of rows that can be seen by eye, and random ones with a planted contradiction.
#include "framework/control/row_conflict.h"

#include <gtest/gtest.h>

#include "tests/plugins/random_problem.h"

namespace tactus::control {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

/// row · x ≤ bound
RowGroup half(std::initializer_list<double> row, double bound) {
  RowGroup group{MatrixXd(1, static_cast<Eigen::Index>(row.size())), VectorXd::Constant(1, bound)};
  std::copy(row.begin(), row.end(), group.rows.data());
  return group;
}

TEST(RowConflict, NoneWhereAllCanBeMet) {
  const std::vector<RowGroup> groups{half({1, 0}, 1), half({-1, 0}, -1), half({0, 1}, -5)};
  EXPECT_TRUE(isFeasible(groups));
  EXPECT_TRUE(smallestConflict(groups).empty());
}

TEST(RowConflict, OpposedRowsWithContradictoryBounds) {
  // x₁ ≤ 1 and x₁ ≥ 3, among rows that have no part in it.
  const std::vector<RowGroup> groups{half({0, 1}, 0), half({1, 0}, 1), half({1, 1}, 10), half({-2, 0}, -6)};
  EXPECT_FALSE(isFeasible(groups));
  EXPECT_EQ(smallestConflict(groups), (std::vector<int>{1, 3}));
  const auto slack = leastSlack(groups, 1);
  ASSERT_TRUE(slack);
  EXPECT_NEAR((*slack)[0], 2, 1e-9);
  EXPECT_NEAR((*leastSlack(groups, 3))[0], 4, 1e-9) << "in the unit of the row, which is twice as long";
  EXPECT_FALSE(leastSlack(groups, 0)) << "the contradiction is among the others";
}

TEST(RowConflict, AllThreeSidesOfATriangleAreNeeded) {
  // x₁ ≥ 1, x₂ ≥ 1, x₁ + x₂ ≤ 1: no two of them contradict each other.
  const std::vector<RowGroup> groups{half({-1, 0}, -1), half({0, -1}, -1), half({1, 1}, 1), half({1, -1}, 4)};
  EXPECT_EQ(smallestConflict(groups), (std::vector<int>{0, 1, 2}));
  EXPECT_NEAR((*leastSlack(groups, 0))[0], 1, 1e-9);
  EXPECT_NEAR((*leastSlack(groups, 2))[0], 1, 1e-9);
}

TEST(RowConflict, TheSlackOfAGroupIsSharedOutInLeastSquares) {
  // x₁ ≤ 0 and x₂ ≤ 0 in one group against x₁ + x₂ ≥ 2: 1 each.
  RowGroup both{MatrixXd::Identity(2, 2), VectorXd::Zero(2)};
  const auto slack = leastSlack({both, half({-1, -1}, -2)}, 0);
  ASSERT_TRUE(slack);
  EXPECT_NEAR((*slack)[0], 1, 1e-9);
  EXPECT_NEAR((*slack)[1], 1, 1e-9);
}

TEST(RowConflict, ARowWithoutEffect) {
  EXPECT_TRUE(isFeasible({half({0, 0}, 1)}));
  EXPECT_EQ(smallestConflict({half({1, 0}, 1), half({0, 0}, -1)}), (std::vector<int>{1}));
  EXPECT_NEAR((*leastSlack({half({1, 0}, 1), half({0, 0}, -1)}, 1))[0], 1, 1e-9);
}

TEST(RowConflict, OfRandomGroupsNoneCanBeSparedAndEverySlackSuffices) {
  test::ProblemSource source(3);
  int contradictions = 0;
  for (int k = 0; k < 60; ++k) {
    const int n = source.integer(2, 8);
    const VectorXd inside = source.gaussian(n, 1);
    std::vector<RowGroup> groups;
    for (int g = 0; g < 10; ++g) {
      const MatrixXd rows = source.gaussian(source.integer(1, 2), n);
      const VectorXd room = source.gaussian(static_cast<int>(rows.rows()), 1).cwiseAbs();
      groups.push_back({rows, rows * inside + room});
    }
    EXPECT_TRUE(isFeasible(groups));
    // Planted: the sum of three rows must be above the sum of their bounds.
    RowVectorXd sum = RowVectorXd::Zero(n);
    double bound = 0;
    for (const int g : {2, 5, 7}) {
      sum += groups[static_cast<size_t>(g)].rows.row(0);
      bound += groups[static_cast<size_t>(g)].bounds[0];
    }
    groups.push_back({-sum, VectorXd::Constant(1, -bound - 1)});
    const std::vector<int> conflict = smallestConflict(groups);
    ASSERT_FALSE(conflict.empty());
    ++contradictions;
    EXPECT_LE(conflict.size(), 10u);
    std::vector<RowGroup> set;
    for (const int g : conflict) set.push_back(groups[static_cast<size_t>(g)]);
    EXPECT_FALSE(isFeasible(set));
    for (size_t i = 0; i < set.size(); ++i) {
      std::vector<RowGroup> without = set;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
      EXPECT_TRUE(isFeasible(without));
      const auto slack = leastSlack(set, static_cast<int>(i));
      ASSERT_TRUE(slack);
      std::vector<RowGroup> relaxed = set;
      relaxed[i].bounds += *slack * (1 + 1e-6);
      EXPECT_TRUE(isFeasible(relaxed)) << "enough";
      relaxed[i].bounds = set[i].bounds + 0.99 * *slack;
      EXPECT_FALSE(isFeasible(relaxed)) << "and no more than enough";
    }
  }
  EXPECT_EQ(contradictions, 60);
}

}  // namespace
}  // namespace tactus::control
