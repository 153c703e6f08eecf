#include "framework/dynamics/configuration.h"

#include <gtest/gtest.h>

#include "tests/dynamics/random_state.h"

// The space of configurations: integrate and difference undo each other, one-parameter motions add up, and quaternions
// neither drift nor spoil anything when they come in unnormalised.
namespace tactus::dynamics {
namespace {

using test_robots::Random;

TEST(Configuration, DifferenceUndoesIntegrate) {
  onRandomStates(131, [](RandomState& state, Random& random) {
    const Eigen::VectorXd v = test_robots::uniformVector(random, state.model.dof(), 1.5);  // turns below π
    Eigen::VectorXd back(state.model.dof());
    difference(state.model, state.q, moved(state.model, state.q, v), back);
    EXPECT_TRUE(near(back, v, 1e-13));
    difference(state.model, state.q, state.q, back);
    EXPECT_LE(back.norm(), 1e-15);
  });
}

TEST(Configuration, IntegrateUndoesDifference) {
  onRandomStates(132, [](RandomState& state, Random& random) {
    const Eigen::VectorXd other = randomConfiguration(state.model, random);
    Eigen::VectorXd v(state.model.dof());
    difference(state.model, state.q, other, v);
    const Eigen::VectorXd reached = moved(state.model, state.q, v);
    forwardKinematics(state.model, other, state.workspace);
    std::vector<Eigen::Matrix4d> poses;
    for (size_t i = 0; i < state.model.frames().size(); ++i)
      poses.push_back(framePose(state.model, state.workspace, static_cast<int>(i)).matrix());
    forwardKinematics(state.model, reached, state.workspace);      // q and −q are one rotation
    for (size_t i = 0; i < poses.size(); ++i)
      EXPECT_TRUE(near(framePose(state.model, state.workspace, static_cast<int>(i)).matrix(), poses[i], 1e-12));
  });
}

TEST(Configuration, AMotionInTwoHalvesIsTheWhole) {
  onRandomStates(133, [](RandomState& state, Random&) {
    const Eigen::VectorXd whole = moved(state.model, state.q, state.qd);
    EXPECT_TRUE(near(moved(state.model, moved(state.model, state.q, state.qd, 0.5), state.qd, 0.5), whole, 1e-13));
    Eigen::VectorXd in_place = state.q;
    integrate(state.model, in_place, state.qd, in_place);
    EXPECT_EQ(in_place, whole);
  });
}

TEST(Configuration, PositionRatesAreDerivativesOfIntegrate) {
  constexpr double step = 1e-6;
  onRandomStates(134, [](RandomState& state, Random&) {
    Eigen::VectorXd rates(state.model.positionCount());
    positionRates(state.model, state.q, state.qd, rates);
    EXPECT_TRUE(near(rates, (moved(state.model, state.q, state.qd, step) - moved(state.model, state.q, state.qd, -step)) /
                                (2 * step), 1e-8, 1));
  });
}

TEST(Configuration, QuaternionsOfAnyLengthAreTheSameRotation) {
  onRandomStates(135, [](RandomState& state, Random& random) {
    Eigen::VectorXd stretched = state.q;
    for (const Model::Body& body : state.model.bodies())
      if (body.motion == Motion::ball_x) stretched.segment<4>(body.position) *= test_robots::uniform(random, 1e-3, 1e3);
    const int last = static_cast<int>(state.model.frames().size()) - 1;
    forwardKinematics(state.model, state.q, state.workspace);
    const Eigen::Matrix4d pose = framePose(state.model, state.workspace, last).matrix();
    forwardKinematics(state.model, stretched, state.workspace);
    EXPECT_TRUE(near(framePose(state.model, state.workspace, last).matrix(), pose, 1e-12));
    normalise(state.model, stretched);
    EXPECT_TRUE(near(stretched, state.q, 1e-13));
  });
}

TEST(Configuration, AMillionStepsDoNotDrift) {
  description::Robot robot;
  test_robots::addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  test_robots::addLink(robot, "ball", 1, Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  test_robots::addJoint(robot, "joint", description::JointType::spherical, 0, 1, Eigen::Isometry3d::Identity());
  const Model model(robot);
  Eigen::VectorXd q = model.neutral();
  const Eigen::VectorXd v = Eigen::Vector3d(0.3, -0.2, 0.5) * 1e-3;
  for (int k = 0; k < 1000000; ++k) integrate(model, q, v, q);
  EXPECT_NEAR(q.norm(), 1, 1e-15);
  Eigen::VectorXd back(3);
  difference(model, moved(model, model.neutral(), v, 1e6), q, back);
  EXPECT_LE(back.norm(), 1e-9);                                    // 616 rad: the sum of a million roundings
}

TEST(Configuration, BrokenQuaternionsBecomeTheIdentity) {
  description::Robot robot;
  test_robots::addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  test_robots::addLink(robot, "ball", 1, Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  test_robots::addJoint(robot, "joint", description::JointType::spherical, 0, 1, Eigen::Isometry3d::Identity());
  const Model model(robot);
  for (const double broken : {0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    Eigen::VectorXd q = Eigen::VectorXd::Constant(4, broken);
    normalise(model, q);
    EXPECT_EQ(q, model.neutral());
  }
  Workspace workspace(model);
  forwardKinematics(model, Eigen::VectorXd::Zero(4), workspace);
  EXPECT_EQ(framePose(model, workspace, 1).matrix(), Eigen::Matrix4d::Identity());
}

}  // namespace
}  // namespace tactus::dynamics
