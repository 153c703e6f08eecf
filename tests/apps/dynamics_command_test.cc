// The pendulum of one link has dynamics that can be written down; the shipped arm has its own consistency.

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <cmath>
#include <fstream>
#include <thread>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::HasSubstr;

constexpr const char* pendulum = R"(<robot name="pendulum">
  <link name="base"/>
  <joint name="hinge" type="revolute">
    <parent link="base"/><child link="bob"/><origin xyz="0 0 1"/><axis xyz="0 1 0"/>
    <limit lower="-3" upper="3" effort="10" velocity="10"/>
  </joint>
  <link name="bob">
    <inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
      <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial>
  </link>
  <joint name="mount" type="fixed"><parent link="bob"/><child link="tip"/><origin xyz="0 0 -1"/></joint>
  <link name="tip"/>
</robot>
)";

TEST(DynamicsCommand, PendulumByHand) {
  const TemporaryFolder folder;
  const double q = 0.3, inertia = 2 * 0.25 + 0.01, gravity = 2 * 9.81 * 0.5 * std::sin(q);
  const Outcome outcome = tactus(
      {"dynamics", folder.write("p.urdf", pendulum), "--q", "0.3", "--qd", "-2", "--qdd", "4", "--tau", "1", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["joints"], nlohmann::json({"hinge"}));
  EXPECT_NEAR(json["mass_matrix"][0][0].get<double>(), inertia, 1e-12);
  EXPECT_NEAR(json["gravity"][0].get<double>(), gravity, 1e-12);
  EXPECT_NEAR(json["bias"][0].get<double>(), gravity, 1e-12);  // one joint has no Coriolis torque
  EXPECT_NEAR(json["inverse_dynamics"][0].get<double>(), inertia * 4 + gravity, 1e-12);
  EXPECT_NEAR(json["forward_dynamics"][0].get<double>(), (1 - gravity) / inertia, 1e-10);
  const nlohmann::json tip = json["frames"]["tip"];
  EXPECT_NEAR(tip["position"][0].get<double>(), -std::sin(q), 1e-12);
  EXPECT_NEAR(tip["position"][2].get<double>(), 1 - std::cos(q), 1e-12);
  EXPECT_NEAR(tip["rotation"][0][2].get<double>(), std::sin(q), 1e-12);
  ASSERT_EQ(tip["jacobian"].size(), 6u);
  EXPECT_NEAR(tip["jacobian"][0][0].get<double>(), -std::cos(q), 1e-12);
  EXPECT_NEAR(tip["jacobian"][2][0].get<double>(), std::sin(q), 1e-12);
  EXPECT_NEAR(tip["jacobian"][4][0].get<double>(), 1, 1e-12);
  EXPECT_EQ(json["frames"].size(), 3u);
  EXPECT_EQ(json["positions"], nlohmann::json({"hinge"}));
  EXPECT_EQ(json["dof"], 1);
  EXPECT_EQ(json["mass"], 2);
  EXPECT_NEAR(json["centre_of_mass"][0].get<double>(), -0.5 * std::sin(q), 1e-12);
  EXPECT_NEAR(json["centre_of_mass"][1].get<double>(), 0, 1e-12);
  EXPECT_NEAR(json["centre_of_mass"][2].get<double>(), 1 - 0.5 * std::cos(q), 1e-12);
  EXPECT_NEAR(json["kinetic_energy"].get<double>(), 0.5 * inertia * 4, 1e-12);
  EXPECT_NEAR(json["potential_energy"].get<double>(), 2 * 9.81 * (1 - 0.5 * std::cos(q)), 1e-12);
}

/// A pendulum with a second one beside it that turns twice as far, from another start.
TEST(DynamicsCommand, CoupledPendulumsByHand) {
  const TemporaryFolder folder;
  std::string robot = pendulum;
  robot.insert(robot.find("  <link name=\"tip\"/>"), R"(  <joint name="other" type="continuous">
    <parent link="base"/><child link="echo"/><axis xyz="0 1 0"/><mimic joint="hinge" multiplier="2" offset="0.1"/>
  </joint>
  <link name="echo">
    <inertial><origin xyz="0 0 -0.2"/><mass value="3"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02"/></inertial>
  </link>
)");
  const double q = 0.3, inertia = 2 * 0.25 + 0.01 + 4 * (3 * 0.04 + 0.02);
  const double gravity = 9.81 * (2 * 0.5 * std::sin(q) + 2 * 3 * 0.2 * std::sin(2 * q + 0.1));
  const Outcome outcome = tactus(
      {"dynamics", folder.write("p.urdf", robot), "--q", "0.3", "--qd", "-2", "--qdd", "4", "--tau", "1", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["joints"], nlohmann::json({"hinge"}));
  EXPECT_NEAR(json["mass_matrix"][0][0].get<double>(), inertia, 1e-12);
  EXPECT_NEAR(json["bias"][0].get<double>(), gravity, 1e-12);
  EXPECT_NEAR(json["inverse_dynamics"][0].get<double>(), inertia * 4 + gravity, 1e-12);
  EXPECT_NEAR(json["forward_dynamics"][0].get<double>(), (1 - gravity) / inertia, 1e-10);
  EXPECT_NEAR(json["kinetic_energy"].get<double>(), 0.5 * inertia * 4, 1e-12);
  EXPECT_NEAR(json["frames"]["echo"]["jacobian"][4][0].get<double>(), 2, 1e-12);
}

constexpr const char* brick = R"(<robot name="brick">
  <link name="body">
    <inertial><origin xyz="0 0.5 0"/><mass value="2"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.25"/></inertial>
  </link>
</robot>
)";

TEST(DynamicsCommand, AFloatingBaseFalls) {
  const TemporaryFolder folder;
  // A quarter turn about z, written with few digits; then 3 m/s along the world's x and 4 rad/s about the brick's z.
  const Outcome outcome =
      tactus({"dynamics", folder.write("brick.urdf", brick), "--floating-base", "--q", "1,2,3,0.7071,0,0,0.7071",
              "--qd", "3,0,0,0,0,4", "--tau", "0,0,0,0,0,0", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["joints"], nlohmann::json({"floating_base.x", "floating_base.y", "floating_base.z", "floating_base.wx",
                                            "floating_base.wy", "floating_base.wz"}));
  EXPECT_EQ(json["positions"],
            nlohmann::json({"floating_base.x", "floating_base.y", "floating_base.z", "floating_base.qw",
                            "floating_base.qx", "floating_base.qy", "floating_base.qz"}));
  EXPECT_EQ(json["dof"], 6);
  EXPECT_EQ(json["mass"], 2);
  const double centre[] = {1 - 0.5, 2, 3};                         // 0.5 along the brick's y, which is −x
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(json["centre_of_mass"][i].get<double>(), centre[i], 1e-12);
  // The centre moves with (3, 0, 0) + ω × (−0.5, 0, 0) = (3, −2, 0).
  EXPECT_NEAR(json["kinetic_energy"].get<double>(), 0.5 * 2 * (9 + 4) + 0.5 * 0.25 * 16, 1e-12);
  EXPECT_NEAR(json["potential_energy"].get<double>(), 2 * 9.81 * 3, 1e-12);
  // The centre falls; the origin moves on a circle about it: a = g + ω²·0.5 towards the centre.
  const double acceleration[] = {-8, 0, -9.81, 0, 0, 0};
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(json["forward_dynamics"][i].get<double>(), acceleration[i], 1e-9) << i;
}

TEST(DynamicsCommand, EveryTypeOfJoint) {
  const TemporaryFolder folder;
  std::string robot = R"(<robot name="all"><link name="l0"/>)";
  const char* types[] = {"planar", "spherical", "floating", "prismatic"};
  for (size_t i = 0; i < 4; ++i) {
    const std::string above = std::to_string(i), below = std::to_string(i + 1);
    robot += std::string("<joint name=\"") + types[i] + "\" type=\"" + types[i] + "\"><parent link=\"l" + above +
             "\"/><child link=\"l" + below + "\"/>" + (i == 3 ? "<limit effort=\"1\" velocity=\"1\"/>" : "") +
             "</joint><link name=\"l" + below +
             "\"><inertial><origin xyz=\"0.1 0.2 0.3\"/><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" "
             "iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>";
  }
  const std::string file = folder.write("all.urdf", robot + "</robot>");
  const std::string q = "0.1,0.2,0.3,0.5,0.5,-0.5,0.5,1,2,3,0,0.6,0,0.8,0.4", qd = "1,2,3,4,5,6,7,8,9,1,2,3,4",
                    qdd = "1,-2,3,-4,5,-6,7,-8,9,-1,2,-3,4";
  const Outcome there = tactus({"dynamics", file, "--q", q, "--qd", qd, "--qdd", qdd, "--json"});
  ASSERT_EQ(there.exit_code, 0) << there.err;
  std::string tau;
  const nlohmann::json torques = there.json()["inverse_dynamics"];
  for (const nlohmann::json& torque : torques) tau += (tau.empty() ? "" : ",") + torque.dump();
  const nlohmann::json back = tactus({"dynamics", file, "--q", q, "--qd", qd, "--tau", tau, "--json"}).json();
  EXPECT_EQ(back["dof"], 13);
  EXPECT_EQ(back["positions"].size(), 15u);
  const double expected[] = {1, -2, 3, -4, 5, -6, 7, -8, 9, -1, 2, -3, 4};
  for (size_t i = 0; i < 13; ++i) EXPECT_NEAR(back["forward_dynamics"][i].get<double>(), expected[i], 1e-8) << i;

  const Outcome rates = tactus({"dynamics", file, "--q", qd, "--json"});
  EXPECT_EQ(rates.exit_code, 2);
  EXPECT_THAT(rates.err, HasSubstr("--q has 13 numbers, but the robot has 15 positions: planar.x, planar.y, "
                                   "planar.angle, spherical.qw, spherical.qx, spherical.qy, spherical.qz, floating.x, "
                                   "floating.y, floating.z, floating.qw, floating.qx, floating.qy, floating.qz, "
                                   "prismatic"));
  const Outcome positions = tactus({"dynamics", file, "--q", q, "--qd", q, "--json"});
  EXPECT_EQ(positions.exit_code, 2);
  EXPECT_THAT(positions.err, HasSubstr("--qd has 15 numbers, but the robot has 13 degrees of freedom: planar.x, "
                                       "planar.y, planar.angle, spherical.wx, spherical.wy, spherical.wz, floating.x, "
                                       "floating.y, floating.z, floating.wx, floating.wy, floating.wz, prismatic"));
}

TEST(DynamicsCommand, AQuaternionThatIsNone) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus(
      {"dynamics", folder.write("brick.urdf", brick), "--floating-base", "--q", "1,2,3,0.5,0,0,0", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("--q: the quaternion w,x,y,z of joint 'floating_base' has length 0.5, expected 1"));
}

TEST(DynamicsCommand, AFloatingBaseNeedsItsNames) {
  const TemporaryFolder folder;
  std::string robot = brick;
  robot.replace(robot.find("\"body\""), 6, "\"world\"");
  const Outcome outcome = tactus(
      {"dynamics", folder.write("brick.urdf", robot), "--floating-base", "--q", "1,2,3,1,0,0,0", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--floating-base adds a link 'world' and a joint 'floating_base', but the robot "
                                     "has one of that name already: give it another one"));
}

TEST(DynamicsCommand, ABaseWithoutMassFloatsInKinematicsAlone) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus(
      {"dynamics", folder.write("p.urdf", pendulum), "--floating-base", "--q", "1,2,3,1,0,0,0,0", "--json"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("link 'base' moves but has no mass"));
  EXPECT_FALSE(outcome.json().contains("mass"));
  EXPECT_EQ(outcome.json()["frames"]["tip"]["position"], nlohmann::json({1.0, 2.0, 3.0}));
}

TEST(DynamicsCommand, WithoutGravity) {
  const TemporaryFolder folder;
  const Outcome outcome =
      tactus({"dynamics", folder.write("p.urdf", pendulum), "--q", "0.3", "--gravity", "0,0,0", "--json"});
  EXPECT_EQ(outcome.json()["gravity"][0].get<double>(), 0);
  EXPECT_FALSE(outcome.json().contains("inverse_dynamics"));
  EXPECT_FALSE(outcome.json().contains("forward_dynamics"));
}

TEST(DynamicsCommand, ShippedRobotByItsName) {
  const Outcome outcome = tactus({"dynamics", "lwr_4plus", "--q", "0.1,-0.2,0.3,-0.4,0.5,-0.6,0.7", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json mass = outcome.json()["mass_matrix"];
  ASSERT_EQ(mass.size(), 7u);
  for (size_t i = 0; i < 7; ++i) {
    EXPECT_GT(mass[i][i].get<double>(), 0);
    for (size_t j = 0; j < 7; ++j) EXPECT_EQ(mass[i][j], mass[j][i]);
  }
}

TEST(DynamicsCommand, WrongNumberOfPositionsNamesTheJoints) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"dynamics", folder.write("p.urdf", pendulum), "--q", "0.3,0.1", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--q has 2 numbers, but the robot has 1 degree of freedom: hinge"));
}

TEST(DynamicsCommand, NumbersThatAreNone) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"dynamics", folder.write("p.urdf", pendulum), "--q", "0,3x", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--q: '3x' is not a number"));
}

TEST(DynamicsCommand, RobotWithoutMassesHasKinematicsAlone) {
  const TemporaryFolder folder;
  std::string massless = pendulum;
  const size_t from = massless.find("<inertial>"), to = massless.find("</inertial>") + 11;
  massless.erase(from, to - from);
  const Outcome outcome = tactus({"dynamics", folder.write("p.urdf", massless), "--q", "0.3", "--json"});
  EXPECT_EQ(outcome.exit_code, 0);
  const nlohmann::json json = outcome.json();
  EXPECT_FALSE(json.contains("mass_matrix"));
  EXPECT_NEAR(json["frames"]["tip"]["position"][0].get<double>(), -std::sin(0.3), 1e-12);
  EXPECT_EQ(json["kinematics_only"], true);
  EXPECT_THAT(outcome.err, HasSubstr("p.urdf:7:3: link 'bob' moves but has no mass: give it an <inertial> with mass "
                                     "and inertia, or join it by a fixed joint to a link that has them; kinematics "
                                     "only\n"));
}

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(DynamicsCommand, DynamicsOfARobotWithoutMassesAreRefused) {
  const TemporaryFolder folder;
  const std::string massless = folder.write("p.urdf", changed(pendulum, "mass value=\"2\"", "mass value=\"0\""));
  for (const char* option : {"--tau", "--qdd"}) {
    const Outcome outcome = tactus({"dynamics", massless, "--q", "0.3", option, "1"});
    EXPECT_EQ(outcome.exit_code, 3) << option;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr("p.urdf:7:3: link 'bob' moves but has no mass"));
  }
  const std::string impossible = folder.write("i.urdf", changed(pendulum, "izz=\"0.01\"", "izz=\"0.9\""));
  EXPECT_EQ(tactus({"dynamics", impossible, "--tau", "1"}).exit_code, 3);
  const Outcome kinematics = tactus({"dynamics", impossible, "--q", "0.3"});
  EXPECT_EQ(kinematics.exit_code, 0);
  EXPECT_EQ(kinematics.json()["kinematics_only"], true);
  EXPECT_EQ(tactus({"dynamics", folder.write("s.urdf", pendulum)}).json()["kinematics_only"], false);
}

TEST(DynamicsCommand, AResultThatIsNotFiniteIsAFailureThatNamesIt) {
  const TemporaryFolder folder;
  const std::string sound = folder.write("sound.urdf", pendulum);
  const auto expectFailure = [](const std::vector<std::string>& arguments, const std::string& quantity) {
    const Outcome outcome = tactus(arguments);
    EXPECT_EQ(outcome.exit_code, 5) << quantity;
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr("tactus: " + quantity + " is not finite: numbers of the robot or of the "
                                                               "command line are too large\n"));
  };
  expectFailure({"dynamics", sound, "--qd", "1e200"}, "bias");
  expectFailure({"dynamics", sound, "--gravity", "1e308,1e308,-1e308", "--q", "0.7"}, "bias");
  expectFailure({"dynamics", "lwr_4plus", "--qd", "1e200,1e200,1e200,1e200,1e200,1e200,1e200", "--q",
                 "0.1,0.2,0.3,0.4,0.5,0.6,0.7"}, "bias");
  expectFailure({"dynamics", sound, "--tau", "1e308"}, "forward_dynamics");
  const auto with = [&](const std::string& from, const std::string& to) {
    return folder.write("changed.urdf", changed(pendulum, from, to));
  };
  expectFailure({"dynamics", with("0 0 -0.5", "0 0 -1e200")}, "the mass matrix");
  std::string long_one = changed(pendulum, "mass value=\"2\"", "mass value=\"0\"");
  for (const char* origin : {"xyz=\"0 0 1\"", "xyz=\"0 0 -1\""})
    long_one = changed(long_one, origin, "xyz=\"0 0 -1e308\"");
  expectFailure({"dynamics", folder.write("long.urdf", long_one)}, "the pose of link 'tip'");
  std::string follower = pendulum;
  follower.insert(follower.find("  <link name=\"tip\"/>"), R"(  <joint name="other" type="continuous">
    <parent link="base"/><child link="echo"/><axis xyz="0 1 0"/><mimic joint="hinge" multiplier="1e300"/>
  </joint>
  <link name="echo"><inertial><mass value="1"/>
    <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link>
)");
  expectFailure({"dynamics", folder.write("f.urdf", follower), "--tau", "1"}, "the mass matrix");
}

