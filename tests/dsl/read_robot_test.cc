// Strategy: the project's models against the published numbers that they are made of, and against each other and
// plain liburdfdom; public files as real input; then one text for each thing that can be wrong.

#include "dsl/read_robot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <urdf_parser/urdf_parser.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

#include "framework/dynamics/model.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using description::Robot;
using testing::ElementsAre;

const std::string models = std::string(TACTUS_SOURCE_DIR) + "/models/";
const std::string public_models = std::string(TACTUS_SOURCE_DIR) + "/../shared/models/";

Robot readCleanly(const std::string& file) {
  std::vector<dsl::Diagnostic> warnings;
  Robot robot = dsl::readRobot(file, warnings);
  for (const auto& warning : warnings) ADD_FAILURE() << dsl::render(warning);
  return robot;
}

const description::Link& link(const Robot& robot, const std::string& name) {
  return robot.links.at(static_cast<std::size_t>(robot.linkIndex(name)));
}
const description::Joint& joint(const Robot& robot, const std::string& name) {
  return robot.joints.at(static_cast<std::size_t>(robot.jointIndex(name)));
}

std::vector<std::string> movingJoints(const Robot& robot) {
  std::vector<std::string> names;
  for (int i : robot.movingJoints()) names.push_back(robot.joints[static_cast<std::size_t>(i)].name);
  return names;
}

double mass(const Robot& robot) {
  double sum = 0;
  for (const auto& link : robot.links) sum += link.mass;
  return sum;
}

TEST(Models, TheArmHasItsPublishedMassReachAndOrder) {
  const Robot robot = readCleanly(models + "lwr_4plus.urdf");
  EXPECT_THAT(movingJoints(robot), ElementsAre("a1", "a2", "e1", "a3", "a4", "a5", "a6"));
  EXPECT_NEAR(mass(robot), 15.1, 1e-12);
  double reach = 0;
  for (const auto& joint : robot.joints) reach += joint.origin.translation().z();
  EXPECT_NEAR(reach, 1.1785, 1e-12);
  for (const auto& joint : robot.joints) {
    EXPECT_EQ(joint.rotor_inertia, 0.05);
    EXPECT_EQ(joint.damping, 1.0);
    EXPECT_EQ(joint.lower, -joint.upper);
  }
  EXPECT_EQ(joint(robot, "a5").axis, -Eigen::Vector3d::UnitY());
  EXPECT_EQ(joint(robot, "a5").effort, 38);
}

TEST(Models, TheHandHasItsPublishedMassAndOrder) {
  const Robot robot = readCleanly(models + "allegro_right.urdf");
  EXPECT_NEAR(mass(robot), 0.955, 1e-3);
  ASSERT_EQ(movingJoints(robot).size(), 16u);
  EXPECT_EQ(movingJoints(robot)[4], "middle_abduction");
  EXPECT_EQ(movingJoints(robot)[12], "thumb_opposition");
  for (const auto& joint : robot.joints) {
    if (joint.type == description::JointType::fixed) continue;
    EXPECT_EQ(joint.rotor_inertia, 1e-4);
    EXPECT_EQ(joint.damping, 0.004);
    EXPECT_EQ(joint.effort, 0.7);
    EXPECT_EQ(joint.velocity, 7);
  }
  EXPECT_EQ(joint(robot, "thumb_opposition").lower, 0.263);
}

/// Moment of a box about its middle, as the derived tensors are.
Eigen::Vector3d boxMoments(double mass, const Eigen::Vector3d& size) {
  const Eigen::Vector3d square = size.cwiseAbs2();
  return mass / 12 * Eigen::Vector3d(square.y() + square.z(), square.x() + square.z(), square.x() + square.y());
}

TEST(Models, TensorsAreThoseOfTheBoxesAboutTheirMiddles) {
  const Robot robot = readCleanly(models + "lwr_allegro.urdf");
  const auto expectBox = [&](const std::string& name, const Eigen::Vector3d& size) {
    const auto& found = link(robot, name);
    const Eigen::Vector3d moments = boxMoments(found.mass, size);
    EXPECT_TRUE(found.inertia.diagonal().isApprox(moments, 2e-3))
        << name << ": " << found.inertia.diagonal().transpose() << " against " << moments.transpose();
  };
  for (const char* name : {"lwr_1", "lwr_2", "lwr_3", "lwr_4"}) expectBox(name, {0.06, 0.12, 0.26});
  expectBox("lwr_5", {0.06, 0.12, 0.248});
  expectBox("palm", {0.0408, 0.113, 0.095});
  expectBox("index_base", {0.0196, 0.0275, 0.0164});
  expectBox("middle_proximal", {0.0196, 0.0275, 0.054});
  expectBox("ring_medial", {0.0196, 0.0275, 0.0384});
  expectBox("ring_distal", {0.0196, 0.0275, 0.0267});
  expectBox("thumb_medial", {0.0196, 0.0275, 0.0514});
  EXPECT_EQ(link(robot, "middle_proximal").centre_of_mass, Eigen::Vector3d(0, 0, 0.027));
}

TEST(Models, EveryFingerLinkButTheTipHasOneCapsuleAlongItsLength) {
  const Robot robot = readCleanly(models + "allegro_right.urdf");
  for (const auto& found : robot.links) {
    if (found.name.ends_with("_tip")) {
      EXPECT_TRUE(found.shapes.empty());
      continue;
    }
    ASSERT_EQ(found.shapes.size(), 1u) << found.name;
    if (found.name == "palm") {
      EXPECT_EQ(std::get<description::BoxShape>(found.shapes[0]).size, Eigen::Vector3d(0.0408, 0.113, 0.095));
    } else {
      EXPECT_GT(std::get<description::CapsuleShape>(found.shapes[0]).radius, 0.008);
    }
  }
  const auto& distal = std::get<description::CapsuleShape>(link(robot, "index_distal").shapes[0]);
  EXPECT_EQ(distal.radius, 0.012);
  EXPECT_NEAR(distal.to.z(), joint(robot, "index_tip_mount").origin.translation().z(), 1e-12);  // over the tip
}

