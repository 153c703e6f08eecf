#include "framework/dynamics/cholesky.h"

#include <gtest/gtest.h>

#include "tests/dynamics/random_state.h"

namespace tactus::dynamics {
namespace {

TEST(Cholesky, FactorsPositiveDefiniteMatrices) {
  test_robots::Random random(71);
  for (int n = 0; n <= 48; ++n) {
    Eigen::MatrixXd A(n, n);
    for (int j = 0; j < n; ++j) A.col(j) = test_robots::uniformVector(random, n, 1);
    const Eigen::MatrixXd M = A * A.transpose() + Eigen::MatrixXd::Identity(n, n);
    Eigen::MatrixXd L = Eigen::MatrixXd::Zero(n, n);
    EXPECT_TRUE(choleskyFactor(M, L));
    EXPECT_TRUE(L.isLowerTriangular(0));
    EXPECT_TRUE(near(L * L.transpose(), M, 1e-14));
  }
}

TEST(Cholesky, SaysWhenAMatrixIsNotPositiveDefinite) {
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(2, 2);
  EXPECT_FALSE(choleskyFactor((Eigen::MatrixXd(2, 2) << 1, 2, 2, 1).finished(), L));
  EXPECT_FALSE(choleskyFactor(Eigen::MatrixXd::Zero(2, 2), L));
  EXPECT_FALSE(choleskyFactor(Eigen::MatrixXd::Constant(2, 2, std::numeric_limits<double>::quiet_NaN()), L));
}

}  // namespace
}  // namespace tactus::dynamics