TEST(DynamicsCommand, FarFromTheOriginDigitsAreLostAndThatIsSaid) {
  const TemporaryFolder folder;
  const std::string file = folder.write("brick.urdf", changed(brick, "0 0.5 0", "0.1 0.2 0.3"));
  const auto atDistance = [&](const std::string& x) {
    return tactus({"dynamics", file, "--floating-base", "--q", x + ",0,0,0.5,0.5,0.5,0.5"});
  };
  EXPECT_THAT(atDistance("1000").err, ::testing::Not(HasSubstr("W009")));
  const Outcome far = atDistance("1e6");
  EXPECT_EQ(far.exit_code, 0) << far.err;
  EXPECT_THAT(far.err, HasSubstr("brick.urdf:1:1: warning[W009]: the inertia at joint 'floating_base' keeps about"));
  EXPECT_THAT(far.err, HasSubstr("what it carries lies 1e+06 m from the world's origin, bring it nearer"));
  const Outcome eaten = atDistance("1e9");
  EXPECT_EQ(eaten.exit_code, 5);
  EXPECT_EQ(eaten.out, "");
  EXPECT_THAT(eaten.err, HasSubstr("brick.urdf:1:1: the mass matrix is not positive definite: rounding has eaten it"));
}

TEST(DynamicsCommand, WithoutPositionsTheNeutralPose) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"dynamics", folder.write("brick.urdf", brick), "--floating-base"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["q"], nlohmann::json({0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0}));
}