TEST(Models, ArmCapsulesReachFromJointToJointBesideTheAxis) {
  const Robot robot = readCleanly(models + "lwr_4plus.urdf");
  const auto& capsule = std::get<description::CapsuleShape>(link(robot, "lwr_1").shapes.at(0));
  EXPECT_TRUE(capsule.from.isApprox(Eigen::Vector3d(0, 0, 0), 1e-5) || capsule.from.norm() < 1e-5);
  EXPECT_TRUE(capsule.to.isApprox(Eigen::Vector3d(0, 0.06, 0.2), 1e-5));
  for (const auto& found : robot.links) {  // the centre of mass lies inside what can touch
    if (!found.name.starts_with("lwr_") || found.name == "lwr_base" || found.name == "lwr_6") continue;
    const auto& shape = std::get<description::CapsuleShape>(found.shapes.at(0));
    const Eigen::Vector3d along = shape.to - shape.from;
    const double t = std::clamp((found.centre_of_mass - shape.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
    EXPECT_LT((found.centre_of_mass - shape.from - t * along).norm(), shape.radius) << found.name;
  }
}

void expectSameLink(const description::Link& a, const description::Link& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.centre_of_mass, b.centre_of_mass);
  EXPECT_EQ(a.inertia, b.inertia);
  ASSERT_EQ(a.shapes.size(), b.shapes.size());
  for (std::size_t i = 0; i < a.shapes.size(); ++i) {
    ASSERT_EQ(a.shapes[i].index(), b.shapes[i].index());
    if (const auto* capsule = std::get_if<description::CapsuleShape>(&a.shapes[i])) {
      const auto& other = std::get<description::CapsuleShape>(b.shapes[i]);
      EXPECT_TRUE(capsule->from == other.from && capsule->to == other.to && capsule->radius == other.radius);
    } else {
      const auto &box = std::get<description::BoxShape>(a.shapes[i]),
                 &other = std::get<description::BoxShape>(b.shapes[i]);
      EXPECT_TRUE(box.size == other.size && box.pose.matrix() == other.pose.matrix());
    }
  }
}

void expectSameJoint(const Robot& robot_a, const description::Joint& a, const Robot& robot_b,
                     const description::Joint& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.type, b.type);
  EXPECT_EQ(robot_a.links[static_cast<std::size_t>(a.parent)].name,
            robot_b.links[static_cast<std::size_t>(b.parent)].name);
  EXPECT_EQ(robot_a.links[static_cast<std::size_t>(a.child)].name,
            robot_b.links[static_cast<std::size_t>(b.child)].name);
  EXPECT_EQ(a.origin.matrix(), b.origin.matrix());
  EXPECT_EQ(a.axis, b.axis);
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.effort, b.effort);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.damping, b.damping);
  EXPECT_EQ(a.rotor_inertia, b.rotor_inertia);
}

TEST(Models, TheCombinedRobotIsTheUnionOfItsParts) {
  const Robot arm = readCleanly(models + "lwr_4plus.urdf");
  const Robot hand = readCleanly(models + "allegro_right.urdf");
  const Robot both = readCleanly(models + "lwr_allegro.urdf");
  ASSERT_EQ(both.links.size(), arm.links.size() + hand.links.size());
  ASSERT_EQ(both.joints.size(), arm.joints.size() + hand.joints.size() + 1);
  std::size_t l = 0, j = 0;
  for (const Robot* part : {&arm, &hand}) {
    for (const auto& one : part->links) expectSameLink(one, both.links[l++]);
    if (part == &hand) ++j;  // the mount
    for (const auto& one : part->joints) expectSameJoint(*part, one, both, both.joints[j++]);
  }
  const auto& mount = joint(both, "hand_mount");
  EXPECT_EQ(mount.type, description::JointType::fixed);
  EXPECT_EQ(mount.origin.translation(), Eigen::Vector3d(-0.0823, 0, 0.0475));
  EXPECT_TRUE(mount.origin.linear().isApprox(
      Eigen::AngleAxisd(-1.0471975511965976, Eigen::Vector3d::UnitY()).toRotationMatrix(), 1e-14));

  std::vector<std::string> skin = arm.skin;
  skin.insert(skin.end(), hand.skin.begin(), hand.skin.end());
  EXPECT_EQ(both.skin, skin);
  const auto members = [](const Robot& robot, bool links) {
    std::map<std::string, std::vector<std::string>> groups;
    for (const auto& group : links ? robot.link_groups : robot.joint_groups) groups[group.name] = group.members;
    return groups;
  };
  for (bool links : {true, false}) {
    auto expected = members(arm, links);
    for (const auto& group : members(hand, links)) expected.insert(group);
    EXPECT_EQ(members(both, links), expected);
  }
}

