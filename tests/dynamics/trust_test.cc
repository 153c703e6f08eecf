#include <gtest/gtest.h>

#include "framework/description/combine.h"
#include "framework/dynamics/centroidal.h"
#include "framework/dynamics/crba.h"
#include "framework/dynamics/derivatives.h"
#include "framework/dynamics/rnea.h"
#include "tests/dynamics/free_swing.h"

// Laws that need several algorithms at once, and the corners where numbers get hard: long swings, masses nine orders of
// magnitude apart, stretched arms, a base far from the origin.  Each says how well the dynamics stand there.
namespace tactus::dynamics {
namespace {

using test_robots::Random;

// In coordinates that are rates of q, c = C q̇ with Christoffel's C, and ∂c/∂q̇ = 2 C.
TEST(Trust, RateOfTheMassMatrixLessTwiceCoriolisIsSkew) {
  constexpr double step = 1e-5;
  int tried = 0;
  onRandomStates(171, [&](RandomState& state, Random&) {
    for (const Model::Joint& joint : state.model.joints())
      if (joint.type == description::JointType::spherical || joint.type == description::JointType::floating) return;
    ++tried;
    const int dof = state.model.dof();
    Eigen::MatrixXd M[2];
    for (const int side : {0, 1}) {
      M[side].setZero(dof, dof);
      crba(state.model, moved(state.model, state.q, state.qd, side ? step : -step), state.workspace, M[side]);
    }
    DynamicsDerivatives derivatives(state.model);
    derivatives.computeInverse(state.q, state.qd, Eigen::VectorXd::Zero(dof), Eigen::Vector3d::Zero(), state.workspace);
    const Eigen::MatrixXd rate = (M[1] - M[0]) / (2 * step), N = rate - derivatives.torqueByVelocity();
    EXPECT_TRUE(near(N, -N.transpose(), 1e-7, rate.cwiseAbs().maxCoeff() + 1e-2 * M[0].cwiseAbs().maxCoeff()));
  });
  EXPECT_GE(tried, 20);
}

/// Change of the whole energy over a free swing, by the classical Runge–Kutta method with steps h, over what kinetic
/// energy came and went.
double energyDrift(const description::Robot& robot, std::uint64_t seed, double duration, double h) {
  Random random(seed);
  RandomState state(robot, random);
  FreeSwing swing(state);
  const auto energies = [&] {
    forwardKinematics(state.model, state.q, state.workspace);
    forwardVelocities(state.model, state.qd, state.workspace);
    worldInertias(state.model, state.workspace);
    compositeInertias(state.model, state.workspace);
    return Eigen::Vector2d(kineticEnergy(state.model, state.workspace),
                           potentialEnergy(state.model, state.workspace, state.gravity_W));
  };
  state.gravity_W = {0, 0, -9.81};
  state.qd *= 0.5;
  const Eigen::Vector2d start = energies();
  double exchanged = 0;
  const int steps = static_cast<int>(std::lround(duration / h));
  for (int k = 0; k < steps; ++k) {
    swing.step(h);
    if (k % 20 == 0) exchanged = std::max(exchanged, std::abs(energies()[0] - start[0]));
  }
  return std::abs(energies().sum() - start.sum()) / exchanged;
}

description::Robot ballPendulum() {
  Random random(172);
  description::Robot robot;
  test_robots::addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  for (const char* name : {"upper", "lower"}) {
    const int parent = static_cast<int>(robot.links.size()) - 1;
    const int child = test_robots::addLink(robot, name, 1, {0, 0, -0.3}, {0.02, 0.03, 0.02});
    test_robots::addJoint(robot, std::string("to ") + name, description::JointType::spherical, parent, child,
                          test_robots::pose({0, 0, parent ? -0.6 : 0.0}));
  }
  return robot;
}

TEST(Trust, EnergyIsKeptOverTenSecondsToTheOrderOfTheIntegrator) {
  description::Robot coupled = test_robots::lwr();
  coupled.joints[3].mimic = description::Mimic{1, -1, 0.2};
  for (const description::Robot& robot : {test_robots::lwr(), ballPendulum(), coupled}) {
    const double coarse = energyDrift(robot, 173, 10, 2e-3), fine = energyDrift(robot, 173, 10, 1e-3);
    EXPECT_LE(fine, 1e-5) << robot.name;
    EXPECT_LE(fine, coarse / 8) << robot.name;                     // 16 for small steps, 32 where errors cancel
  }
}

TEST(Trust, MassesNineOrdersApart) {
  Random random(174);
  double worst_forward = 0, worst_factor = 0;
  for (int trial = 0; trial < 200; ++trial) {
    description::Robot robot = test_robots::randomTree(random, 1 + trial % 30, true);
    for (description::Link& link : robot.links) {
      if (!link.has_inertial) continue;
      const double scale = std::pow(10, test_robots::uniform(random, -6, 3)) / link.mass;
      link.mass *= scale;
      link.inertia *= scale;
    }
    for (description::Joint& joint : robot.joints) joint.rotor_inertia = 0;
    RandomState state(robot, random);
    ForwardDynamics forward(state.model);
    Eigen::VectorXd tau(state.model.dof()), qdd(state.model.dof()), tau_again(state.model.dof());
    rnea(state.model, state.q, state.qd, state.qdd, state.gravity_W, state.workspace, tau);
    forward.compute(state.q, state.qd, tau, state.gravity_W, state.workspace, qdd);
    ASSERT_TRUE(qdd.allFinite());
    rnea(state.model, state.q, state.qd, qdd, state.gravity_W, state.workspace, tau_again);
    worst_forward = std::max(worst_forward, (tau_again - tau).norm() / tau.norm());
    Eigen::MatrixXd M(state.model.dof(), state.model.dof());
    crba(state.model, state.q, state.workspace, M);
    MassMatrixFactor factor(state.model);
    ASSERT_TRUE(factor.compute(M));
    Eigen::VectorXd x = tau;
    factor.solveInPlace(x);
    worst_factor = std::max(worst_factor, (M * x - tau).norm() / tau.norm());
  }
  std::cout << "masses from 1e-6 to 1e3 kg: torques return to " << worst_forward << " (ABA), " << worst_factor
            << " (factor of M)\n";
  EXPECT_LE(worst_forward, 1e-9);
  EXPECT_LE(worst_factor, 1e-9);
}

TEST(Trust, StretchedArmsAreOrdinary) {
  const Model model(test_robots::lwr());
  Workspace workspace(model);
  const Eigen::VectorXd q = Eigen::VectorXd::Zero(7), qd = Eigen::VectorXd::Constant(7, 0.5);
  Eigen::VectorXd tau(7), qdd(7);
  rnea(model, q, qd, Eigen::VectorXd::Ones(7), {0, 0, -9.81}, workspace, tau);
  ForwardDynamics forward(model);
  forward.compute(q, qd, tau, {0, 0, -9.81}, workspace, qdd);
  EXPECT_TRUE(near(qdd, Eigen::VectorXd::Ones(7), 1e-11));
}

// World axes about the world origin cost digits far from it: errors of moments of inertia grow as ε (distance / size)².
TEST(Trust, AFarBaseCostsKnownDigits) {
  Random random(175);
  RandomState state(description::withFloatingBase(test_robots::lwrAllegro()), random);
  const int dof = state.model.dof();
  Eigen::MatrixXd M(dof, dof), M_far(dof, dof);
  state.q.head<3>().setZero();
  crba(state.model, state.q, state.workspace, M);
  for (const double distance : {1.0, 10.0, 100.0, 1e3, 1e4}) {
    Eigen::VectorXd far = state.q;
    far[0] = distance;
    crba(state.model, far, state.workspace, M_far);
    const Eigen::VectorXd scale = M.diagonal().cwiseSqrt().cwiseInverse();  // each joint by its own inertia
    const double error = (scale.asDiagonal() * (M_far - M) * scale.asDiagonal()).cwiseAbs().maxCoeff();
    std::cout << "base " << distance << " m away: mass matrix to " << error << "\n";
    EXPECT_LE(error, 2e-11 * (1 + distance * distance));
  }
}

}  // namespace
}  // namespace tactus::dynamics
