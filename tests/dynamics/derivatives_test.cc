#include "framework/dynamics/derivatives.h"

#include <gtest/gtest.h>

#include "framework/dynamics/crba.h"
#include "framework/dynamics/rnea.h"
#include "conformance/allocation_count.h"
#include "tests/dynamics/random_state.h"

// Analytic derivatives against central differences of fourth order of the functions themselves, on every kind of tree.
namespace tactus::dynamics {
namespace {

using test_robots::Random;

constexpr double step = 5e-4;
constexpr double tolerance = 1e-8;                                 // of the greatest entry
constexpr double forward_tolerance = 2e-7;                         // the condition of M magnifies the differences' rounding

template <class Function>
Eigen::MatrixXd differences(int dof, Function at) {
  Eigen::MatrixXd matrix(dof, dof);
  for (int k = 0; k < dof; ++k) matrix.col(k) = (8 * (at(k, step) - at(k, -step)) - (at(k, 2 * step) - at(k, -2 * step))) / (12 * step);
  return matrix;
}

ExternalForces pushes(const RandomState& state, Random& random, bool none) {
  ExternalForces forces(state.model);
  for (int k = 0; k < 3 && !none; ++k) {
    const int frame = static_cast<int>(random() % state.model.frames().size());
    forces.addForce(frame, test_robots::uniformVector3(random, 1), test_robots::uniformVector3(random, 20));
  }
  return forces;
}

TEST(DynamicsDerivatives, OfInverseDynamics) {
  int trial = 0;
  onRandomStates(111, [&](RandomState& state, Random& random) {
    const int dof = state.model.dof();
    const ExternalForces external = pushes(state, random, trial++ % 2 == 0);
    const auto torque = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
      Eigen::VectorXd tau(dof);
      rnea(state.model, q, qd, state.qdd, state.gravity_W, state.workspace, tau, &external);
      return tau;
    };
    DynamicsDerivatives derivatives(state.model);
    derivatives.computeInverse(state.q, state.qd, state.qdd, state.gravity_W, state.workspace, &external);
    EXPECT_TRUE(near(derivatives.torque(), torque(state.q, state.qd), 1e-13));
    EXPECT_TRUE(near(derivatives.torqueByPosition(), differences(dof, [&](int k, double h) {
                       return torque(nudged(state.model, state.q, k, h), state.qd);
                     }), tolerance, 1));
    EXPECT_TRUE(near(derivatives.torqueByVelocity(), differences(dof, [&](int k, double h) {
                       return torque(state.q, state.qd + h * Eigen::VectorXd::Unit(dof, k));
                     }), tolerance, 1));
  });
}

TEST(DynamicsDerivatives, OfForwardDynamics) {
  int trial = 0;
  onRandomStates(112, [&](RandomState& state, Random& random) {
    const int dof = state.model.dof();
    const ExternalForces external = pushes(state, random, trial++ % 2 == 0);
    Eigen::VectorXd tau(dof);
    rnea(state.model, state.q, state.qd, state.qdd, state.gravity_W, state.workspace, tau, &external);
    ForwardDynamics forward(state.model);
    const auto acceleration = [&](const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& torque) {
      Eigen::VectorXd qdd(dof);
      forward.compute(q, qd, torque, state.gravity_W, state.workspace, qdd, &external);
      return qdd;
    };
    DynamicsDerivatives derivatives(state.model);
    derivatives.computeForward(state.q, state.qd, tau, state.gravity_W, state.workspace, &external);
    EXPECT_TRUE(near(derivatives.acceleration(), state.qdd, 1e-8));
    EXPECT_TRUE(near(derivatives.accelerationByPosition(), differences(dof, [&](int k, double h) {
                       return acceleration(nudged(state.model, state.q, k, h), state.qd, tau);
                     }), forward_tolerance, 1));
    EXPECT_TRUE(near(derivatives.accelerationByVelocity(), differences(dof, [&](int k, double h) {
                       return acceleration(state.q, state.qd + h * Eigen::VectorXd::Unit(dof, k), tau);
                     }), forward_tolerance, 1));
    Eigen::MatrixXd M(dof, dof);
    crba(state.model, state.q, state.workspace, M);
    EXPECT_TRUE(near(M * derivatives.accelerationByTorque(), Eigen::MatrixXd::Identity(dof, dof), 1e-8));
  });
}

TEST(DynamicsDerivatives, TakeNoMemoryAfterConstruction) {
  onRandomStates(113, [](RandomState& state, Random&) {
    DynamicsDerivatives derivatives(state.model);
    const long before = conformance::allocationCount();
    derivatives.computeForward(state.q, state.qd, state.qdd, state.gravity_W, state.workspace);
    EXPECT_EQ(conformance::allocationCount(), before);
  });
}

}  // namespace
}  // namespace tactus::dynamics
