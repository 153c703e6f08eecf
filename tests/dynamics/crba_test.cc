#include "framework/dynamics/crba.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "framework/dynamics/rnea.h"
#include "tests/dynamics/energy.h"
#include "tests/dynamics/random_state.h"

namespace tactus::dynamics {
namespace {

using test_robots::Random;

Eigen::MatrixXd massMatrix(RandomState& state) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Constant(state.model.dof(), state.model.dof(), 17);
  crba(state.model, state.q, state.workspace, M);
  return M;
}

TEST(Crba, ColumnsAreTorquesOfUnitAccelerations) {
  onRandomStates(51, [](RandomState& state, Random&) {
    const int dof = state.model.dof();
    const Eigen::MatrixXd M = massMatrix(state);
    Eigen::MatrixXd columns(dof, dof);
    for (int i = 0; i < dof; ++i) {
      Eigen::VectorXd tau(dof);
      rnea(state.model, state.q, Eigen::VectorXd::Zero(dof), Eigen::VectorXd::Unit(dof, i), Eigen::Vector3d::Zero(),
           state.workspace, tau);
      columns.col(i) = tau;
    }
    EXPECT_TRUE(near(M, columns, 1e-12));
  });
}

TEST(Crba, MassMatrixIsSymmetricAndPositiveDefinite) {
  onRandomStates(52, [](RandomState& state, Random&) {
    const Eigen::MatrixXd M = massMatrix(state);
    EXPECT_EQ(M, M.transpose());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(M, Eigen::EigenvaluesOnly).eigenvalues()[0], 0);
  });
}

TEST(Crba, JointsOnDifferentBranchesDoNotMeet) {
  onRandomStates(53, [](RandomState& state, Random&) {
    if (state.model.coupled()) return;
    const Eigen::MatrixXd M = massMatrix(state);
    for (int i = 0; i < state.model.dof(); ++i) {
      for (int j = 0; j < i; ++j) {
        if (i >= state.model.subtreeEnd(j)) {
          EXPECT_EQ(M(i, j), 0);
        }
      }
    }
  });
}

TEST(Crba, KineticEnergyIsThatOfTheLinks) {
  onRandomStates(54, [](RandomState& state, Random&) {
    const Eigen::MatrixXd M = massMatrix(state);
    forwardVelocities(state.model, state.qd, state.workspace);
    const double of_links = kineticEnergy(state.robot, state.model, state.workspace);
    EXPECT_NEAR(0.5 * state.qd.dot(M * state.qd), of_links, 1e-12 * of_links);
  });
}

}  // namespace
}  // namespace tactus::dynamics
