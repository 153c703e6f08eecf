// The iCub's model against published positions of its links, against the rules that its comment states, and its left
// side against its right one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "dsl/read_robot.h"
#include "framework/dynamics/kinematics.h"

namespace tactus::dsl_test {
namespace {

using description::Robot;
using Eigen::Vector3d;
using testing::ElementsAre;
using testing::ElementsAreArray;

const Robot& icub() {
  static const Robot robot = [] {
    std::vector<dsl::Diagnostic> warnings;
    Robot read = dsl::readRobot(std::string(TACTUS_SOURCE_DIR) + "/models/icub_arms.urdf", warnings);
    for (const auto& warning : warnings) ADD_FAILURE() << dsl::render(warning);
    return read;
  }();
  return robot;
}

const dynamics::Model& model() {
  static const dynamics::Model made(icub(), dynamics::MassPolicy::required);
  return made;
}

using Positions = std::map<std::string, double>;

/// Pose of a link in another one, with the named coordinates away from 0.
Eigen::Isometry3d pose(const std::string& link, const std::string& in = "root_link", const Positions& positions = {}) {
  Eigen::VectorXd q = model().neutral();
  for (const auto& [name, value] : positions) q[model().jointIndex(name)] = value;
  dynamics::Workspace workspace(model());
  dynamics::forwardKinematics(model(), q, workspace);
  return dynamics::framePose(model(), workspace, model().frameIndex(in)).inverse() *
         dynamics::framePose(model(), workspace, model().frameIndex(link));
}

/// By how much the coordinate turns a link against the one before it, about the joint's axis z.
double turn(const std::string& link, const std::string& before, const Positions& positions) {
  const Eigen::AngleAxisd turned((pose(link, before).inverse() * pose(link, before, positions)).linear());
  return turned.angle() * (turned.axis().z() < 0 ? -1 : 1);
}

bool isPhalanx(const std::string& link) { return link.find("_hand_") != std::string::npos && !link.ends_with("_tip"); }

TEST(ICub, HasThirtyFiveDegreesOfFreedom) {
  std::vector<std::string> names{"torso_pitch", "torso_roll", "torso_yaw"};
  for (const std::string side : {"r_", "l_"})
    for (const char* joint :
         {"shoulder_pitch", "shoulder_roll", "shoulder_yaw", "elbow", "wrist_prosup", "wrist_pitch", "wrist_yaw",
          "hand_thumb_0", "hand_thumb_1", "hand_thumb_2", "hand_index_0", "hand_index_1", "hand_index_2",
          "hand_middle_1", "hand_middle_2", "hand_ring_1"})
      names.push_back(side + joint);
  EXPECT_EQ(model().dof(), 35);
  EXPECT_THAT(model().jointNames(), ElementsAreArray(names));
  EXPECT_EQ(model().bodyCount(), 35 + 2 * 10);                     // ten joints of a hand follow others
}

TEST(ICub, LinksStandWhereItIsPublished) {
  const std::map<std::string, Vector3d> published{{"r_hand", {-0.010620, 0.089898, -0.126560}},
                                                  {"r_hand_index_tip", {-0.039069, 0.094698, -0.266966}},
                                                  {"r_hand_middle_tip", {-0.016495, 0.095941, -0.270194}},
                                                  {"r_hand_thumb_tip", {-0.096026, 0.084421, -0.204254}},
                                                  {"l_hand", {-0.010920, -0.089898, -0.126560}},
                                                  {"l_hand_index_tip", {-0.039369, -0.094698, -0.266966}}};
  for (const auto& [link, position] : published)
    EXPECT_LT((pose(link).translation() - position).cwiseAbs().maxCoeff(), 1e-5) << link;
}

TEST(ICub, DriversTurnWhatFollowsThem) {
  for (const std::string hand : {"r_hand", "l_hand"}) {
    const auto finger = [&](const std::string& name) { return hand + "_" + name; };
    const auto expectTurns = [&](const std::string& driver, double q, const Positions& turns) {
      for (const std::string digit : {"thumb", "index", "middle", "ring", "little"})
        for (int k = 0; k < 4; ++k) {
          const std::string link = digit + "_" + std::to_string(k);
          const std::string before = k == 0 ? hand : finger(digit + "_" + std::to_string(k - 1));
          const auto expected = turns.find(link);
          EXPECT_NEAR(turn(finger(link), before, {{finger(driver), q}}),
                      expected == turns.end() ? 0 : expected->second, 1e-9)
              << driver << " turns " << finger(link);
        }
    };
    expectTurns("thumb_0", 0.5, {{"thumb_0", 0.5}});
    expectTurns("thumb_1", 0.5, {{"thumb_1", 0.5}});
    expectTurns("thumb_2", 0.5, {{"thumb_2", 0.5}, {"thumb_3", 0.5}});
    expectTurns("index_0", -0.3, {{"index_0", -0.3}, {"ring_0", 0.3}, {"little_0", 0.3}});
    expectTurns("index_1", 0.5, {{"index_1", 0.5}});
    expectTurns("index_2", 0.5, {{"index_2", 0.5}, {"index_3", 0.5}});
    expectTurns("middle_1", 0.5, {{"middle_1", 0.5}});
    expectTurns("middle_2", 0.5, {{"middle_2", 0.5}, {"middle_3", 0.5}});
    expectTurns("ring_1", 0.5,
                {{"ring_1", 0.5}, {"ring_2", 0.5}, {"ring_3", 0.5}, {"little_1", 0.5}, {"little_2", 0.5},
                 {"little_3", 0.5}});
  }
}

TEST(ICub, DriversKeepTheLimitsOfWhatFollowsThem) {
  for (const std::string hand : {"r_hand", "l_hand"}) {
    const int spread = model().jointIndex(hand + "_index_0"), ring = model().jointIndex(hand + "_ring_1");
    EXPECT_EQ(model().lower()[spread], -0.349066);
    EXPECT_EQ(model().upper()[spread], 0);
    EXPECT_EQ(model().lower()[ring], 0);
    EXPECT_EQ(model().upper()[ring], 1.5708);
  }
}

TEST(ICub, SpreadTakesFingersApartAndRingClosesThem) {
  for (const std::string hand : {"r_hand", "l_hand"}) {
    const auto gap = [&](const std::string& a, const std::string& b, const Positions& q) {
      return pose(hand + "_" + a, hand + "_" + b, q).translation().norm();
    };
    const Positions spread{{hand + "_index_0", -0.3}}, closed{{hand + "_ring_1", 1.2}};
    EXPECT_GT(gap("index_tip", "middle_tip", spread), gap("index_tip", "middle_tip", {}) + 0.005);
    EXPECT_GT(gap("middle_tip", "little_tip", spread), gap("middle_tip", "little_tip", {}) + 0.005);
    for (const std::string finger : {"ring", "little"})
      EXPECT_LT(gap(finger + "_tip", finger + "_0", closed), 0.6 * gap(finger + "_tip", finger + "_0", {}));
  }
}

TEST(ICub, TheLeftHandMirrorsTheRightOne) {
  Positions right, left;
  double q = 0.1;
  for (const char* motor :
       {"thumb_0", "thumb_1", "thumb_2", "index_1", "index_2", "middle_1", "middle_2", "ring_1"}) {
    right[std::string("r_hand_") + motor] = left[std::string("l_hand_") + motor] = q;
    q += 0.15;
  }
  right["r_hand_index_0"] = left["l_hand_index_0"] = -0.2;
  for (const auto& link : icub().links) {
    if (!link.name.starts_with("r_hand_")) continue;
    const std::string other = "l" + link.name.substr(1);
    const Vector3d p = pose(link.name, "r_hand", right).translation();
    EXPECT_LT((pose(other, "l_hand", left).translation() - Vector3d(-p.x(), p.y(), p.z())).norm(), 1e-8) << link.name;
    EXPECT_EQ(link.mass, icub().links[static_cast<std::size_t>(icub().linkIndex(other))].mass);
  }
}

TEST(ICub, PhalangesAreCapsulesOfTheDensityStated) {
  constexpr double pi = std::numbers::pi, density = 2000;
  int count = 0;
  for (const auto& link : icub().links) {
    if (!isPhalanx(link.name)) continue;
    ++count;
    ASSERT_EQ(link.shapes.size(), 1u) << link.name;
    const auto& capsule = std::get<description::CapsuleShape>(link.shapes[0]);
    const double r = capsule.radius, L = (capsule.to - capsule.from).norm();
    const Vector3d u = (capsule.to - capsule.from) / L;
    const double cylinder = density * pi * r * r * L, sphere = density * 4 / 3 * pi * r * r * r;
    const double along = cylinder * r * r / 2 + sphere * r * r * 2 / 5;
    const double across = cylinder * (L * L / 12 + r * r / 4) + sphere * (r * r * 2 / 5 + L * L / 4 + L * r * 3 / 8);
    const Eigen::Matrix3d inertia = across * Eigen::Matrix3d::Identity() + (along - across) * u * u.transpose();
    EXPECT_EQ(r, 0.0065);
    EXPECT_GE(link.mass, 0.005);
    EXPECT_LE(link.mass, 0.010);
    EXPECT_NEAR(link.mass / (cylinder + sphere), 1, 1e-3) << link.name;
    EXPECT_LT((link.inertia - inertia).norm(), 1e-3 * inertia.norm()) << link.name;
    EXPECT_LT((link.centre_of_mass - (capsule.from + capsule.to) / 2).norm(), 1e-8) << link.name;
  }
  EXPECT_EQ(count, 40);
}

/// From its own joint to the next one; the last one touches with its cap where the tip is.
TEST(ICub, PhalangesReachFromJointToJoint) {
  for (const auto& joint : icub().joints) {
    const auto& parent = icub().links[static_cast<std::size_t>(joint.parent)];
    if (!isPhalanx(parent.name)) continue;
    const auto& capsule = std::get<description::CapsuleShape>(parent.shapes.at(0));
    const double beyond = joint.name.ends_with("_tip") ? capsule.radius : 0;
    EXPECT_LT(capsule.from.norm(), 1e-6) << parent.name;
    EXPECT_NEAR(capsule.to.norm() + beyond, joint.origin.translation().norm(), 1e-6) << parent.name;
    EXPECT_LT(capsule.to.cross(joint.origin.translation()).norm(), 1e-8) << parent.name;
  }
}

TEST(ICub, LinksWithoutPublishedInertiaAreCubesAndPalmsAreBoxes) {
  for (const auto& link : icub().links) {
    if (!link.has_inertial || isPhalanx(link.name)) continue;
    const std::string kind = link.name.substr(link.name[1] == '_' ? 2 : 0);
    if (kind == "chest") {
      EXPECT_EQ(link.inertia.diagonal(), Vector3d(0.0430, 0.0441, 0.0261));
    } else if (kind == "upper_arm") {
      EXPECT_EQ(link.inertia.diagonal(), Vector3d(5.10e-4, 6.69e-4, 5.99e-4));
    } else if (kind == "forearm") {
      EXPECT_EQ(link.inertia.diagonal(), Vector3d(3.70e-4, 6.72e-4, 5.54e-4));
    } else if (kind == "hand") {
      const Vector3d square = std::get<description::BoxShape>(link.shapes.at(0)).size.cwiseAbs2();
      const Vector3d moments = link.mass / 12 * (Vector3d::Constant(square.sum()) - square);
      EXPECT_TRUE(link.inertia.diagonal().isApprox(moments, 1e-3)) << link.name;
    } else {
      const double edge = std::cbrt(link.mass / 2000);
      EXPECT_TRUE(link.inertia.isApprox(link.mass * edge * edge / 6 * Eigen::Matrix3d::Identity(), 1e-3)) << link.name;
    }
  }
}

TEST(ICub, SkinIsThePhalangesAndGroupsHoldWhatTheirNamesSay) {
  for (const std::string& link : icub().skin) EXPECT_TRUE(isPhalanx(link)) << link;
  EXPECT_EQ(icub().skin.size(), 40u);
  const auto sizes = [](const std::vector<description::Group>& groups) {
    std::vector<std::string> listed;
    for (const auto& group : groups) listed.push_back(group.name + " " + std::to_string(group.members.size()));
    return listed;
  };
  EXPECT_THAT(sizes(icub().link_groups),
              ElementsAre("torso 3", "right_arm 7", "left_arm 7", "right_hand 26", "left_hand 26", "right_fingers 16",
                          "left_fingers 16", "right_thumb 4", "left_thumb 4", "right_tips 5", "left_tips 5"));
  EXPECT_THAT(sizes(icub().joint_groups),
              ElementsAre("torso 3", "right_arm 7", "left_arm 7", "right_hand 9", "left_hand 9", "right_thumb 3",
                          "left_thumb 3", "right_fingers 6", "left_fingers 6"));
}

}  // namespace
}  // namespace tactus::dsl_test
