#include "framework/description/robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/dynamics/robots.h"

namespace tactus::description {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Robot named(std::initializer_list<const char*> links) {
  Robot robot;
  for (const char* name : links) {
    robot.links.emplace_back();
    robot.links.back().name = name;
  }
  return robot;
}

void join(Robot& robot, const char* name, JointType type, const char* parent, const char* child) {
  test_robots::addJoint(robot, name, type, robot.linkIndex(parent), robot.linkIndex(child),
                        Eigen::Isometry3d::Identity());
}

TEST(Robot, MovingJointsComeDepthFirstInFileOrder) {
  // base ─ a ─ a1 (fixed) ─ a2        The file names the branches crosswise, and children before parents.
  //      └ b ─ b1
  Robot robot = named({"a2", "b1", "a1", "b", "base", "a"});
  robot.root = robot.linkIndex("base");
  join(robot, "to a2", JointType::prismatic, "a1", "a2");
  join(robot, "to b", JointType::revolute, "base", "b");
  join(robot, "to a", JointType::revolute, "base", "a");
  join(robot, "to a1", JointType::fixed, "a", "a1");
  join(robot, "to b1", JointType::revolute, "b", "b1");
  EXPECT_THAT(robot.movingJoints(), ElementsAre(1, 4, 2, 0));
}

TEST(Robot, EveryMovingJointComesOnceAndAfterThoseThatCarryIt) {
  test_robots::Random random(1);
  for (int dof = 1; dof <= 40; ++dof) {
    const Robot robot = test_robots::randomTree(random, dof);
    const std::vector<int> moving = robot.movingJoints();
    ASSERT_EQ(static_cast<int>(moving.size()), dof);
    std::vector<int> position(robot.joints.size(), -1);
    for (int k = 0; k < dof; ++k) {
      EXPECT_NE(robot.joints[moving[k]].type, JointType::fixed);
      EXPECT_EQ(position[moving[k]], -1);
      position[moving[k]] = k;
    }
    for (int k = 0; k < dof; ++k) {
      int link = robot.joints[moving[k]].parent;                   // up to the base
      while (link != robot.root) {
        const auto carrier = std::ranges::find(robot.joints, link, &Joint::child);
        ASSERT_NE(carrier, robot.joints.end());
        EXPECT_LT(position[carrier - robot.joints.begin()], k);
        link = carrier->parent;
      }
    }
  }
}

TEST(Robot, ALoopEnds) {
  Robot robot = named({"a", "b"});
  join(robot, "there", JointType::revolute, "a", "b");
  join(robot, "back", JointType::revolute, "b", "a");
  EXPECT_THAT(robot.movingJoints(), ElementsAre(0, 1));
}

TEST(Robot, NothingMovesWithoutLinks) { EXPECT_THAT(Robot().movingJoints(), IsEmpty()); }

TEST(Robot, FindsByName) {
  const Robot robot = test_robots::lwrAllegro();
  EXPECT_EQ(robot.links[robot.linkIndex("thumb_tip")].name, "thumb_tip");
  EXPECT_EQ(robot.joints[robot.jointIndex("a3")].name, "a3");
  EXPECT_EQ(robot.linkIndex("a3"), -1);
  EXPECT_EQ(robot.jointIndex("7"), -1);
}

}  // namespace
}  // namespace tactus::description
