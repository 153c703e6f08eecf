#include "framework/dynamics/rnea.h"

#include <gtest/gtest.h>

#include "tests/dynamics/energy.h"
#include "tests/dynamics/random_state.h"

// Laws: gravity is the gradient of the potential energy, the power of all torques is the rate of the whole energy, and
// the sweeps agree with each other.  The energies are summed over the description's links.  Then a pendulum by hand.
namespace tactus::dynamics {
namespace {

using test_robots::Random;

TEST(Rnea, GravityTorqueIsTheGradientOfThePotentialEnergy) {
  constexpr double step = 1e-6;
  onRandomStates(41, [](RandomState& state, Random&) {
    Eigen::VectorXd gradient(state.model.dof()), torque(state.model.dof());
    for (int i = 0; i < state.model.dof(); ++i) {
      double energy[2];
      for (const int side : {0, 1}) {
        forwardKinematics(state.model, nudged(state.model, state.q, i, side ? step : -step), state.workspace);
        energy[side] = potentialEnergy(state.robot, state.model, state.workspace, state.gravity_W);
      }
      gradient[i] = (energy[1] - energy[0]) / (2 * step);
    }
    gravityTorque(state.model, state.q, state.gravity_W, state.workspace, torque);
    EXPECT_TRUE(near(torque, gradient, 1e-7, 1));
  });
}

TEST(Rnea, PowerOfTheTorqueIsTheRateOfTheEnergy) {
  constexpr double step = 1e-5;
  onRandomStates(42, [](RandomState& state, Random&) {
    Eigen::VectorXd tau(state.model.dof());
    rnea(state.model, state.q, state.qd, state.qdd, state.gravity_W, state.workspace, tau);
    double energy[2];
    for (const int side : {0, 1}) {
      const double t = side ? step : -step;
      const Eigen::VectorXd q = moved(state.model, state.q, state.qd + 0.5 * t * state.qdd, t);
      const Eigen::VectorXd qd = state.qd + t * state.qdd;
      forwardKinematics(state.model, q, state.workspace);
      forwardVelocities(state.model, qd, state.workspace);
      energy[side] = kineticEnergy(state.robot, state.model, state.workspace) +
                     potentialEnergy(state.robot, state.model, state.workspace, state.gravity_W);
    }
    const double scale = tau.cwiseAbs().dot(state.qd.cwiseAbs());
    EXPECT_NEAR(tau.dot(state.qd), (energy[1] - energy[0]) / (2 * step), 1e-6 * (1 + scale));
  });
}

TEST(Rnea, NonlinearEffectsAreInverseDynamicsWithoutAcceleration) {
  onRandomStates(43, [](RandomState& state, Random&) {
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(state.model.dof());
    Eigen::VectorXd tau = rest, bias = rest, gravity = rest;
    rnea(state.model, state.q, state.qd, rest, state.gravity_W, state.workspace, tau);
    nonlinearEffects(state.model, state.q, state.qd, state.gravity_W, state.workspace, bias);
    EXPECT_TRUE(near(bias, tau, 1e-12, 1));
    nonlinearEffects(state.model, state.q, rest, state.gravity_W, state.workspace, bias);
    gravityTorque(state.model, state.q, state.gravity_W, state.workspace, gravity);
    EXPECT_TRUE(near(gravity, bias, 1e-12, 1));
  });
}

TEST(Rnea, TorqueFollowsAccelerationAndGravityLinearlyAndVelocityQuadratically) {
  onRandomStates(44, [](RandomState& state, Random&) {
    const int dof = state.model.dof();
    const Eigen::VectorXd rest = Eigen::VectorXd::Zero(dof);
    const Eigen::Vector3d weightless = Eigen::Vector3d::Zero();
    Eigen::VectorXd all(dof), inertial(dof), coriolis(dof), twice_as_fast(dof), gravity(dof);
    rnea(state.model, state.q, state.qd, state.qdd, state.gravity_W, state.workspace, all);
    rnea(state.model, state.q, rest, state.qdd, weightless, state.workspace, inertial);
    rnea(state.model, state.q, state.qd, rest, weightless, state.workspace, coriolis);
    rnea(state.model, state.q, -2 * state.qd, rest, weightless, state.workspace, twice_as_fast);
    rnea(state.model, state.q, rest, rest, state.gravity_W, state.workspace, gravity);
    EXPECT_TRUE(near(all, inertial + coriolis + gravity, 1e-12, 1));
    EXPECT_TRUE(near(twice_as_fast, 4 * coriolis, 1e-12, 1));
  });
}

TEST(Rnea, PlanarArmOfTwoLinksByHand) {
  // Masses at the ends of links of lengths a and b, angles from straight down, gravity along −z: textbook equations.
  const double a = 0.7, b = 0.4, m1 = 2, m2 = 1.5, g = 9.81, tiny = 1e-15;
  description::Robot robot;
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY(), z = Eigen::Vector3d::UnitZ();
  test_robots::addLink(robot, "base", 0, 0 * z, 0 * z);
  test_robots::addLink(robot, "upper", m1, -a * z, Eigen::Vector3d::Constant(tiny));
  test_robots::addLink(robot, "lower", m2, -b * z, Eigen::Vector3d::Constant(tiny));
  test_robots::addJoint(robot, "shoulder", description::JointType::revolute, 0, 1, test_robots::pose({3, 2, 1}), y);
  test_robots::addJoint(robot, "elbow", description::JointType::revolute, 1, 2, test_robots::pose(-a * z), y);
  const Model model(robot, MassPolicy::kinematics_only);           // a point mass has no inertia of its own
  Workspace workspace(model);
  const Eigen::VectorXd q = Eigen::Vector2d(0.6, -1.1), qd = Eigen::Vector2d(1.3, 0.8), qdd = Eigen::Vector2d(-2, 3);
  Eigen::VectorXd tau(2);
  rnea(model, q, qd, qdd, {0, 0, -g}, workspace, tau);

  const double c2 = std::cos(q[1]), s2 = std::sin(q[1]), s1 = std::sin(q[0]), s12 = std::sin(q[0] + q[1]);
  const double m11 = m1 * a * a + m2 * (a * a + b * b + 2 * a * b * c2), m12 = m2 * (b * b + a * b * c2);
  const double coriolis = m2 * a * b * s2;
  EXPECT_NEAR(tau[0], m11 * qdd[0] + m12 * qdd[1] - coriolis * (2 * qd[0] * qd[1] + qd[1] * qd[1]) +
                          (m1 + m2) * g * a * s1 + m2 * g * b * s12, 1e-12);
  EXPECT_NEAR(tau[1], m12 * qdd[0] + m2 * b * b * qdd[1] + coriolis * qd[0] * qd[0] + m2 * g * b * s12, 1e-12);
}

}  // namespace
}  // namespace tactus::dynamics
