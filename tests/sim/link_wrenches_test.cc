// Wrenches through joints: statics and F = m a by hand, and two laws on a chain that swings: about each axis the wrench
// is the joint's torque, and through a fixed joint it is what the parts on one side need.

#include "sim/link_wrenches.h"

#include <gtest/gtest.h>

#include <random>

#include "sim/simbody_plant.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using control::LinkWrench;
using description::JointType;
using Eigen::Vector3d;
using sim_tests::addJoint;
using sim_tests::at;

constexpr double kTick = 1e-3, kStep = 0.25e-3;

PlantOptions asking(std::vector<int> links) {
  PlantOptions options;
  options.wrench_links = std::move(links);
  return options;
}

/// A bob of 2 kg half a metre from a hinge about y, and a tool of 0.3 kg fixed at the bob.
description::Robot swing() {
  description::Robot robot = sim_tests::world();
  addJoint(robot, "hinge", JointType::revolute, Vector3d::UnitY(), 2, 0.01);
  robot.links.back().centre_of_mass = {0.5, 0, 0};
  description::Joint& mount = addJoint(robot, "tool", JointType::fixed, Vector3d::UnitX(), 0.3, 1e-3);
  mount.origin = at(0.6, 0, 0) * Eigen::AngleAxisd(0.5 * M_PI, Vector3d::UnitX());
  robot.links.back().centre_of_mass = {0.1, 0, 0};
  return robot;
}

TEST(LinkWrenches, AreNotToldBeforeTheFirstStepNorUnasked) {
  SimbodyPlant plant(swing(), {}, Eigen::VectorXd::Zero(1), asking({1}));
  EXPECT_TRUE(plant.sense().wrenches.empty());
  plant.advance(Eigen::VectorXd::Zero(1), kTick);
  ASSERT_EQ(plant.sense().wrenches.size(), 1u);
  EXPECT_EQ(plant.sense().wrenches[0].link, 1);
  SimbodyPlant silent(swing(), {}, Eigen::VectorXd::Zero(1));
  silent.advance(Eigen::VectorXd::Zero(1), kTick);
  EXPECT_TRUE(silent.sense().wrenches.empty());
}

TEST(LinkWrenches, OfAMassThatIsHeldAreItsWeightAndItsMoment) {
  SimbodyPlant plant(swing(), {}, Eigen::VectorXd::Zero(1), asking({1, 2}));
  // A positive turn about y takes the bob down.
  const double moment = -9.81 * (2 * 0.5 + 0.3 * 0.7);
  plant.advance(Eigen::VectorXd::Constant(1, moment), kTick);
  ASSERT_NEAR(plant.sense().q[0], 0, 1e-9);
  const LinkWrench& hinge = plant.sense().wrenches[0];
  EXPECT_LT((hinge.force_L - Vector3d(0, 0, 2.3 * 9.81)).norm(), 1e-6);
  EXPECT_LT((hinge.moment_L - Vector3d(0, moment, 0)).norm(), 1e-6);
  const LinkWrench& tool = plant.sense().wrenches[1];
  EXPECT_LT((tool.force_L - Vector3d(0, 0.3 * 9.81, 0)).norm(), 1e-6) << "its y axis points up";
  EXPECT_LT((tool.moment_L - Vector3d(0, 0, 0.3 * 9.81 * 0.1)).norm(), 1e-6);
}

TEST(LinkWrenches, OfAMassThatFallsAreNone) {
  description::Robot robot = sim_tests::world();
  addJoint(robot, "z", JointType::prismatic, Vector3d::UnitZ(), 1.5, 0.01);
  SimbodyPlant plant(robot, {}, Eigen::VectorXd::Zero(1), asking({1}));
  plant.advance(Eigen::VectorXd::Zero(1), kTick);
  EXPECT_LT(plant.sense().wrenches[0].force_L.norm(), 1e-9);
}

TEST(LinkWrenches, OfAMassThatIsPushedAreItsMassTimesItsAcceleration) {
  description::Robot robot = sim_tests::world();
  addJoint(robot, "x", JointType::prismatic, Vector3d::UnitX(), 1.5, 0.01);
  addJoint(robot, "load", JointType::fixed, Vector3d::UnitX(), 0.5, 0.01);
  robot.joints.back().origin = at(0, 0, 0.2);
  SimbodyPlant plant(robot, {}, Eigen::VectorXd::Zero(1), asking({2}));
  plant.advance(Eigen::VectorXd::Constant(1, 6), kTick);  // 3 m/s²
  EXPECT_NEAR(plant.sense().qd[0], 3 * kTick, 1e-9);
  EXPECT_LT((plant.sense().wrenches[0].force_L - Vector3d(0.5 * 3, 0, 0.5 * 9.81)).norm(), 1e-6);
  EXPECT_LT(plant.sense().wrenches[0].moment_L.norm(), 1e-6);
}