TEST(DynamicsCommand, LimitsAndDrivenJointsAreListed) {
  const TemporaryFolder folder;
  std::string robot = pendulum;
  robot.insert(robot.find("  <link name=\"tip\"/>"), R"(  <joint name="other" type="continuous">
    <parent link="base"/><child link="echo"/><axis xyz="0 1 0"/><mimic joint="hinge" multiplier="2" offset="0.1"/>
  </joint>
  <joint name="wheel" type="continuous"><parent link="base"/><child link="rim"/></joint>
  <link name="echo"/><link name="rim"/>
)");
  const Outcome outcome = tactus({"dynamics", folder.write("p.urdf", robot), "--q", "4,5"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = outcome.json(), none;
  EXPECT_EQ(json["limits"]["lower"], nlohmann::json({-3.0, none}));
  EXPECT_EQ(json["limits"]["upper"], nlohmann::json({3.0, none}));
  EXPECT_EQ(json["limits"]["velocity"], nlohmann::json({10.0, none}));
  EXPECT_EQ(json["limits"]["effort"], nlohmann::json({10.0, none}));
  EXPECT_EQ(json["driven"], nlohmann::json::parse(R"({"other": {"driver": "hinge", "ratio": 2.0, "offset": 0.1}})"));
  EXPECT_THAT(outcome.err, HasSubstr("tactus dynamics: warning: joint 'hinge' is at 4, outside its limits -3 and 3\n"));
  EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("'wheel' is at")));
}

