#include "framework/dynamics/forward_dynamics.h"

#include <gtest/gtest.h>

#include "framework/dynamics/aba.h"
#include "framework/dynamics/crba.h"
#include "framework/dynamics/dynamics_cache.h"
#include "framework/dynamics/rnea.h"
#include "conformance/allocation_count.h"
#include "tests/dynamics/random_state.h"

// Forward dynamics undoes inverse dynamics on every kind of tree, pushed from outside or not; the sparse factor is that
// of M; constraints are met and do no more than they must.
namespace tactus::dynamics {
namespace {

using test_robots::Random;

ExternalForces randomForces(const RandomState& state, Random& random) {
  ExternalForces forces(state.model);
  for (int k = 0; k < 3; ++k) {
    const int frame = static_cast<int>(random() % state.model.frames().size());
    forces.addForce(frame, test_robots::uniformVector3(random, 1), test_robots::uniformVector3(random, 20));
    forces.addMoment(frame, test_robots::uniformVector3(random, 5));
  }
  return forces;
}

TEST(ForwardDynamics, UndoesInverseDynamics) {
  int coupled = 0;
  onRandomStates(101, [&](RandomState& state, Random& random) {
    coupled += state.model.coupled();
    const ExternalForces external = randomForces(state, random);
    ForwardDynamics forward(state.model);
    Eigen::VectorXd tau(state.model.dof()), qdd(state.model.dof());
    for (const ExternalForces* pushed : {static_cast<const ExternalForces*>(nullptr), &external}) {
      rnea(state.model, state.q, state.qd, state.qdd, state.gravity_W, state.workspace, tau, pushed);
      forward.compute(state.q, state.qd, tau, state.gravity_W, state.workspace, qdd, pushed);
      EXPECT_TRUE(near(qdd, state.qdd, 1e-8));
    }
  });
  EXPECT_GE(coupled, 20);
}

TEST(ForwardDynamics, ExternalForcesAreTorquesThroughJacobians) {
  onRandomStates(102, [](RandomState& state, Random& random) {
    const int frame = static_cast<int>(random() % state.model.frames().size()), dof = state.model.dof();
    const Eigen::Vector3d point_W = test_robots::uniformVector3(random, 1), f_W = test_robots::uniformVector3(random, 20);
    Eigen::VectorXd free(dof), pushed(dof);
    rnea(state.model, state.q, state.qd, state.qdd, state.gravity_W, state.workspace, free);
    ExternalForces external(state.model);
    external.addForce(frame, point_W, f_W);
    rnea(state.model, state.q, state.qd, state.qdd, state.gravity_W, state.workspace, pushed, &external);
    Eigen::MatrixXd J(3, dof);
    pointJacobian(state.model, state.workspace, frame, point_W, J);
    EXPECT_TRUE(near(free - pushed, J.transpose() * f_W, 1e-11, 1 + free.cwiseAbs().maxCoeff()));
  });
}

TEST(ForwardDynamics, AbaRefusesCoupledJoints) {
  description::Robot robot = test_robots::lwr();
  robot.joints[3].mimic = description::Mimic{0, 1, 0};
  const Model model(robot);
  Workspace workspace(model);
  Eigen::VectorXd v = Eigen::VectorXd::Zero(6);
  EXPECT_THROW(aba(model, v, v, v, {0, 0, -9.81}, workspace, v), std::invalid_argument);
}

TEST(MassMatrixFactor, AppliesTheInverseToVectorsAndMatrices) {
  onRandomStates(103, [](RandomState& state, Random&) {
    const int dof = state.model.dof();
    Eigen::MatrixXd M(dof, dof);
    crba(state.model, state.q, state.workspace, M);
    MassMatrixFactor factor(state.model);
    ASSERT_TRUE(factor.compute(M));
    Eigen::VectorXd x = M * state.qdd;
    factor.solveInPlace(x);
    EXPECT_TRUE(near(x, state.qdd, 1e-8));
    Eigen::MatrixXd inverse = Eigen::MatrixXd::Identity(dof, dof);
    factor.solveInPlace(inverse);
    EXPECT_TRUE(near(M * inverse, Eigen::MatrixXd::Identity(dof, dof), 1e-8));
  });
}

TEST(MassMatrixFactor, SaysWhenMIsNotPositiveDefinite) {
  const Model model(test_robots::lwr());
  MassMatrixFactor factor(model);
  Eigen::MatrixXd M = Eigen::MatrixXd::Identity(7, 7);
  EXPECT_TRUE(factor.compute(M));
  M(3, 3) = 0;
  EXPECT_FALSE(factor.compute(M));
  M(3, 3) = std::nan("");
  EXPECT_FALSE(factor.compute(M));
}

TEST(ConstrainedDynamics, MeetsItsRowsAndIsGaussLeastConstraint) {
  onRandomStates(104, [](RandomState& state, Random& random) {
    const int dof = state.model.dof();
    DynamicsCache cache(state.model, state.gravity_W);
    cache.update(state.q, state.qd);
    // A frame held in place, its point rows twice: dependent on purpose.
    const int frame = static_cast<int>(random() % state.model.frames().size());
    Eigen::MatrixXd J(9, dof);
    cache.frameJacobian(frame, J.topRows<6>());
    J.bottomRows<3>() = J.topRows<3>();
    Eigen::VectorXd wanted(9);
    wanted.head<6>() = J.topRows<6>() * test_robots::uniformVector(random, dof, 3);  // reachable
    wanted.tail<3>() = wanted.head<3>();
    const Eigen::VectorXd drive = test_robots::uniformVector(random, dof, 10) - cache.bias();
    ConstrainedDynamics dynamics(9, dof);
    dynamics.compute(cache.massFactor(), drive, J, wanted);
    const Eigen::VectorXd qdd = dynamics.acceleration();
    EXPECT_TRUE(near(J * qdd, wanted, 1e-7, 1));
    EXPECT_TRUE(near(cache.massMatrix() * qdd, drive + J.transpose() * dynamics.forces(), 1e-8, 1));
    EXPECT_LE(dynamics.rank(), 6);
  });
}

TEST(ForwardDynamics, TakesNoMemoryAfterConstruction) {
  onRandomStates(105, [](RandomState& state, Random& random) {
    const ExternalForces external = randomForces(state, random);
    ForwardDynamics forward(state.model);
    Eigen::VectorXd qdd(state.model.dof());
    const long before = conformance::allocationCount();
    forward.compute(state.q, state.qd, state.qdd, state.gravity_W, state.workspace, qdd, &external);
    EXPECT_EQ(conformance::allocationCount(), before);
  });
}

}  // namespace
}  // namespace tactus::dynamics
