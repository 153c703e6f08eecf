#include "framework/dynamics/operational_space.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "framework/dynamics/dynamics_cache.h"
#include "conformance/allocation_count.h"
#include "tests/dynamics/random_state.h"

// Laws of a generalised inverse on contact rows of random robots, repeated and badly scaled rows included.
namespace tactus::dynamics {
namespace {

using test_robots::Random;
using test_robots::uniform;

/// Independent rows, and then some that follow from them.
struct Rows {
  Eigen::MatrixXd J;
  int rank;
};

Rows randomRows(Random& random, int dof, int independent, int dependent) {
  Rows rows{Eigen::MatrixXd(independent + dependent, dof), independent};
  for (int i = 0; i < independent; ++i) rows.J.row(i) = test_robots::uniformVector(random, dof, 1).transpose();
  for (int i = independent; i < independent + dependent; ++i) {
    const Eigen::VectorXd mix = test_robots::uniformVector(random, independent, 1);
    rows.J.row(i) = mix.transpose() * rows.J.topRows(independent);
  }
  for (int i = static_cast<int>(rows.J.rows()) - 1; i > 0; --i) rows.J.row(i).swap(rows.J.row(random() % (i + 1)));
  return rows;
}

Eigen::MatrixXd randomFactor(Random& random, int dof) {
  Eigen::MatrixXd L = Eigen::MatrixXd::Zero(dof, dof);
  for (int j = 0; j < dof; ++j) {
    for (int i = j; i < dof; ++i) L(i, j) = i == j ? uniform(random, 0.3, 2) : uniform(random, -0.3, 0.3);
  }
  return L;
}

Eigen::MatrixXd gram(const Eigen::MatrixXd& J, const Eigen::MatrixXd& L) {
  const Eigen::MatrixXd A_T = L.triangularView<Eigen::Lower>().solve(J.transpose());
  return A_T.transpose() * A_T;
}

TEST(OperationalSpace, IndependentRowsHaveTheInverse) {
  Random random(91);
  for (int trial = 0; trial < 200; ++trial) {
    const int dof = 1 + static_cast<int>(random() % 40), m = 1 + static_cast<int>(random() % std::min(dof, 12));
    const Eigen::MatrixXd L = randomFactor(random, dof);
    const Rows rows = randomRows(random, dof, m, 0);
    OperationalSpace space(12, dof);
    space.compute(rows.J, L);
    EXPECT_EQ(space.rank(), m);
    const Eigen::MatrixXd product = gram(rows.J, L) * space.inertia();
    const double condition = gram(rows.J, L).norm() * Eigen::MatrixXd(space.inertia()).norm();
    EXPECT_TRUE(near(product, Eigen::MatrixXd::Identity(m, m), 1e-14 * (1 + condition)));
  }
}

TEST(OperationalSpace, DependentRowsHaveAGeneralisedInverse) {
  Random random(92);
  int deficient = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int dof = 3 + static_cast<int>(random() % 38);
    const int independent = 1 + static_cast<int>(random() % std::min(dof, 9));
    const int dependent = static_cast<int>(random() % 6);
    const Eigen::MatrixXd L = randomFactor(random, dof);
    const Rows rows = randomRows(random, dof, independent, dependent);
    OperationalSpace space(15, dof);
    space.compute(rows.J, L);
    ASSERT_EQ(space.rank(), independent);
    deficient += dependent > 0;
    const Eigen::MatrixXd G = gram(rows.J, L), Lambda = space.inertia();
    EXPECT_EQ(Lambda, Lambda.transpose());
    const double tolerance = 1e-13 * G.norm() * Lambda.norm();
    EXPECT_TRUE(near(G * Lambda * G, G, tolerance));
    EXPECT_TRUE(near(Lambda * G * Lambda, Lambda, tolerance));
  }
  EXPECT_GT(deficient, 200);
}

TEST(OperationalSpace, ARowTwiceSharesItsInertiaEvenly) {
  Random random(93);
  const Eigen::MatrixXd L = randomFactor(random, 7);
  const Rows rows = randomRows(random, 7, 1, 0);
  OperationalSpace space(4, 7);
  space.compute(rows.J, L);
  const double alone = space.inertia()(0, 0);
  space.compute(rows.J.replicate(2, 1), L);
  EXPECT_EQ(space.rank(), 1);
  EXPECT_TRUE(near(space.inertia(), Eigen::MatrixXd::Constant(2, 2, alone / 4), 1e-13));
}

TEST(OperationalSpace, UnitsOfTheRowsDoNotMatter) {
  Random random(94);
  for (int trial = 0; trial < 200; ++trial) {
    const int dof = 6 + static_cast<int>(random() % 30);
    const Eigen::MatrixXd L = randomFactor(random, dof);
    const Rows rows = randomRows(random, dof, 4, 2);
    const Eigen::VectorXd units =
        Eigen::VectorXd::NullaryExpr(6, [&] { return std::pow(10, uniform(random, -4, 3)); });
    OperationalSpace space(6, dof);
    space.compute(rows.J, L);
    const Eigen::MatrixXd Lambda = space.inertia();
    space.compute(units.asDiagonal() * rows.J, L);
    ASSERT_EQ(space.rank(), 4);
    const Eigen::MatrixXd in_old_units = units.asDiagonal() * space.inertia() * units.asDiagonal();
    EXPECT_TRUE(near(in_old_units, Lambda, 1e-11 * gram(rows.J, L).norm() * Lambda.norm() + 1e-13));
  }
}

TEST(OperationalSpace, ToleranceDecidesTheRank) {
  Eigen::MatrixXd J(3, 3);
  J << 1, 0, 0, 1, 1e-6, 0, 0, 0, 1e-7;
  OperationalSpace space(3, 3);
  const Eigen::MatrixXd L = Eigen::MatrixXd::Identity(3, 3);
  space.compute(J, L);
  EXPECT_EQ(space.rank(), 3);
  space.compute(J, L, {.rank_tolerance = 1e-5});                   // the second row is the first, the third is nothing
  EXPECT_EQ(space.rank(), 1);
  EXPECT_EQ(space.inertia()(2, 2), 0);
  space.compute(Eigen::MatrixXd::Zero(2, 3), L);
  EXPECT_EQ(space.rank(), 0);
  EXPECT_EQ(Eigen::MatrixXd(space.inertia()), Eigen::MatrixXd::Zero(2, 2));
}

TEST(OperationalSpace, NoRowsAreNoTrouble) {
  OperationalSpace space(3, 5);
  space.compute(Eigen::MatrixXd(0, 5), Eigen::MatrixXd::Identity(5, 5));
  EXPECT_EQ(space.rank(), 0);
  EXPECT_EQ(space.inertia().size(), 0);
}

TEST(OperationalSpace, ManyContactsOnOneFingerHaveTheRankOfItsJoints) {
  Random random(95);
  RandomState state(test_robots::lwrAllegro(), random);
  DynamicsCache cache(state.model);
  cache.update(state.q, state.qd);
  const int tip = state.model.frameIndex("index_tip"), base = state.model.frameIndex("7");
  Eigen::MatrixXd J(12, 23), J_base(3, 23);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d point_W = cache.framePose(tip) * Eigen::Vector3d(0.01 * k, 0.02, 0.005 * k * k);
    cache.pointJacobian(tip, point_W, J.middleRows<3>(3 * k));
  }
  cache.pointJacobian(base, cache.framePose(base).translation(), J_base);
  OperationalSpace space(12, 23);
  space.compute(J, cache.massFactor());
  EXPECT_EQ(space.rank(), 6);                                      // points of one rigid link
  // A force that balances on the link accelerates nothing; Jᵀ Λ J projects: (M⁻¹ Jᵀ Λ J)² = M⁻¹ Jᵀ Λ J.
  const Eigen::MatrixXd P = cache.massMatrix().llt().solve(J.transpose() * space.inertia() * J);
  EXPECT_TRUE(near(P * P, P, 1e-7));
  EXPECT_NEAR(P.trace(), 6, 1e-6);
}

TEST(OperationalSpace, TakesNoMemoryAfterConstruction) {
  Random random(96);
  for (const int dof : {3, 23, 40}) {
    const Eigen::MatrixXd L = randomFactor(random, dof);
    const Rows many = randomRows(random, dof, std::min(dof, 8), 4), few = randomRows(random, dof, 2, 0);
    OperationalSpace space(12, dof);
    const long before = conformance::allocationCount();
    space.compute(many.J, L);
    space.compute(few.J, L);
    EXPECT_EQ(conformance::allocationCount(), before);
  }
}

}  // namespace
}  // namespace tactus::dynamics