TEST(Models, Hand1IsTheSameRobotWhoseFingersBendBothWays) {
  const Robot known = readCleanly(models + "lwr_allegro.urdf"), hand = readCleanly(models + "lwr_allegro_hand1.urdf");
  ASSERT_EQ(hand.links.size(), known.links.size());
  ASSERT_EQ(hand.joints.size(), known.joints.size());
  for (std::size_t i = 0; i < hand.links.size(); ++i) expectSameLink(known.links[i], hand.links[i]);
  int released = 0;
  for (std::size_t i = 0; i < hand.joints.size(); ++i) {
    description::Joint expected = known.joints[i];
    const bool thumb = expected.name.starts_with("thumb_");
    if (expected.name.ends_with("_medial") || expected.name.ends_with("_distal") ||
        (expected.name.ends_with("_proximal") && !thumb)) {
      expected.lower = -expected.upper;
      ++released;
    }
    expectSameJoint(known, expected, hand, hand.joints[i]);
  }
  EXPECT_EQ(released, 11);
  EXPECT_EQ(hand.skin, known.skin);
}

TEST(Models, Hand2HasAFourthFingerLikeTheOthersAndAPalmThatCarriesIt) {
  const Robot known = readCleanly(models + "lwr_allegro.urdf"), hand = readCleanly(models + "lwr_allegro_hand2.urdf");
  ASSERT_EQ(hand.links.size(), known.links.size() + 5);
  for (const auto& found : hand.links) {
    if (found.name == "palm") continue;
    description::Link expected = link(known, found.name.starts_with("little_") ? "ring" + found.name.substr(6) : found.name);
    expected.name = found.name;
    expectSameLink(expected, found);
  }
  const auto& palm = link(hand, "palm");
  const Eigen::Vector3d size(0.0408, 0.1565, 0.095);
  EXPECT_EQ(std::get<description::BoxShape>(palm.shapes.at(0)).size, size);
  EXPECT_NEAR(palm.mass, link(known, "palm").mass * 0.1565 / 0.113, 1e-4);
  EXPECT_TRUE(palm.inertia.diagonal().isApprox(boxMoments(palm.mass, size), 2e-3));

  // Four knuckles in a row, evenly about the middle, a finger's pitch apart; the thumb keeps its place by the index.
  const double pitch = joint(known, "index_abduction").origin.translation().y();
  const char* fingers[] = {"index", "middle", "ring", "little"};
  for (int i = 0; i < 4; ++i) {
    const auto& knuckle = joint(hand, std::string(fingers[i]) + "_abduction").origin;
    EXPECT_NEAR(knuckle.translation().y(), (1.5 - i) * pitch, 1e-12);
    EXPECT_NEAR(knuckle.translation().x(), 0, 1e-12);
    EXPECT_LT(std::abs(knuckle.translation().y()) + 0.0138, size.y() / 2 + 0.001) << "its base stands on the palm";
  }
  EXPECT_NEAR(joint(hand, "thumb_opposition").origin.translation().y() - joint(hand, "index_abduction").origin.translation().y(),
              joint(known, "thumb_opposition").origin.translation().y() - pitch, 1e-12);
  for (const auto& one : hand.joints) {
    if (one.name.ends_with("_abduction") || one.name == "thumb_opposition") continue;
    description::Joint expected = joint(known, one.name.starts_with("little_") ? "ring" + one.name.substr(6) : one.name);
    EXPECT_EQ(one.origin.matrix(), expected.origin.matrix()) << one.name;
    EXPECT_EQ(one.lower, expected.lower) << one.name;
    EXPECT_EQ(one.upper, expected.upper) << one.name;
    EXPECT_EQ(one.rotor_inertia, expected.rotor_inertia) << one.name;
  }
  const auto size_of = [](const std::vector<description::Group>& groups, const std::string& name) -> std::size_t {
    for (const auto& group : groups)
      if (group.name == name) return group.members.size();
    return 0;
  };
  EXPECT_EQ(size_of(hand.link_groups, "fingers"), 12u);
  EXPECT_EQ(size_of(hand.link_groups, "hand"), 26u);
  EXPECT_EQ(size_of(hand.joint_groups, "fingers"), 16u);
  EXPECT_EQ(size_of(hand.joint_groups, "hand"), 20u);
  EXPECT_EQ(size_of(hand.joint_groups, "abduction"), 4u);
  EXPECT_EQ(hand.skin.size(), known.skin.size() + 5);
}

TEST(Models, GroupsHoldWhatTheirNamesSay) {
  const Robot robot = readCleanly(models + "lwr_allegro.urdf");
  const auto size = [](const std::vector<description::Group>& groups, const std::string& name) -> std::size_t {
    for (const auto& group : groups)
      if (group.name == name) return group.members.size();
    return 0;
  };
  EXPECT_EQ(size(robot.link_groups, "fingers"), 9u);
  EXPECT_EQ(size(robot.link_groups, "hand"), 21u);
  EXPECT_EQ(size(robot.joint_groups, "arm"), 7u);
  EXPECT_EQ(size(robot.joint_groups, "fingers"), 12u);
  EXPECT_EQ(size(robot.joint_groups, "thumb"), 4u);
  EXPECT_EQ(size(robot.joint_groups, "hand"), 16u);
  EXPECT_EQ(size(robot.joint_groups, "abduction"), 3u);
}

TEST(Models, AnyReaderOfUrdfTakesThem) {
  for (const auto& entry : std::filesystem::directory_iterator(models)) {
    if (entry.path().extension() != ".urdf") continue;
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    testing::internal::CaptureStderr();
    const auto model = urdf::parseURDF(text.str());
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    ASSERT_TRUE(model) << entry.path();
    EXPECT_EQ(model->links_.size(), readCleanly(entry.path().string()).links.size());
  }
}

/// The public files are no part of the project: without them there is nothing to load, and that is said.
bool publicModelsAreHere(const std::string& file) {
  const bool here = std::filesystem::exists(file);
  if (!here) std::cout << "not tried: " << file << " is not there\n";
  return here;
}

