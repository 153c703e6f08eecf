#include "framework/dynamics/check_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "framework/dynamics/model.h"
#include "tests/dynamics/robots.h"

// Each fault is put into a sound robot whose parts all stand at known lines; text and place of the message are checked.
namespace tactus::dynamics {
namespace {

using description::JointType;
using description::Robot;
using testing::ElementsAre;
using testing::IsEmpty;

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
  const std::vector<RobotFinding> all = validate(robot, policy);
  const auto first = std::ranges::find(all, RobotFinding::Severity::error, &RobotFinding::severity);
  ASSERT_NE(first, all.end());
  EXPECT_EQ(first->message, message);                              // what Model throws is what validate finds first
  EXPECT_EQ(first->place.line, line);
}

/// "error 21 message" of every finding.
std::vector<std::string> findings(const Robot& robot, MassPolicy policy = MassPolicy::required) {
  std::vector<std::string> lines;
  for (const RobotFinding& one : validate(robot, policy))
    lines.push_back(std::string(one.severity == RobotFinding::Severity::error ? "error " : "warning ") +
                    std::to_string(one.place.line) + " " + one.message);
  return lines;
}

TEST(CheckRobot, ASoundRobotPasses) {
  EXPECT_EQ(Model(soundRobot()).dof(), 2);
  EXPECT_THAT(findings(soundRobot()), IsEmpty());
  EXPECT_THAT(findings(soundRobot(), MassPolicy::kinematics_only), IsEmpty());
}

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

TEST(CheckRobot, Mimics) {
  const auto follow = [](int driver, double multiplier = 2) {
    return [=](Robot& robot) { robot.joints[1].mimic = description::Mimic{driver, multiplier, 0}; };
  };
  expectError(follow(17), "joint 'elbow' mimics a joint that the robot does not have: name one of its joints", 21);
  expectError(follow(0, nan), "joint 'elbow': the multiplier and offset of its mimic must be finite numbers", 21);
  expectError(follow(1), "joint 'elbow' mimics itself, directly or through others: one of them must move freely", 21);
  expectError(follow(2), "joint 'elbow' mimics joint 'wrist': both must be revolute, continuous or prismatic", 21);
}

TEST(CheckRobot, ADriverMustBeAbleToKeepTheLimitsOfWhatFollowsIt) {
  const auto limited = [](double ratio, double offset, double lower, double upper) {
    return [=](Robot& robot) {
      robot.joints[0].lower = -1;
      robot.joints[0].upper = 1;
      robot.joints[1].mimic = description::Mimic{0, ratio, offset};
      robot.joints[1].lower = lower;
      robot.joints[1].upper = upper;
    };
  };
  expectError(limited(-2, 0.5, 3, 4.5),
              "joint 'elbow' keeps its limits only while 'shoulder', which it follows, is in -2 to -1.25, but that may "
              "only be in -1 to 1: change the limits or the mimic",
              21);
  expectError(limited(0, 0.5, 1, 2),
              "joint 'elbow' always stands at 0.5, outside its limits 1 to 2: change the limits or the mimic", 21);
  for (const auto& sound : {limited(-2, 0.5, 2.5, 3), limited(0, 0.5, 0.5, 1)}) {
    Robot robot = soundRobot();
    sound(robot);
    EXPECT_THAT(findings(robot), IsEmpty());
    const Model model(robot);
    EXPECT_LE(model.lower()[0], model.upper()[0]);
  }
}

TEST(CheckRobot, NamesOfCoordinatesAreUniqueToo) {
  expectError(
      [](Robot& robot) {
        robot.joints[0].name = "f";
        robot.joints[0].type = JointType::planar;
        robot.joints[1].name = "f.x";
      },
      "joints 'f' (line 20) and 'f.x' both have a coordinate 'f.x': give one of them another name", 21);
  expectError(
      [](Robot& robot) {
        robot.joints[0].name = "f.qw";
        robot.joints[1].name = "f";
        robot.joints[1].type = JointType::spherical;
      },
      "joints 'f.qw' (line 20) and 'f' both have a coordinate 'f.qw': give one of them another name", 21);
  Robot robot = soundRobot();
  robot.joints[0].name = "wrist.x";                                // a fixed joint has no coordinates
  EXPECT_THAT(findings(robot), IsEmpty());
}

TEST(CheckRobot, RotorsAndGears) {
  expectError([](Robot& robot) { robot.joints[0].gear_ratio = 0; },
              "joint 'shoulder': its gear ratio is 0; it must be a number other than 0", 20);
  expectError(
      [](Robot& robot) {
        robot.joints[0].type = JointType::spherical;
        robot.joints[0].rotor_inertia = 0.01;
      },
      "joint 'shoulder' has several degrees of freedom: which one its rotor turns with is not said, leave it out", 20);
}

TEST(CheckRobot, EveryFaultIsFoundAtOnce) {
  Robot robot = soundRobot();
  robot.links[3].name = "upper";
  robot.links[2].mass = -1;
  robot.links[2].centre_of_mass.x() = nan;
  robot.joints[0].lower = 2;
  robot.joints[0].upper = 1;
  robot.joints[0].damping = -1;
  robot.joints[1].mimic = description::Mimic{1, 1, 0};
  EXPECT_THAT(findings(robot),
              ElementsAre("error 13 two links are named 'upper' (line 11): give one of them another name",
                          "error 12 link 'lower': its mass is -1 kg; a mass cannot be negative",
                          "error 12 link 'lower': its centre of mass is not made of finite numbers",
                          "error 20 joint 'shoulder': its lower limit 2 lies above its upper limit 1",
                          "error 20 joint 'shoulder': its damping is -1; it must be a number of at least 0",
                          "error 21 joint 'elbow' mimics itself, directly or through others: one of them must move "
                          "freely"));
}

TEST(CheckRobot, InertiasAreJudgedBesideOtherFaults) {
  const std::string bad_moments =
      "no body can have its inertia (principal moments about its centre of mass, with all that is fixed to it and its "
      "rotor: 0.02, 0.02, 0.05 kg m²): the greatest moment must not exceed the sum of the two others";
  const std::string limits = "error 21 joint 'elbow': its lower limit 2 lies above its upper limit 1";
  Robot robot = soundRobot();
  robot.links[1].inertia = Eigen::Vector3d(0.02, 0.02, 0.05).asDiagonal();
  robot.joints[1].lower = 2;
  robot.joints[1].upper = 1;
  robot.joints[1].mimic = description::Mimic{1, 1, 0};
  EXPECT_THAT(findings(robot),
              ElementsAre(limits,
                          "error 21 joint 'elbow' mimics itself, directly or through others: one of them must move "
                          "freely",
                          "error 11 link 'upper': " + bad_moments));
  robot.links[2].has_inertial = false;
  robot.joints[1].mimic.reset();
  robot.links[3].mass = nan;                                       // the body of "lower" and "hand" is not judged
  EXPECT_THAT(findings(robot), ElementsAre("error 13 link 'hand': its mass is not a finite number", limits,
                                           "error 11 link 'upper': " + bad_moments));
  robot.links[3].name = "upper";                                   // no tree: links on their own
  EXPECT_THAT(findings(robot),
              ::testing::Contains("warning 11 link 'upper' has an inertia tensor that no rigid body has: its principal "
                                  "moments must be positive, and each at most the sum of the two others"));
}

TEST(CheckRobot, ATensorWithoutMassOnTheBase) {
  Robot robot = soundRobot();
  robot.links[0].has_inertial = true;
  EXPECT_THAT(findings(robot), IsEmpty());                         // nothing at all is nothing
  robot.links[0].inertia = Eigen::Vector3d(0.02, 0.02, 0.05).asDiagonal();
  EXPECT_THAT(findings(robot),
              ElementsAre("warning 10 link 'base' has an inertia tensor that no rigid body has: its principal moments "
                          "must be positive, and each at most the sum of the two others"));
}

TEST(CheckRobot, EveryRootAndEveryLinkInALoopIsFound) {
  Robot robot = soundRobot();
  robot.joints.erase(robot.joints.begin() + 1, robot.joints.end());
  EXPECT_THAT(findings(robot),
              ElementsAre("error 12 the robot has two roots, 'base' and 'lower': join the second one to the tree",
                          "error 13 the robot has two roots, 'base' and 'hand': join the second one to the tree"));
  robot = soundRobot();
  robot.joints[0].parent = 2;                                      // upper and lower in a circle, hand below it
  EXPECT_THAT(
      findings(robot),
      ElementsAre("error 11 link 'upper' hangs in a loop of joints that never reaches the base 'base': open the loop",
                  "error 12 link 'lower' hangs in a loop of joints that never reaches the base 'base': open the loop",
                  "error 13 link 'hand' hangs in a loop of joints that never reaches the base 'base': open the loop"));
}

TEST(CheckRobot, WhatOnlyDynamicsNeedIsAWarningForKinematics) {
  Robot robot = soundRobot();
  robot.links[1].mass = 0;
  robot.links[2].has_inertial = robot.links[3].has_inertial = false;
  EXPECT_THAT(findings(robot, MassPolicy::kinematics_only),
              ElementsAre("warning 11 link 'upper' has a mass that is not positive: the robot cannot be simulated",
                          "warning 12 link 'lower' moves but has no <inertial>: the robot serves for kinematics only"));
  const std::string to_do = " moves but has no mass: give it an <inertial> with mass and inertia, or join it by a "
                            "fixed joint to a link that has them";
  EXPECT_THAT(findings(robot), ElementsAre("error 11 link 'upper'" + to_do, "error 12 link 'lower'" + to_do));
}

TEST(CheckRobot, ATensorOfOneLinkThatNoBodyHas) {
  const std::string warning =
      " has an inertia tensor that no rigid body has: its principal moments must be positive, and each at most the sum "
      "of the two others";
  Robot robot = soundRobot();
  robot.links[3].inertia = Eigen::Vector3d(0.02, 0.02, 0.05).asDiagonal();  // with "lower", to which it is fixed, sound
  EXPECT_THAT(findings(robot), ElementsAre("warning 13 link 'hand'" + warning));
  EXPECT_EQ(Model(robot).dof(), 2);
  robot.links[1].inertia = robot.links[3].inertia;                 // alone in its body
  EXPECT_EQ(findings(robot).size(), 2u);
  EXPECT_THAT(findings(robot, MassPolicy::kinematics_only),
              ElementsAre("warning 11 link 'upper'" + warning, "warning 13 link 'hand'" + warning));
}

TEST(CheckRobot, AForgottenCentreOfMass) {
  const auto expected = ElementsAre(
      "warning 11 link 'upper' has its centre of mass exactly at its joint, though it reaches out beside it: its "
      "weight gives no torque there; public models of hands often forget the <origin> of the <inertial>");
  Robot robot = soundRobot();
  robot.links[1].centre_of_mass.setZero();
  EXPECT_THAT(findings(robot), IsEmpty());                         // the elbow stands on the shoulder's axis
  robot.joints[1].origin.translation().x() = 0.1;
  EXPECT_THAT(findings(robot), expected);
  EXPECT_THAT(findings(robot, MassPolicy::kinematics_only), expected);
  EXPECT_EQ(Model(robot).dof(), 2);

  robot.links[1].centre_of_mass.x() = 1e-12;                       // not exactly: it was thought of
  EXPECT_THAT(findings(robot), IsEmpty());
  robot.links[1].centre_of_mass.setZero();
  robot.joints[0].type = JointType::prismatic;                     // nothing turns
  EXPECT_THAT(findings(robot), IsEmpty());
  robot.joints[0].type = JointType::floating;                      // a base may have its origin where it likes
  EXPECT_THAT(findings(robot), IsEmpty());

  robot = soundRobot();
  robot.links[1].centre_of_mass.setZero();
  robot.joints[0].type = JointType::spherical;                     // no axis to reach along
  EXPECT_THAT(findings(robot), expected);
  robot.joints[0].type = JointType::revolute;
  robot.links[1].shapes = {description::CapsuleShape{{0, 0, 0}, {0, 0, 0.2}, 0.05}};
  EXPECT_THAT(findings(robot), IsEmpty());
  robot.links[1].shapes.push_back(description::CapsuleShape{{0, 0, 0}, {0, 0.2, 0}, 0.05});
  EXPECT_THAT(findings(robot), expected);
  description::BoxShape box{.size = {0.1, 0.1, 0.1}};
  robot.links[1].shapes = {box};
  EXPECT_THAT(findings(robot), IsEmpty());
  box.pose.translation().y() = 0.05;
  robot.links[1].shapes = {box};
  EXPECT_THAT(findings(robot), expected);
}

TEST(CheckRobot, AThinDiskIsTheLimit) {
  Robot robot = soundRobot();
  robot.links[1].inertia = Eigen::Vector3d(0.01, 0.01, 0.02).asDiagonal();
  robot.joints[0].rotor_inertia = 0.02;
  EXPECT_EQ(Model(robot).dof(), 2);
}

}  // namespace
}  // namespace tactus::dynamics
