// The pendulum of one link has dynamics that can be written down; the shipped arm has its own consistency.

#include <gmock/gmock.h>

#include <cmath>

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
  EXPECT_THAT(outcome.err, HasSubstr("--q has 2 numbers, but the robot has 1 degrees of freedom: hinge"));
}

TEST(DynamicsCommand, NumbersThatAreNone) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"dynamics", folder.write("p.urdf", pendulum), "--q", "0,3x", "--json"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--q: '3x' is not a finite number"));
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
  EXPECT_THAT(outcome.err, HasSubstr("bob"));
  EXPECT_THAT(outcome.err, HasSubstr("kinematics only"));
}

TEST(DynamicsCommand, UnknownRobotListsWhereItWasSought) {
  const Outcome outcome = tactus({"dynamics", "nobody", "--q", "0"});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("share/tactus/models/nobody.urdf"));
  EXPECT_THAT(outcome.err, HasSubstr("lwr_allegro"));
}

}  // namespace
}  // namespace tactus::testing
