#include "framework/dynamics/centroidal.h"

#include <gtest/gtest.h>

#include "framework/description/combine.h"
#include "framework/dynamics/crba.h"
#include "tests/dynamics/energy.h"
#include "tests/dynamics/free_swing.h"

// The robot as one body, against sums over the links of the description, and against differences in time.
namespace tactus::dynamics {
namespace {

using test_robots::Random;

constexpr double step = 1e-6;

void sweep(RandomState& state, const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
  forwardKinematics(state.model, q, state.workspace);
  forwardVelocities(state.model, qd, state.workspace);
  worldInertias(state.model, state.workspace);
  compositeInertias(state.model, state.workspace);
}

TEST(Centroidal, SumsOverTheLinks) {
  onRandomStates(121, [](RandomState& state, Random&) {
    sweep(state, state.q, state.qd);
    double m = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero(), linear = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < state.robot.links.size(); ++i) {
      const description::Link& link = state.robot.links[i];
      const int frame = static_cast<int>(i);
      if (!link.has_inertial || state.model.frames()[i].body < 0) continue;
      const Eigen::Vector3d c_W = framePose(state.model, state.workspace, frame) * link.centre_of_mass;
      m += link.mass;
      moment += link.mass * c_W;
      linear += link.mass * pointVelocity(state.model, state.workspace, frame, c_W);
    }
    EXPECT_NEAR(mass(state.model), m, 1e-12 * m);
    EXPECT_TRUE(near(centreOfMass(state.model, state.workspace), moment / m, 1e-12, 1));
    EXPECT_TRUE(near(momentum(state.model, state.workspace).head<3>(), linear, 1e-11, 1));
    const double kinetic = tactus::dynamics::kineticEnergy(state.robot, state.model, state.workspace);
    EXPECT_NEAR(kineticEnergy(state.model, state.workspace), kinetic, 1e-10 * kinetic);
    // The links of the base count in the sum over the description, and never change.
    Eigen::Vector3d base = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < state.robot.links.size(); ++i)
      if (state.robot.links[i].has_inertial && state.model.frames()[i].body < 0)
        base += state.robot.links[i].mass * (state.model.frames()[i].pose * state.robot.links[i].centre_of_mass);
    EXPECT_NEAR(potentialEnergy(state.model, state.workspace, state.gravity_W) - state.gravity_W.dot(base),
                tactus::dynamics::potentialEnergy(state.robot, state.model, state.workspace, state.gravity_W), 1e-9);
  });
}

TEST(Centroidal, JacobiansGiveVelocityAndMomentum) {
  onRandomStates(122, [](RandomState& state, Random&) {
    sweep(state, state.q, state.qd);
    Eigen::MatrixXd J(3, state.model.dof()), A(6, state.model.dof());
    centreOfMassJacobian(state.model, state.workspace, J);
    momentumMatrix(state.model, state.workspace, A);
    EXPECT_TRUE(near(J * state.qd, centreOfMassVelocity(state.model, state.workspace), 1e-11, 1));
    EXPECT_TRUE(near(A * state.qd, momentum(state.model, state.workspace), 1e-10, 1));
  });
}

TEST(Centroidal, RatesAreDifferencesInTime) {
  onRandomStates(123, [](RandomState& state, Random&) {
    Eigen::Vector3d c[2], v[2];
    Vector6d h[2];
    for (const int side : {0, 1}) {
      sweep(state, moved(state.model, state.q, state.qd, side ? step : -step), state.qd);
      c[side] = centreOfMass(state.model, state.workspace);
      v[side] = centreOfMassVelocity(state.model, state.workspace);
      h[side] = momentum(state.model, state.workspace);
    }
    sweep(state, state.q, state.qd);
    EXPECT_TRUE(near(centreOfMassVelocity(state.model, state.workspace), (c[1] - c[0]) / (2 * step), 1e-8, 1));
    EXPECT_TRUE(near(centreOfMassAccelerationBias(state.model, state.workspace), (v[1] - v[0]) / (2 * step), 1e-6, 1));
    EXPECT_TRUE(near(momentumRateBias(state.model, state.workspace), (h[1] - h[0]) / (2 * step), 1e-6, 1));
  });
}

TEST(Centroidal, AFloatingTreeKeepsItsMomentumAndEnergy) {
  Random random(124);
  for (int trial = 0; trial < 5; ++trial) {
    RandomState state(description::withFloatingBase(test_robots::lwr()), random);
    state.gravity_W.setZero();
    FreeSwing swing(state);
    sweep(state, state.q, state.qd);
    const Vector6d start = momentum(state.model, state.workspace);
    const double energy = kineticEnergy(state.model, state.workspace);
    const Eigen::Vector3d from = centreOfMass(state.model, state.workspace);
    const double h = 5e-4;
    constexpr int steps = 4000;
    for (int k = 0; k < steps; ++k) swing.step(h);
    sweep(state, state.q, state.qd);
    EXPECT_TRUE(near(momentum(state.model, state.workspace), start, 1e-7));
    EXPECT_NEAR(kineticEnergy(state.model, state.workspace), energy, 1e-7 * energy);
    EXPECT_TRUE(near(centreOfMass(state.model, state.workspace),
                     from + start.head<3>() / mass(state.model) * (h * steps), 1e-7, 1));
  }
}

}  // namespace
}  // namespace tactus::dynamics
