#include "framework/dynamics/check_robot.h"

#include <gtest/gtest.h>

#include <functional>

#include "framework/dynamics/model.h"
#include "tests/dynamics/robots.h"

// Each fault is put into a sound robot whose parts all stand at known lines; text and place of the message are checked.
namespace tactus::dynamics {
namespace {

using description::JointType;
using description::Robot;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// base ─(shoulder)─ upper ─(elbow)─ lower ─(wrist, fixed)─ hand; links stand at lines 10, 11, …, joints at 20, 21, …
Robot soundRobot() {
  const Eigen::Vector3d moments(0.02, 0.02, 0.01);
  Robot robot;
  robot.name = "sound";
  robot.place = {"robot.urdf", 1, 1};
  int parent = test_robots::addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const auto add = [&](const char* link, const char* joint, JointType type) {
    const int child = test_robots::addLink(robot, link, 1, {0, 0, 0.1}, moments);
    test_robots::addJoint(robot, joint, type, parent, child, test_robots::pose({0, 0, 0.3}));
    parent = child;
  };
  add("upper", "shoulder", JointType::revolute);
  add("lower", "elbow", JointType::prismatic);
  add("hand", "wrist", JointType::fixed);
  for (size_t i = 0; i < robot.links.size(); ++i) robot.links[i].place = {"robot.urdf", 10 + static_cast<int>(i), 3};
  for (size_t i = 0; i < robot.joints.size(); ++i) robot.joints[i].place = {"robot.urdf", 20 + static_cast<int>(i), 3};
  return robot;
}

void expectError(const std::function<void(Robot&)>& damage, const std::string& message, int line,
                 MassPolicy policy = MassPolicy::required) {
  Robot robot = soundRobot();
  damage(robot);
  try {
    const Model model(robot, policy);
    FAIL() << "not refused; expected: " << message;
  } catch (const ModelError& error) {
    EXPECT_EQ(error.what(), message);
    EXPECT_EQ(error.place.line, line);
    EXPECT_EQ(error.place.file, line > 0 ? "robot.urdf" : "");
  }
}

TEST(CheckRobot, ASoundRobotPasses) { EXPECT_EQ(Model(soundRobot()).dof(), 2); }

TEST(CheckRobot, MovingBodyWithoutMass) {
  const auto weightless = [](Robot& robot) {
    robot.links[1].has_inertial = false;
    robot.links[1].mass = 0;
  };
  expectError(weightless,
              "link 'upper' moves but has no mass: give it an <inertial> with mass and inertia, or join it by a fixed "
              "joint to a link that has them",
              11);
  Robot robot = soundRobot();
  weightless(robot);
  EXPECT_EQ(Model(robot, MassPolicy::kinematics_only).dof(), 2);
}

TEST(CheckRobot, ARotorAloneIsNoMass) {
  expectError(
      [](Robot& robot) {
        robot.links[1].has_inertial = false;
        robot.joints[0].rotor_inertia = 0.01;
      },
      "link 'upper' moves but has no mass: give it an <inertial> with mass and inertia, or join it by a fixed joint to "
      "a link that has them",
      11);
}

TEST(CheckRobot, AMasslessLinkFixedToAMassiveOneIsLegal) {
  Robot robot = soundRobot();
  robot.links[2].has_inertial = false;                             // "lower" is carried by a joint, "hand" has the mass
  EXPECT_EQ(Model(robot).bodies()[1].inertia.mass, 1);
  robot = soundRobot();
  robot.links[3].has_inertial = false;
  EXPECT_EQ(Model(robot).bodies()[1].inertia.mass, 1);
}

TEST(CheckRobot, Structure) {
  expectError([](Robot& robot) { robot.links.clear(), robot.joints.clear(); }, "the robot 'sound' has no links", 1);
  expectError([](Robot& robot) { robot.links[3].name = "upper"; },
              "two links are named 'upper' (line 11): give one of them another name", 13);
  expectError([](Robot& robot) { robot.joints[2].name = "shoulder"; },
              "two joints are named 'shoulder' (line 20): give one of them another name", 22);
  expectError([](Robot& robot) { robot.joints[1].parent = -1; },
              "joint 'elbow' has no parent link: name one of the robot's links", 21);
  expectError([](Robot& robot) { robot.joints[1].child = 17; },
              "joint 'elbow' has no child link: name one of the robot's links", 21);
  expectError([](Robot& robot) { robot.joints[1].parent = robot.joints[1].child; },
              "joint 'elbow' joins link 'lower' to itself: its parent and child must differ", 21);
  expectError([](Robot& robot) { robot.joints[2].child = 1; },
              "link 'upper' is the child of two joints, 'shoulder' and 'wrist': a robot is a tree, remove one of them",
              22);
  expectError([](Robot& robot) { robot.joints.pop_back(); },
              "the robot has two roots, 'base' and 'hand': join the second one to the tree", 13);
  expectError([](Robot& robot) { robot.root = 2; }, "the root of the robot is link 'base', which no joint carries", 10);
}

TEST(CheckRobot, Loops) {
  const auto joinHandToBase = [](Robot& robot) {
    test_robots::addJoint(robot, "back", JointType::revolute, 3, 0, Eigen::Isometry3d::Identity());
  };
  expectError(joinHandToBase,
              "every link is the child of a joint, so the joints form a loop: one link must be the base", 20);
  expectError([](Robot& robot) { robot.joints[0].parent = 3; },
              "link 'upper' hangs in a loop of joints that never reaches the base 'base': open the loop", 11);
}

TEST(CheckRobot, LinkNumbers) {
  expectError([](Robot& robot) { robot.links[1].mass = nan; }, "link 'upper': its mass is not a finite number", 11);
  expectError([](Robot& robot) { robot.links[1].mass = -0.5; },
              "link 'upper': its mass is -0.5 kg; a mass cannot be negative", 11);
  expectError([](Robot& robot) { robot.links[2].centre_of_mass.y() = description::infinity; },
              "link 'lower': its centre of mass is not made of finite numbers", 12);
  expectError([](Robot& robot) { robot.links[3].inertia(1, 2) = nan; },
              "link 'hand': its inertia is not made of finite numbers", 13);
  expectError([](Robot& robot) { robot.links[3].inertia(1, 2) = 0.001; },
              "link 'hand': its inertia matrix is not symmetric", 13);
}

TEST(CheckRobot, JointNumbers) {
  expectError([](Robot& robot) { robot.joints[2].origin.translation().x() = nan; },
              "joint 'wrist': its origin is not made of finite numbers", 22);
  expectError([](Robot& robot) { robot.joints[2].origin.linear() *= 2; },
              "joint 'wrist': the orientation of its origin is not a rotation", 22);
  expectError([](Robot& robot) { robot.joints[0].axis = {0, 0, 2}; },
              "joint 'shoulder': its axis must have length 1, not 2", 20);
  expectError([](Robot& robot) { robot.joints[0].axis.setZero(); },
              "joint 'shoulder': its axis must have length 1, not 0", 20);
  expectError([](Robot& robot) { robot.joints[0].lower = nan; }, "joint 'shoulder': its limits are not numbers", 20);
  expectError([](Robot& robot) { robot.joints[1].lower = 2, robot.joints[1].upper = -1.5; },
              "joint 'elbow': its lower limit 2 lies above its upper limit -1.5", 21);
  expectError([](Robot& robot) { robot.joints[1].effort = -3; },
              "joint 'elbow': its effort limit is -3; it must be a number of at least 0", 21);
  expectError([](Robot& robot) { robot.joints[1].velocity = nan; },
              "joint 'elbow': its velocity limit is nan; it must be a number of at least 0", 21);
  expectError([](Robot& robot) { robot.joints[1].damping = description::infinity; },
              "joint 'elbow': its damping is inf; it must be a number of at least 0", 21);
  expectError([](Robot& robot) { robot.joints[1].friction = -1; },
              "joint 'elbow': its friction is -1; it must be a number of at least 0", 21);
  expectError([](Robot& robot) { robot.joints[0].rotor_inertia = -1e-4; },
              "joint 'shoulder': its rotor inertia is -1e-04; it must be a number of at least 0", 20);
}

TEST(CheckRobot, NumbersMatterForKinematicsToo) {
  expectError([](Robot& robot) { robot.joints[2].origin.translation().x() = nan; },
              "joint 'wrist': its origin is not made of finite numbers", 22, MassPolicy::kinematics_only);
}

TEST(CheckRobot, BodyInertia) {
  expectError([](Robot& robot) { robot.links[1].inertia = Eigen::Vector3d(0.02, 0.02, 0).asDiagonal(); },
              "link 'upper': its inertia is not positive definite (principal moments about its centre of mass, with "
              "all that is fixed to it and its rotor: 0, 0.02, 0.02 kg m²): all three principal moments must be "
              "greater than 0",
              11);
  expectError([](Robot& robot) { robot.links[1].inertia = Eigen::Vector3d(0.02, 0.02, 0.05).asDiagonal(); },
              "link 'upper': no body can have its inertia (principal moments about its centre of mass, with all that "
              "is fixed to it and its rotor: 0.02, 0.02, 0.05 kg m²): the greatest moment must not exceed the sum of "
              "the two others",
              11);
}

TEST(CheckRobot, AThinDiskIsTheLimit) {
  Robot robot = soundRobot();
  robot.links[1].inertia = Eigen::Vector3d(0.01, 0.01, 0.02).asDiagonal();
  robot.joints[0].rotor_inertia = 0.02;
  EXPECT_EQ(Model(robot).dof(), 2);
}

}  // namespace
}  // namespace tactus::dynamics
