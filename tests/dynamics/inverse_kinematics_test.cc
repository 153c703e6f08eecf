#include "framework/dynamics/inverse_kinematics.h"

#include <gtest/gtest.h>

#include "tests/dynamics/random_state.h"

// Poses that a random configuration has are found again from another one; what is out of reach is approached and said.
namespace tactus::dynamics {
namespace {

using test_robots::Random;

TEST(InverseKinematics, FindsPosesThatExist) {
  int tried = 0, reached = 0;
  onRandomStates(141, [&](RandomState& state, Random& random) {
    const int frame = static_cast<int>(state.model.frames().size()) - 1;
    forwardKinematics(state.model, state.q, state.workspace);
    const Eigen::Isometry3d X_WF = framePose(state.model, state.workspace, frame);
    const Eigen::VectorXd start = moved(state.model, state.q, test_robots::uniformVector(random, state.model.dof(), 0.3));
    const auto found = inverseKinematics(state.model, {{frame, X_WF.translation(), X_WF.linear()}}, start);
    ++tried;
    reached += found.reached;
    forwardKinematics(state.model, found.q, state.workspace);
    const Eigen::Isometry3d at = framePose(state.model, state.workspace, frame);
    if (found.reached) {
      EXPECT_TRUE(near(at.matrix(), X_WF.matrix(), 1e-9));
    }
  });
  EXPECT_GE(reached, tried * 9 / 10) << "of " << tried;
}

TEST(InverseKinematics, StopsAtLimitsAndSaysSo) {
  description::Robot robot = test_robots::lwr();
  for (description::Joint& joint : robot.joints) {
    joint.lower = -0.2;
    joint.upper = 0.2;
  }
  const Model model(robot);
  const auto found = inverseKinematics(model, {{model.frameIndex("7"), Eigen::Vector3d(0.5, 0.2, 0.4), {}}}, model.neutral());
  EXPECT_FALSE(found.reached);
  EXPECT_GT(found.error, 0.1);
  EXPECT_LE(found.q.cwiseAbs().maxCoeff(), 0.2);
}

TEST(InverseKinematics, OutOfReachIsTheArmStretchedTowardsIt) {
  const Model model(test_robots::lwr());
  const Eigen::Vector3d far(3, 0, 0.3105);                         // level with the shoulder
  const auto found = inverseKinematics(model, {{model.frameIndex("7"), far, {}}},
                                       Eigen::VectorXd::Constant(7, 0.3), {.max_iterations = 2000});
  EXPECT_FALSE(found.reached);
  EXPECT_NEAR(found.error, 3 - 0.868, 1e-5);
}

TEST(InverseKinematics, SeveralTargetsAtOnce) {
  Random random(142);
  RandomState state(test_robots::lwrAllegro(), random);
  std::vector<FrameTarget> targets;
  const Eigen::VectorXd goal = test_robots::uniformVector(random, 23, 0.5);
  forwardKinematics(state.model, goal, state.workspace);
  for (const char* tip : {"index_tip", "middle_tip", "ring_tip", "thumb_tip"}) {
    const int frame = state.model.frameIndex(tip);
    targets.push_back({frame, framePose(state.model, state.workspace, frame).translation(), {}});
  }
  const auto found = inverseKinematics(state.model, targets, Eigen::VectorXd::Zero(23));
  EXPECT_TRUE(found.reached) << found.error;
}

TEST(InverseKinematics, SaysWhatIsWrong) {
  const Model model(test_robots::lwr());
  const auto message = [&](int frame, int size) {
    try {
      inverseKinematics(model, {{frame, Eigen::Vector3d::Zero(), {}}}, Eigen::VectorXd::Zero(size));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message(0, 6), "inverseKinematics: start has 6 numbers, the model has 7 positions");
  EXPECT_EQ(message(8, 7), "inverseKinematics: the model has no frame 8");
}

}  // namespace
}  // namespace tactus::dynamics
