#include "framework/description/combine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "framework/dynamics/crba.h"
#include "tests/dynamics/random_state.h"

namespace tactus::dynamics {
namespace {

using test_robots::Random;

TEST(Combine, TwoArmsMoveAsEachAlone) {
  Random random(151);
  const Eigen::Isometry3d left = test_robots::pose({0, 0.5, 1}, {0.3, 0, 0}), right = test_robots::pose({0, -0.5, 1});
  description::Robot arm = test_robots::lwr();
  arm.joints[6].mimic = description::Mimic{1, 0.5, 0.1};
  arm.skin = {"7"};
  arm.joint_groups.push_back({"arm", {"a1", "a2"}, {}});
  const description::Robot both =
      description::combine("two arms", {{"left", arm, left}, {"right", test_robots::lwr(), right}});
  EXPECT_THAT(both.skin, ::testing::ElementsAre("left/7"));
  EXPECT_EQ(both.joint_groups[0].name, "left/arm");
  EXPECT_THAT(both.joint_groups[0].members, ::testing::ElementsAre("left/a1", "left/a2"));
  RandomState two(both, random), one(arm, random);
  ASSERT_EQ(two.model.dof(), 13);
  one.q = two.q.head(6);
  forwardKinematics(two.model, two.q, two.workspace);
  forwardKinematics(one.model, one.q, one.workspace);
  const Eigen::Isometry3d X = framePose(two.model, two.workspace, two.model.frameIndex("left/7"));
  EXPECT_TRUE(near(X.matrix(), (left * framePose(one.model, one.workspace, one.model.frameIndex("7"))).matrix(), 1e-13));
  Eigen::MatrixXd M(13, 13), M_one(6, 6);
  crba(two.model, two.q, two.workspace, M);
  crba(one.model, one.q, one.workspace, M_one);
  EXPECT_TRUE(near(M.topLeftCorner(6, 6), M_one, 1e-12));
  EXPECT_EQ(M.topRightCorner(6, 7).cwiseAbs().maxCoeff(), 0);
}

TEST(Combine, LinksThatTouchEachOtherStillDo) {
  description::Robot arm;
  arm.links.resize(3);
  arm.self_contact = {{0, 2}};
  const description::Robot two = description::combine("two", {{"a", arm}, {"b", arm}});
  ASSERT_EQ(two.self_contact.size(), 2u);
  EXPECT_EQ(two.self_contact[0], (description::LinkPair{1, 3}));
  EXPECT_EQ(two.self_contact[1], (description::LinkPair{4, 6}));
}

TEST(Combine, NamesOfMembersDiffer) {
  try {
    description::combine("pair", {{"arm", test_robots::lwr()}, {"arm", test_robots::lwr()}});
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "two members of 'pair' are called 'arm'");
  }
}

TEST(FloatingBase, CarriesTheWholeRobot) {
  const Model model(description::withFloatingBase(test_robots::lwr(), "root"));
  EXPECT_EQ(model.dof(), 13);
  EXPECT_EQ(model.positionCount(), 14);
  EXPECT_EQ(model.jointNames()[3], "root.wx");
  Workspace workspace(model);
  Eigen::VectorXd q = model.neutral();
  q.head<3>() << 1, 2, 3;
  forwardKinematics(model, q, workspace);
  const Eigen::Vector3d tip = framePose(model, workspace, model.frameIndex("7")).translation();
  EXPECT_TRUE(near(tip, Eigen::Vector3d(1, 2, 3 + 1.1785), 1e-14));
}

}  // namespace
}  // namespace tactus::dynamics