TEST(PublicModels, TheIiwaLoadsClean) {
  const std::string file = public_models + "iiwa14/drake_iiwa14_no_collision.urdf";
  if (!publicModelsAreHere(file)) return;
  const Robot robot = readCleanly(file);
  EXPECT_EQ(movingJoints(robot).size(), 7u);
  EXPECT_NO_THROW(dynamics::Model(robot, dynamics::MassPolicy::required));
}

TEST(PublicModels, TheAllegroWithoutInertiasServesForKinematicsOnly) {
  const std::string file = public_models + "allegro/simlab_allegro_hand_description_right.urdf";
  if (!publicModelsAreHere(file)) return;
  std::vector<dsl::Diagnostic> warnings;
  const Robot robot = dsl::readRobot(file, warnings);
  EXPECT_EQ(warnings.size(), 16u);
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  for (const auto& warning : warnings) {
    EXPECT_EQ(warning.severity, dsl::Severity::warning);
    EXPECT_EQ(warning.code, "W001");
    const std::string& line = lines.at(static_cast<std::size_t>(warning.place.line) - 1);
    EXPECT_EQ(line.substr(static_cast<std::size_t>(warning.place.column) - 1, 11), "<link name=");
  }
  EXPECT_NO_THROW(dynamics::Model(robot, dynamics::MassPolicy::kinematics_only));
  try {
    dynamics::Model(robot, dynamics::MassPolicy::required);
    FAIL() << "dynamics without masses";
  } catch (const dynamics::ModelError& error) {
    EXPECT_EQ(error.place.file, file);
    EXPECT_GT(error.place.line, 1);
  }
}

// --- What can be wrong --------------------------------------------------------------------------------------

const std::string good =
    "<robot name=\"r\">\n"
    "  <link name=\"base\"/>\n"
    "  <link name=\"arm\">\n"
    "    <inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
    "izz=\"1\"/></inertial>\n"
    "    <collision><geometry><capsule radius=\"0.1\" length=\"0.2\"/></geometry></collision>\n"
    "  </link>\n"
    "  <joint name=\"j\" type=\"revolute\">\n"
    "    <parent link=\"base\"/><child link=\"arm\"/>\n"
    "    <origin xyz=\"0 0 1\" rpy=\"0 0 0\"/><axis xyz=\"0 0 2\"/>\n"
    "    <limit lower=\"-1\" upper=\"1\" effort=\"10\" velocity=\"2\"/>\n"
    "    <dynamics damping=\"0.5\"/><rotor inertia=\"0.01\"/>\n"
    "  </joint>\n"
    "  <tactus><skin links=\"arm\"/><links name=\"all\" members=\"base arm\"/><joints name=\"js\" "
    "members=\"j\"/></tactus>\n"
    "</robot>\n";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = good;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::string line(const dsl::Diagnostic& diagnostic) {
  return std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " + diagnostic.code +
         " " + diagnostic.message + (diagnostic.suggestion.empty() ? "" : " [" + diagnostic.suggestion + "]");
}

std::vector<std::string> findings(const std::string& text) {
  std::vector<dsl::Diagnostic> found;
  try {
    dsl::readRobot(writeFile("robot.urdf", text), found);
  } catch (const dsl::InvalidStack& invalid) {
    found = invalid.diagnostics;
  }
  std::vector<std::string> lines;
  for (const auto& diagnostic : found) lines.push_back(line(diagnostic));
  return lines;
}

