// The residual is small at an optimum, grows as a point moves off it, and names what is wrong.
#include "framework/control/kkt.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <random>

namespace tactus::control {
namespace {

class KktTest : public testing::Test {
 protected:
  Eigen::MatrixXd gaussian(int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return normal_(random_); });
  }
  // A programme whose optimum is known: x is chosen first, then rows at their bounds and multipliers, then t.
  ConstrainedLeastSquares programme(Eigen::VectorXd& x) {
    ConstrainedLeastSquares p;
    const int n = p.variables = 8;
    p.objective_rows = 10;
    p.equality_rows = 2;
    p.inequality_rows = 5;
    p.E = gaussian(2, n);
    p.G = gaussian(5, n);
    p.E.rowwise().normalize();
    p.G.rowwise().normalize();
    x = gaussian(n, 1);
    x -= p.E.completeOrthogonalDecomposition().solve(p.E * x);
    p.h = p.G * x;
    p.h.tail(2).array() += 0.5;                                    // three rows are at their bounds
    Eigen::VectorXd lambda = gaussian(3, 1).cwiseAbs();
    // Fᵀ(F x − t) + Eᵀ ν + Gᵀ λ = 0
    p.F = gaussian(10, n);
    const Eigen::VectorXd force = p.E.transpose() * gaussian(2, 1) + p.G.topRows(3).transpose() * lambda;
    p.t = p.F * x + p.F.transpose().completeOrthogonalDecomposition().solve(force);
    return p;
  }

  std::mt19937 random_{1};
  std::normal_distribution<> normal_;
};

TEST_F(KktTest, VanishesAtTheOptimumAndMeasuresTheDistanceFromIt) {
  KktCheck check(8, 2, 5);
  for (int k = 0; k < 100; ++k) {
    Eigen::VectorXd x;
    const ConstrainedLeastSquares p = programme(x);
    const KktResidual best = check.residual(p, x);
    EXPECT_LE(best.stationarity, 1e-10);
    EXPECT_LE(best.primal, 1e-12);
    EXPECT_LE(best.complementarity, 1e-12);
    EXPECT_EQ(check.activeCount(), 3);

    // Along a direction that keeps the rows at their bounds, the step away is what stationarity tells.
    Eigen::MatrixXd held(5, 8);
    held << p.E, p.G.topRows(3);
    Eigen::VectorXd along = gaussian(8, 1);
    along -= held.completeOrthogonalDecomposition().solve(held * along);
    along *= 1e-4 * x.norm() / along.norm();
    const KktResidual moved = check.residual(p, x + along);
    EXPECT_GE(moved.stationarity, 1e-7);
    EXPECT_LE(moved.stationarity, 1e-3);
    EXPECT_LE(moved.primal, 1e-12);

    const KktResidual pushed = check.residual(p, x + 1e-3 * p.G.row(0).transpose());
    EXPECT_GE(pushed.primal, 1e-5);
    const KktResidual inside = check.residual(p, x - 1e-3 * p.G.topRows(3).transpose().rowwise().sum());
    EXPECT_GE(std::max(inside.stationarity, inside.primal), 1e-6);
  }
}

TEST_F(KktTest, APointThatIsNoNumberIsInfinitelyWrong) {
  Eigen::VectorXd x;
  const ConstrainedLeastSquares p = programme(x);
  KktCheck check(8, 2, 5);
  x[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(check.residual(p, x).stationarity, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace tactus::control