TEST(DynamicsCommand, AnOptionThatEndsWithItsEqualsTakesNothing) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"dynamics", folder.write("p.urdf", pendulum), "--q=", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err, "tactus: '--q=' has no value\ntry 'tactus --help'\n");
}

TEST(DynamicsCommand, WarningsComeWithErrorsToo) {
  const TemporaryFolder folder;
  std::string robot = changed(pendulum, "izz=\"0.01\"", "izz=\"0.9\"");
  robot.insert(robot.find("</robot>"), "  <joint name=\"f\" type=\"planar\"><parent link=\"tip\"/><child link=\"a\"/>"
               "</joint><joint name=\"f.x\" type=\"continuous\"><parent link=\"a\"/><child link=\"b\"/></joint>"
               "<link name=\"a\"/><link name=\"b\"/>\n");
  const Outcome outcome = tactus({"dynamics", folder.write("p.urdf", robot)});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("error[E087]: joints 'f' (line 13) and 'f.x' both have a coordinate 'f.x'"));
  EXPECT_THAT(outcome.err, HasSubstr("p.urdf:7:3: warning[W003]: link 'bob' has an inertia tensor"));
}

TEST(DynamicsCommand, UnknownRobotListsWhereItWasSought) {
  const Outcome outcome = tactus({"dynamics", "nobody", "--q", "0"});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("share/tactus/models/nobody.urdf"));
  EXPECT_THAT(outcome.err, HasSubstr("lwr_allegro"));
  EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("did you mean")));
}

TEST(DynamicsCommand, WhatIsNoFileIsToldApart) {
  const TemporaryFolder folder;
  const Outcome misspelt = tactus({"dynamics", "lwr_4pls"});
  EXPECT_EQ(misspelt.exit_code, 6);
  EXPECT_THAT(misspelt.err, HasSubstr("lwr_4pls: is neither a file nor the name of a robot; did you mean "
                                      "'lwr_4plus'?; tried "));
  const Outcome directory = tactus({"dynamics", folder.file("")});
  EXPECT_EQ(directory.exit_code, 6);
  EXPECT_THAT(directory.err, HasSubstr("is a folder; expected a URDF file or the name of a robot"));
  const Outcome empty = tactus({"dynamics", ""});
  EXPECT_EQ(empty.exit_code, 2);
  EXPECT_THAT(empty.err, HasSubstr("MODEL is empty: name a URDF file or a robot"));
}

TEST(DynamicsCommand, ARobotThroughAPipe) {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe) << pendulum; });
  const Outcome outcome = tactus({"dynamics", pipe, "--q", "0.3"});
  writer.join();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["joints"], nlohmann::json({"hinge"}));
}

}  // namespace
}  // namespace tactus::testing