TEST(ReadRobot, ReadsWhatIsRight) {
  EXPECT_THAT(findings(good), testing::IsEmpty());
  const Robot robot = readCleanly(writeFile("good.urdf", good));
  EXPECT_EQ(joint(robot, "j").axis, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(joint(robot, "j").place.line, 7);
  EXPECT_EQ(joint(robot, "j").place.column, 3);
  EXPECT_EQ(robot.skin, std::vector<std::string>{"arm"});
  const auto& capsule = std::get<description::CapsuleShape>(link(robot, "arm").shapes.at(0));
  EXPECT_EQ(capsule.from, Eigen::Vector3d(0, 0, -0.1));
  EXPECT_EQ(capsule.to, Eigen::Vector3d(0, 0, 0.1));
}

TEST(ReadRobot, AMissingFileAndOneThatIsNoRobot) {
  std::vector<dsl::Diagnostic> warnings;
  EXPECT_THROW(dsl::readRobot("/nowhere/at/all.urdf", warnings), dsl::InvalidStack);
  EXPECT_THAT(findings(""), ElementsAre("1:1 E002 the file holds no element"));
  EXPECT_THAT(findings("solid stl"), ElementsAre("1:1 E003 text stands before the outermost element"));
  EXPECT_THAT(findings("<sdf/>"), ElementsAre("1:1 E010 a robot file has <robot> outermost, not <sdf>"));
  EXPECT_THAT(findings("<robot name='r'/>"), ElementsAre("1:1 E080 the robot has no link"));
}

TEST(ReadRobot, NamesAndReferences) {
  EXPECT_THAT(findings(changed("name=\"arm\"", "name=\"base\"")),
              testing::Contains("3:15 E020 the robot has a link 'base' already"));
  EXPECT_THAT(findings(changed("child link=\"arm\"", "child link=\"amr\"")),
              ElementsAre("8:39 E030 the robot has no link 'amr' [arm]"));
  EXPECT_THAT(findings(changed("<link name=\"base\"/>", "<link/>")),
              testing::Contains("2:3 E013 <link> needs the attribute 'name'"));
  EXPECT_THAT(findings(changed("members=\"base arm\"", "members=\"base amr\"")),
              ElementsAre("13:62 E030 the robot has no link 'amr' [arm]"));
  EXPECT_THAT(findings(changed("members=\"j\"", "members=\"jj\"")),
              ElementsAre("13:95 E031 the robot has no moving joint 'jj' [j]"));
  EXPECT_THAT(findings(changed("name=\"all\"", "name=\"arm\"")),
              ElementsAre("13:43 E020 the name 'arm' is that of a link or of a group already"));
}

TEST(ReadRobot, AnEmptyNameIsToldAtItsPlace) {
  EXPECT_THAT(findings(changed("<link name=\"base\"/>", "<link name=\"\"/>")),
              testing::Contains("2:15 E014 the name of a link must not be empty"));
  EXPECT_THAT(findings(changed("joint name=\"j\"", "joint name=\"\"")),
              testing::Contains("7:16 E014 the name of a joint must not be empty"));
}

TEST(ReadRobot, WhatNothingReadsIsTold) {
  EXPECT_THAT(findings(changed("<axis xyz=\"0 0 2\"/>", "<axes xyz=\"0 0 2\"/>")),
              ElementsAre("9:38 W008 nothing reads the <axes> of <joint name=\"j\"> [axis]"));
  EXPECT_THAT(findings(changed("origin xyz", "origin xzy")),
              ElementsAre("9:13 W008 nothing reads the attribute 'xzy' of <origin> [xyz]"));
  EXPECT_THAT(findings(changed("<dynamics damping", "<dynamic damping")),
              ElementsAre("11:5 W008 nothing reads the <dynamic> of <joint name=\"j\"> [dynamics]"));
  EXPECT_THAT(findings(changed("limit lower", "limit lowr")),
              ElementsAre("10:12 W008 nothing reads the attribute 'lowr' of <limit> [lower]"));
  EXPECT_THAT(findings(changed("<link name=\"base\"/>",
                               "<link name=\"base\"><inertal/></link><lnk/>")),
              ElementsAre("2:38 W008 nothing reads the <lnk> of <robot name=\"r\"> [link]",
                          "2:21 W008 nothing reads the <inertal> of <link name=\"base\"> [inertial]"));
}

TEST(ReadRobot, WhatOtherProgramsReadIsNot) {
  EXPECT_THAT(findings(changed("<link name=\"base\"/>",
                               "<gazebo/><frame link=\"base\"/><link name=\"base\"><self_collision_checking/>"
                               "<drake:joint/></link>")),
              testing::IsEmpty());
  EXPECT_THAT(findings(changed("<limit ", "<limit drake:acceleration=\"3\" ")), testing::IsEmpty());
}

TEST(ReadRobot, WhatStandsTwiceIsRefused) {
  const std::string inertial = "<inertial><mass value=\"1\"/>";
  EXPECT_THAT(findings(changed(inertial, inertial + "<mass value=\"2\"/>")),
              ElementsAre("4:32 E017 <inertial> has a second <mass>: it may have one, remove the other"));
  EXPECT_THAT(findings(changed("    <collision>", "    <inertial/><collision>")),
              testing::Contains("5:5 E017 <link name=\"arm\"> has a second <inertial>: it may have one, remove the "
                                "other"));
  for (const std::string part : {"<limit effort=\"1\" velocity=\"1\"/>", "<parent link=\"base\"/>"})
    EXPECT_THAT(findings(changed("    <dynamics", "    " + part + "<dynamics")),
                ElementsAre("11:5 E017 <joint name=\"j\"> has a second " + part.substr(0, part.find(' ')) +
                            ">: it may have one, remove the other"));
}

TEST(ReadRobot, TheTree) {
  EXPECT_THAT(findings(changed("<link name=\"base\"/>", "<link name=\"base\"/><link name=\"lost\"/>")),
              ElementsAre("2:22 E081 link 'lost' has no parent, but 'base' is the root already"));
  EXPECT_THAT(findings(changed("parent link=\"base\"", "parent link=\"arm\"")),
              ElementsAre("8:38 E082 joint 'j' joins link 'arm' to itself"));
  const std::string second = "<joint name='k' type='fixed'><parent link='arm'/><child link='base'/></joint><tactus>";
  EXPECT_THAT(findings(changed("<tactus>", second)),
              ElementsAre("1:1 E080 no link is the root: every one is the child of a joint"));
  const std::string twice = "<joint name='k' type='fixed'><parent link='base'/><child link='arm'/></joint><tactus>";
  EXPECT_THAT(findings(changed("<tactus>", twice)),
              ElementsAre("13:66 E082 link 'arm' is the child of joint 'j' already"));
  const std::string circle =
      "<link name='a'/><link name='b'/><joint name='up' type='fixed'><parent link='a'/><child link='b'/></joint>"
      "<joint name='down' type='fixed'><parent link='b'/><child link='a'/></joint><tactus>";
  EXPECT_THAT(findings(changed("<tactus>", circle)),
              ElementsAre("13:3 E082 link 'a' hangs in a closed loop of joints: 'up', 'down'"));
}

TEST(ReadRobot, JointTypesAndLimits) {
  EXPECT_THAT(findings(changed("revolute", "revolut")),
              ElementsAre("7:25 E083 joints of type 'revolut' are not supported: expected revolute, continuous, "
                          "prismatic, fixed, planar, spherical or floating [revolute]"));
  EXPECT_THAT(findings(changed("lower=\"-1\"", "lower=\"2\"")),
              ElementsAre("10:19 E084 the lower limit 2 lies above the upper limit 1"));
  EXPECT_THAT(findings(changed("lower=\"-1\" upper=\"1\"", "lower=\"0.5\"")),
              ElementsAre("10:19 E084 the lower limit 0.5 lies above the upper limit, which is not given and therefore "
                          "0"));
  EXPECT_THAT(findings(changed("lower=\"-1\" upper=\"1\"", "upper=\"-0.5\"")),
              ElementsAre("10:19 E084 the upper limit -0.5 lies below the lower limit, which is not given and "
                          "therefore 0"));
  std::string continuous = changed("revolute", "continuous");
  continuous.replace(continuous.find(" upper=\"1\""), 10, "").replace(continuous.find("lower=\"-1\""), 10,
                                                                        "lower=\"1\"");
  EXPECT_THAT(findings(continuous), testing::IsEmpty());
  EXPECT_THAT(findings(changed("<limit lower=\"-1\" upper=\"1\" effort=\"10\" velocity=\"2\"/>", "")),
              ElementsAre("7:3 E016 <joint> needs a <limit>"));
  EXPECT_THAT(findings(changed(" effort=\"10\"", "")), ElementsAre("10:5 E013 <limit> needs the attribute 'effort'"));
  EXPECT_THAT(findings(changed("xyz=\"0 0 2\"", "xyz=\"0 0 0\"")), ElementsAre("9:49 E014 an axis must not be zero"));
}

/// `good` with a joint of several degrees of freedom, and nothing that means nothing to it.
std::string freer(const std::string& type) {
  std::string text = changed("revolute", type);
  const std::size_t limit = text.find("<limit"), end = text.find("  </joint>");
  text.erase(limit, end - limit);
  if (type == "planar") return text;
  return text.erase(text.find("<axis"), std::string("<axis xyz=\"0 0 2\"/>").size());
}

TEST(ReadRobot, JointsOfSeveralDegreesOfFreedom) {
  for (const auto& [word, type] : {std::pair{"planar", description::JointType::planar},
                                   {"spherical", description::JointType::spherical},
                                   {"floating", description::JointType::floating}}) {
    const Robot robot = readCleanly(writeFile(std::string(word) + ".urdf", freer(word)));
    EXPECT_EQ(joint(robot, "j").type, type);
    EXPECT_EQ(joint(robot, "j").origin.translation(), Eigen::Vector3d(0, 0, 1));
    EXPECT_EQ(joint(robot, "j").axis, Eigen::Vector3d::UnitZ());
    EXPECT_EQ(joint(robot, "j").place.line, 7);
    EXPECT_EQ(dynamics::Model(robot).dof(), description::velocityCount(type));
  }
}

TEST(ReadRobot, HoweverTheWordSphericalIsWritten) {
  for (const char* word : {"'spherical'", "\"spheric&#97;l\"", "\n 'spherical' "}) {
    std::string text = freer("spherical");
    const std::string plain = "\"spherical\"";
    text.replace(text.find(plain), plain.size(), word);
    EXPECT_EQ(joint(readCleanly(writeFile("robot.urdf", text)), "j").type, description::JointType::spherical) << word;
  }
}

TEST(ReadRobot, WhatMeansNothingToAJointIsPassedOverWithAWarning) {
  std::string text = freer("spherical");
  text.insert(text.find("  </joint>"),
              "    <limit effort=\"much\"/><axis xyz=\"1 0\"/><safety_controller/><calibration/>\n    <dynamics/>\n");
  EXPECT_THAT(findings(text), ElementsAre("10:9 W006 joint 'j' is spherical: its <limit> is passed over",
                                          "10:31 W006 joint 'j' is spherical: its <axis> is passed over",
                                          "10:48 W006 joint 'j' is spherical: its <safety_controller> is passed over",
                                          "10:68 W006 joint 'j' is spherical: its <calibration> is passed over",
                                          "11:5 W006 joint 'j' is spherical: its <dynamics> is passed over"));
  text = freer("planar");
  text.insert(text.find("  </joint>"), "    <limit effort=\"1\" velocity=\"1\"/>\n");
  EXPECT_THAT(findings(text), ElementsAre("10:9 W006 joint 'j' is planar: its <limit> is passed over"));
  text = freer("planar");
  text.replace(text.find("0 0 2"), 5, "0 0 0");
  EXPECT_THAT(findings(text), ElementsAre("9:49 E014 an axis must not be zero"));
  text = freer("floating");
  text.insert(text.find("  </joint>"), "    <rotor inertia=\"0.1\"/>\n");
  EXPECT_THAT(findings(text), ElementsAre("10:9 E015 joint 'j' has several degrees of freedom: which one its rotor "
                                          "turns with is not said, leave it out"));
}

TEST(ReadRobot, AGearRatio) {
  const auto geared = [](const std::string& ratio) {
    return changed("rotor inertia=\"0.01\"", "rotor inertia=\"0.01\" gear-ratio=\"" + ratio + "\"");
  };
  const Robot robot = readCleanly(writeFile("robot.urdf", geared("-20")));
  EXPECT_EQ(joint(robot, "j").gear_ratio, -20);
  EXPECT_DOUBLE_EQ(joint(robot, "j").reflectedInertia(), 4);
  EXPECT_EQ(joint(readCleanly(writeFile("robot.urdf", good)), "j").gear_ratio, 1);
  EXPECT_THAT(findings(geared("0")), ElementsAre("11:64 E014 a gear ratio must not be zero"));
  EXPECT_THAT(findings(geared("1:20")),
              ElementsAre("11:64 E014 attribute 'gear-ratio': '1:20' is not a number: expected a number"));
  EXPECT_THAT(findings(changed("rotor inertia=\"0.01\"", "rotor inertia=\"0.01\" gear_ratio=\"2\"")),
              ElementsAre("11:52 E012 <rotor> has no attribute 'gear_ratio' [gear-ratio]"));
}

/// `good` with a second arm on the first, whose joint "k" is of this type and follows as `mimic` says.
std::string following(const std::string& mimic, const std::string& type = "continuous") {
  const std::string second =
      "  <link name=\"hand\"><inertial><origin xyz=\"0 0 1\"/><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" "
      "ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>\n"
      "  <joint name=\"k\" type=\"" + type + "\"><parent link=\"arm\"/><child link=\"hand\"/>\n" + mimic +
      "\n  </joint>\n  <tactus>";
  return changed("  <tactus>", second);
}

TEST(ReadRobot, AJointMayFollowAnother) {
  const Robot robot = readCleanly(
      writeFile("robot.urdf", following("<mimic joint=\"j\" multiplier=\"-0.5\" offset=\"0.25\"/>")));
  ASSERT_TRUE(joint(robot, "k").mimic);
  EXPECT_EQ(joint(robot, "k").mimic->driver, robot.jointIndex("j"));
  EXPECT_EQ(joint(robot, "k").mimic->multiplier, -0.5);
  EXPECT_EQ(joint(robot, "k").mimic->offset, 0.25);
  EXPECT_FALSE(joint(robot, "j").mimic);
  EXPECT_THAT(movingJoints(robot), ElementsAre("j"));
  const Robot plain = readCleanly(writeFile("robot.urdf", following("<mimic joint=\"j\"/>")));
  EXPECT_EQ(joint(plain, "k").mimic->multiplier, 1);
  EXPECT_EQ(joint(plain, "k").mimic->offset, 0);
}

TEST(ReadRobot, WhatCannotFollowOrBeFollowed) {
  EXPECT_THAT(findings(following("<mimic joint=\"jj\"/>")),
              ElementsAre("15:15 E031 the robot has no joint 'jj' [j]"));
  EXPECT_THAT(findings(following("<mimic/>")), ElementsAre("15:1 E013 <mimic> needs the attribute 'joint'"));
  EXPECT_THAT(findings(following("<mimic joint=\"j\" multiplyer=\"2\"/>")),
              ElementsAre("15:18 E012 <mimic> has no attribute 'multiplyer' [multiplier]"));
  EXPECT_THAT(findings(following("<mimic joint=\"j\" multiplier=\"two\" offset=\"inf\"/>")),
              ElementsAre("15:30 E014 attribute 'multiplier': 'two' is not a number: expected a number",
                          "15:43 E014 attribute 'offset': 'inf' is not a finite number: expected a number"));
  const std::string itself =
      "E086 joint 'k' follows itself, directly or through others: one of them must move freely";
  EXPECT_THAT(findings(following("<mimic joint=\"k\"/>")), ElementsAre("15:15 " + itself));
  std::string circle = following("<mimic joint=\"j\"/>");
  circle.replace(circle.find("<dynamics"), 0, "<mimic joint=\"k\"/>");
  EXPECT_THAT(findings(circle),
              ElementsAre("11:19 E086 joint 'j' follows itself, directly or through others: one of them must move "
                          "freely",
                          "15:15 " + itself));
  for (const std::string type : {"fixed", "planar", "spherical", "floating"})
    EXPECT_THAT(findings(following("<mimic joint=\"j\"/>", type)),
                ElementsAre("15:1 E086 joint 'k' is " + type +
                            ": only one that is revolute, continuous or prismatic follows another"));
  for (const std::string type : {"fixed", "planar"}) {
    std::string text = following("<mimic joint=\"j\"/>");
    text.replace(text.find("revolute"), 8, type);
    EXPECT_THAT(findings(text), testing::Contains("15:15 E086 joint 'j' is " + type +
                                                  ": only one that is revolute, continuous or prismatic can be "
                                                  "followed"));
  }
}

TEST(ReadRobot, LimitsThatCannotBothHoldAreToldAtTheMimic) {
  EXPECT_THAT(findings(following("<limit lower=\"3\" upper=\"4\" effort=\"1\" velocity=\"1\"/>\n"
                                 "<mimic joint=\"j\" multiplier=\"2\" offset=\"0.5\"/>", "revolute")),
              ElementsAre("16:1 E086 joint 'k' keeps its limits only while 'j', which it follows, is in 1.25 to 1.75, "
                          "but that may only be in -1 to 1: change the limits or the mimic"));
}

TEST(ReadRobot, AnAxisOfAnyLength) {
  for (const char* axis : {"0 0 1e200", "0 0 1e-200", "0 0 5e-324"})
    EXPECT_EQ(joint(readCleanly(writeFile("robot.urdf", changed("0 0 2", axis))), "j").axis, Eigen::Vector3d::UnitZ())
        << axis;
}

TEST(ReadRobot, AContinuousJointHasNoLimits) {
  const Robot robot = readCleanly(writeFile("robot.urdf", changed("revolute", "continuous")));
  EXPECT_EQ(joint(robot, "j").type, description::JointType::revolute);
  EXPECT_EQ(joint(robot, "j").upper, description::infinity);
  EXPECT_EQ(joint(robot, "j").effort, 10);
}

TEST(ReadRobot, Numbers) {
  EXPECT_THAT(findings(changed("upper=\"1\"", "upper=\"nan\"")),
              ElementsAre("10:30 E014 attribute 'upper': 'nan' is not a finite number: expected a number"));
  EXPECT_THAT(findings(changed("upper=\"1\"", "upper=\"1,5\"")),
              ElementsAre("10:30 E014 attribute 'upper': '1,5' is not a number: expected a number; "
                          "the decimal sign is a point"));
  EXPECT_THAT(findings(changed("xyz=\"0 0 1\"", "xyz=\"0 1\"")),
              ElementsAre("9:18 E014 attribute 'xyz': expected 3 numbers, found 2"));
  EXPECT_THAT(findings(changed("damping=\"0.5\"", "damping=\"-0.5\"")),
              ElementsAre("11:24 E014 attribute 'damping': '-0.5' is out of range: expected a number ≥ 0"));
  EXPECT_THAT(findings(changed(" ixy=\"0\"", "")), ElementsAre("4:32 E013 <inertia> needs the attribute 'ixy'"));
}

TEST(ReadRobot, OwnElements) {
  EXPECT_THAT(findings(changed("rotor inertia", "rotor inerta")),
              ElementsAre("11:30 E013 <rotor> needs the attribute 'inertia'",
                          "11:37 E012 <rotor> has no attribute 'inerta' [inertia]"));
  EXPECT_THAT(findings(changed("<skin links=\"arm\"/>", "<skinn links=\"arm\"/>")),
              ElementsAre("13:11 E011 <tactus> has no <skinn> [skin]"));
  EXPECT_THAT(findings(changed("<skin links", "<skin link")),
              testing::Contains("13:17 E012 <skin> has no attribute 'link' [links]"));
  EXPECT_THAT(findings(changed("radius=\"0.1\"", "radius=\"0\"")),
              ElementsAre("5:43 E014 attribute 'radius': '0' is out of range: expected a number > 0"));
  EXPECT_THAT(findings(changed("<capsule", "<capsul")), ElementsAre("5:26 E011 <geometry> has no <capsul> [capsule]"));
}

TEST(ReadRobot, WhatMakesItUnfitForDynamicsIsAWarning) {
  const std::string inertial =
      good.substr(good.find("<inertial>"), good.find("</inertial>") + 11 - good.find("<inertial>"));
  EXPECT_THAT(findings(changed(inertial, "")),
              ElementsAre("3:3 W001 link 'arm' moves but has no <inertial>: the robot serves for kinematics only"));
  EXPECT_THAT(findings(changed("mass value=\"1\"", "mass value=\"0\"")),
              ElementsAre("3:3 W002 link 'arm' has a mass that is not positive: the robot cannot be simulated"));
  EXPECT_THAT(
      findings(changed("izz=\"1\"", "izz=\"2.1\"")),
      ElementsAre("3:3 W003 link 'arm' has an inertia tensor that no rigid body has: its principal moments must "
                  "be positive, and each at most the sum of the two others"));
  EXPECT_THAT(findings(changed("<capsule radius=\"0.1\" length=\"0.2\"/>", "<mesh filename=\"x.stl\"/>")),
              ElementsAre("5:26 W004 link 'arm' cannot touch with a mesh: give a <capsule>, <box> or <sphere>"));
  EXPECT_THAT(findings(changed("<capsule ", "<cylinder ")),
              ElementsAre("5:26 W004 link 'arm' touches with the capsule inside this cylinder: say <capsule/> in the "
                          "<collision> to round its ends"));
  EXPECT_THAT(findings(changed("length=\"0.2\"/></geometry>", "length=\"0.2\"/></geometry><capsule/>")),
              ElementsAre("5:73 E015 <capsule/> rounds the ends of a <cylinder>, not of a <capsule>"));
}

TEST(ReadRobot, WhatNoRobotCanBe) {
  EXPECT_THAT(findings(changed("mass value=\"1\"", "mass value=\"-1\"")),
              ElementsAre("3:3 E087 link 'arm': its mass is -1 kg; a mass cannot be negative"));
}

TEST(ReadRobot, AForgottenCentreOfMass) {
  EXPECT_THAT(findings(changed("<collision>", "<collision><origin xyz=\"0.1 0 0\"/>")),
              ElementsAre("3:3 W007 link 'arm' has its centre of mass exactly at its joint, though it reaches out "
                          "beside it: its weight gives no torque there; public models of hands often forget the "
                          "<origin> of the <inertial>"));
}

TEST(ReadRobot, EveryLinkUnfitForDynamicsIsToldAtItsPlace) {
  std::string text = following("");
  text.replace(text.find("mass value=\"1\""), 14, "mass value=\"0\"");
  text.replace(text.rfind("izz=\"1\""), 7, "izz=\"9\"");
  EXPECT_THAT(findings(text), ElementsAre(testing::StartsWith("3:3 W002 link 'arm'"),
                                          testing::StartsWith("13:3 W003 link 'hand'")));
}

TEST(ReadRobot, ACylinderWithRoundEndsIsACapsule) {
  const std::string geometry = "<capsule radius=\"0.1\" length=\"0.2\"/></geometry>";
  const Robot robot = readCleanly(writeFile(
      "robot.urdf", changed(geometry, "<cylinder radius=\"0.1\" length=\"0.2\"/></geometry><capsule/>")));
  const auto& capsule = std::get<description::CapsuleShape>(link(robot, "arm").shapes.at(0));
  EXPECT_EQ(capsule.to, Eigen::Vector3d(0, 0, 0.1));
  EXPECT_EQ(capsule.radius, 0.1);
}

TEST(ReadRobot, TurnsATensorIntoLinkAxes) {
  const Robot robot =
      readCleanly(writeFile("robot.urdf", changed("<inertial><mass value=\"1\"/><inertia ixx=\"1\"",
                                                  "<inertial><origin xyz=\"0.1 0 0\" rpy=\"1.5707963267948966 0 "
                                                  "0\"/><mass value=\"1\"/><inertia ixx=\"1.5\"")));
  const auto& found = link(robot, "arm");
  EXPECT_EQ(found.centre_of_mass, Eigen::Vector3d(0.1, 0, 0));
  EXPECT_TRUE(found.inertia.isApprox(Eigen::Vector3d(1.5, 1, 1).asDiagonal().toDenseMatrix(), 1e-12));
}

}  // namespace
}  // namespace tactus::dsl_test