/// Four turning joints about different axes, with rotors, a branch and a tool on a fixed joint.
description::Robot chain(std::mt19937& random) {
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  description::Robot robot = sim_tests::world();
  for (int i = 0; i < 6; ++i) {
    const bool fixed = i == 2 || i == 5;
    description::Joint& joint =
        addJoint(robot, "j" + std::to_string(i), fixed ? JointType::fixed : JointType::revolute,
                 Vector3d(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized(), uniform(0.2, 2),
                 uniform(1e-3, 1e-2));
    joint.origin = at(uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(0.1, 0.3)) *
                   Eigen::AngleAxisd(uniform(-1, 1), Vector3d::UnitX());
    joint.rotor_inertia = fixed ? 0 : 1e-2;
    if (i == 4) joint.parent = 3;                                  // beside the link before it
    for (double& x : robot.links.back().centre_of_mass) x = uniform(-0.1, 0.1);
  }
  return robot;
}

TEST(LinkWrenches, AboutAJointsAxisAreItsTorque) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 20; ++trial) {
    const description::Robot robot = chain(random);
    const std::vector<int> moving = robot.movingJoints();
    std::vector<int> links;
    for (const int joint : moving) links.push_back(robot.joints[joint].child);
    SimbodyPlant plant(robot, {}, Eigen::VectorXd::Random(static_cast<int>(moving.size())), asking(links));
    for (int k = 0; k < 20; ++k) {
      const Eigen::VectorXd torque = 2 * Eigen::VectorXd::Random(static_cast<int>(moving.size()));
      plant.advance(torque, kTick);
      for (std::size_t i = 0; i < moving.size(); ++i)
        EXPECT_NEAR(plant.sense().wrenches[i].moment_L.dot(robot.joints[moving[i]].axis),
                    torque[static_cast<Eigen::Index>(i)], 1e-9);
    }
  }
}

/// A foot that stands on the floor under a load, on a joint that is fixed, so that it parts a body, or moves.
TEST(LinkWrenches, OfAFootThatStandsAreTheLoadAboveIt) {
  for (const bool fixed : {true, false}) {
    description::Robot robot = sim_tests::world();
    addJoint(robot, "z", JointType::prismatic, Vector3d::UnitZ(), 0.3, 1e-3);
    addJoint(robot, "foot", fixed ? JointType::fixed : JointType::revolute, Vector3d::UnitX(), 0.1, 1e-4);
    robot.joints.back().origin = at(0.05, 0, 0);
    robot.links.back().shapes = {sim_tests::sphere(0.02)};
    description::Scene scene;
    scene.objects = {sim_tests::object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>())};
    Eigen::VectorXd start = Eigen::VectorXd::Zero(fixed ? 1 : 2);
    start[0] = 0.019;
    SimbodyPlant plant(robot, scene, start, asking({1, 2}));
    for (int k = 0; k < 3000; ++k) plant.advance(Eigen::VectorXd::Zero(start.size()), kTick);
    ASSERT_LT(plant.sense().qd.norm(), 1e-6);
    const LinkWrench& slide = plant.sense().wrenches[0];
    EXPECT_NEAR(slide.force_L.z(), 0, 1e-4) << "the floor bears all";
    EXPECT_NEAR(slide.moment_L.y(), 0.05 * 0.3 * 9.81, 1e-4) << "in a slide that does not tilt";
    const LinkWrench& foot = plant.sense().wrenches[1];
    EXPECT_NEAR(foot.force_L.z(), -0.3 * 9.81, 1e-4) << "what stands on it presses down";
    EXPECT_NEAR(foot.moment_L.norm(), 0, 1e-5);
  }
}

/// A hammer on a slide presses on an anvil that a fixed joint parts from the world's body, or from that of a second
/// slide.
TEST(LinkWrenches, OfALinkThatAnotherOneTouchesAreWhatItPresses) {
  for (const bool anvil_is_box : {false, true}) {
    description::Robot robot = sim_tests::world();
    addJoint(robot, "carrier", JointType::prismatic, Vector3d::UnitZ(), 0.2, 1e-4);
    addJoint(robot, "anvil", JointType::fixed, Vector3d::UnitX(), 0.1, 1e-4);
    if (anvil_is_box)
      robot.links.back().shapes = {description::BoxShape{at(0, 0, 0), {0.04, 0.04, 0.04}}};
    else
      robot.links.back().shapes = {sim_tests::sphere(0.02)};
    addJoint(robot, "hammer", JointType::prismatic, Vector3d::UnitZ(), 0.3, 1e-4).parent = 0;
    robot.links.back().shapes = {sim_tests::sphere(0.02)};
    robot.self_contact = {{2, 3}};
    description::Scene scene;
    scene.gravity.setZero();
    SimbodyPlant plant(robot, scene, Eigen::Vector2d(0, 0.0405), asking({2}));
    for (int k = 0; k < 6000; ++k) {
      const Eigen::VectorXd torque = Eigen::Vector2d(2, -2) - 3 * plant.sense().qd;
      plant.advance(torque, kTick);
    }
    ASSERT_LT(plant.sense().qd.norm(), 1e-6);
    ASSERT_EQ(plant.sense().contacts.size(), 1u);
    EXPECT_EQ(plant.sense().contacts[0].link, anvil_is_box ? 3 : 2) << "a box is felt, else the first of the two feels";
    EXPECT_NEAR(plant.sense().wrenches[0].force_L.z(), 2, 1e-4) << "its joint presses it up, against the hammer";
  }
}

}  // namespace
}  // namespace tactus::sim
