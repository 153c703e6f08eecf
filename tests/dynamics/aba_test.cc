#include "framework/dynamics/aba.h"

#include <gtest/gtest.h>

#include "framework/dynamics/rnea.h"
#include "tests/dynamics/energy.h"
#include "tests/dynamics/free_swing.h"

// Laws: the articulated-body algorithm undoes the Newton–Euler one, and a free swing keeps its energy.  Then a pendulum
// whose period is known, and free fall.
namespace tactus::dynamics {
namespace {

using test_robots::Random;

TEST(Aba, UndoesInverseDynamics) {
  onRandomStates(61, [](RandomState& state, Random&) {
    Eigen::VectorXd tau(state.model.dof()), qdd(state.model.dof());
    rnea(state.model, state.q, state.qd, state.qdd, state.gravity_W, state.workspace, tau);
    if (state.model.coupled()) return;                             // see forward_dynamics_test.cc
    aba(state.model, state.q, state.qd, tau, state.gravity_W, state.workspace, qdd);
    EXPECT_TRUE(near(qdd, state.qdd, 1e-9));
    Eigen::VectorXd tau_again(state.model.dof());
    rnea(state.model, state.q, state.qd, qdd, state.gravity_W, state.workspace, tau_again);
    EXPECT_TRUE(near(tau_again, tau, 1e-11));
  });
}

TEST(Aba, AFreeSwingKeepsItsEnergy) {
  Random random(62);
  for (int trial = 0; trial < 10; ++trial) {
    RandomState state(test_robots::randomTree(random, 1 + trial, trial % 2 == 1), random);
    const auto energies = [&] {
      forwardKinematics(state.model, state.q, state.workspace);
      forwardVelocities(state.model, state.qd, state.workspace);
      return Eigen::Vector2d(kineticEnergy(state.robot, state.model, state.workspace),
                             potentialEnergy(state.robot, state.model, state.workspace, state.gravity_W));
    };
    const Eigen::Vector2d start = energies();
    double exchanged = 0;
    FreeSwing swing(state);
    for (int step = 0; step < 2000; ++step) {
      swing.step(2e-4);
      exchanged = std::max(exchanged, std::abs(energies()[0] - start[0]));
    }
    EXPECT_GT(exchanged, 0.1);                                     // J: it did swing
    EXPECT_NEAR(energies().sum(), start.sum(), 1e-7 * exchanged) << "trial " << trial;
  }
}

TEST(Aba, PendulumHasThePeriodOfTheEllipticIntegral) {
  const double m = 1.3, l = 0.45, inertia = 0.02, g = 9.81, amplitude = 2;
  description::Robot robot;
  test_robots::addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  test_robots::addLink(robot, "bob", m, {0, 0, -l}, {inertia, inertia, inertia});
  test_robots::addJoint(robot, "pivot", description::JointType::revolute, 0, 1, test_robots::pose({1, 2, 3}),
                        Eigen::Vector3d::UnitX());
  Random random(63);
  RandomState state(robot, random);
  state.gravity_W = {0, 0, -g};
  state.q << amplitude;
  state.qd << 0;
  // T = 2π / (ω₀ agm(1, cos(θ₀/2))), ω₀² = m g l / (I + m l²).
  double a = 1, b = std::cos(amplitude / 2);
  for (int k = 0; k < 8; ++k) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  const double period = 2 * std::numbers::pi / (std::sqrt(m * g * l / (inertia + m * l * l)) * a);
  FreeSwing swing(state);
  for (int step = 0; step < 1000; ++step) swing.step(period / 2000);
  EXPECT_NEAR(state.q[0], -amplitude, 1e-9);                       // the other side, after half a period
  for (int step = 0; step < 1000; ++step) swing.step(period / 2000);
  EXPECT_NEAR(state.q[0], amplitude, 1e-9);
  EXPECT_NEAR(state.qd[0], 0, 1e-8);
}

TEST(Aba, ASliderFallsFreely) {
  description::Robot robot;
  test_robots::addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  test_robots::addLink(robot, "weight", 2, {0.1, 0.2, 0.3}, {0.1, 0.1, 0.1});
  test_robots::addJoint(robot, "rail", description::JointType::prismatic, 0, 1, test_robots::pose({1, 2, 3}),
                        Eigen::Vector3d(0.6, 0, 0.8));
  const Model model(robot);
  Workspace workspace(model);
  Eigen::VectorXd qdd(1);
  aba(model, Eigen::VectorXd::Constant(1, 0.7), Eigen::VectorXd::Constant(1, -3), Eigen::VectorXd::Constant(1, 5),
      {0, 0, -9.81}, workspace, qdd);
  EXPECT_NEAR(qdd[0], 5.0 / 2 - 9.81 * 0.8, 1e-12);
}

}  // namespace
}  // namespace tactus::dynamics
