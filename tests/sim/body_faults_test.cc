// Bodies that weigh other than they are described, and bodies that somebody shoves.
//
// Strategy: a plant that is told of a fault moves as one that is built so; momentum is the impulse that was given,
// whatever part of a step it lasts; wrenches through joints feel both.

#include <gtest/gtest.h>

#include "framework/geometry/primitives.h"
#include "sim/simbody_plant.h"
#include "sim/wrong_mass.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using description::JointType;
using description::Shove;
using description::WrongMass;
using Eigen::Vector3d;
using sim_tests::addJoint;
using sim_tests::at;

constexpr double kTick = 1e-3, kForever = description::infinity;
const Eigen::VectorXd nothing;

/// Two hinges about y, and a tool that is fixed at the second link, turned.
description::Robot arm() {
  description::Robot robot = sim_tests::world();
  for (const char* name : {"shoulder", "elbow"}) {
    description::Joint& joint = addJoint(robot, name, JointType::revolute, Vector3d::UnitY(), 1, 0.01);
    if (std::string(name) == "elbow") joint.origin = at(0.4, 0, 0);
    robot.links.back().centre_of_mass = {0.2, 0.01, 0};
  }
  addJoint(robot, "tool", JointType::fixed, Vector3d::UnitX(), 0.3, 1e-3).origin =
      at(0.4, 0, 0) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized());
  robot.links.back().centre_of_mass = {0.05, 0, 0};
  return robot;
}
constexpr int kElbow = 2, kTool = 3;                               // links

Eigen::Matrix3d toolAxes() { return arm().joints[2].origin.linear(); }

/// The torques that bear the weight of the stretched arm; a positive turn about y takes it down.
Eigen::Vector2d holding() {
  const double tool_x = 0.4 + (toolAxes() * Vector3d(0.05, 0, 0)).x();  // from the elbow
  return -9.81 * Eigen::Vector2d(0.2 + 0.6 + 0.3 * (0.4 + tool_x), 0.2 + 0.3 * tool_x);
}

description::Scene ball() {
  description::Scene scene;
  description::Object object = sim_tests::object("ball", at(0, 0, 5), std::make_shared<geometry::Sphere>(0.02));
  object.mobility = description::Mobility::free;
  object.mass = {0.1, Vector3d::Zero(), 1e-5 * Eigen::Matrix3d::Identity()};
  scene.objects = {object};
  return scene;
}

PlantOptions with(std::vector<WrongMass> masses, std::vector<Shove> shoves = {}, std::vector<int> wrench_links = {}) {
  PlantOptions options;
  options.wrong_masses = std::move(masses);
  options.shoves = std::move(shoves);
  options.wrench_links = std::move(wrench_links);
  return options;
}

void fall(SimbodyPlant& plant, double seconds, int dof = 2) {
  for (int i = 0; i < std::lround(seconds / kTick); ++i) plant.advance(Eigen::VectorXd::Zero(dof), kTick);
}

TEST(WrongMass, OfALinkMovesAsOneThatIsBuiltSo) {
  const WrongMass load{"load", {0, kForever}, {{.link = kTool}}, 1.5, 0.4, Vector3d(0.1, -0.02, 0.03)};
  SimbodyPlant told(arm(), {}, Eigen::Vector2d(0.3, -0.5), with({load}));
  // By hand: masses and moments of two bodies about the common centre.
  description::Robot heavy = arm();
  description::Link& tool = heavy.links[kTool];
  const Vector3d c = tool.centre_of_mass, centre = (0.45 * c + 0.4 * load.point) / 0.85;
  const auto about = [&](double m, const Vector3d& p) -> Eigen::Matrix3d {
    const Vector3d d = p - centre;
    return m * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  };
  tool.inertia = 1.5 * tool.inertia + about(0.45, c) + about(0.4, load.point);
  tool.mass = 0.85;
  tool.centre_of_mass = centre;
  SimbodyPlant built(heavy, {}, Eigen::Vector2d(0.3, -0.5)), plain(arm(), {}, Eigen::Vector2d(0.3, -0.5));
  for (SimbodyPlant* plant : {&told, &built, &plain}) fall(*plant, 0.5);
  EXPECT_LT((told.sense().q - built.sense().q).norm(), 1e-11);
  EXPECT_GT((told.sense().q - plain.sense().q).norm(), 1e-2);
}

TEST(WrongMass, ComesAndGoesWithoutAJumpOfTheState) {
  const WrongMass load{"load", {0.1, 0.2}, {{.link = kElbow}}, 1, 2, Vector3d(0.4, 0, 0)};
  SimbodyPlant told(arm(), {}, Eigen::Vector2d(0.3, -0.5), with({load}));
  SimbodyPlant plain(arm(), {}, Eigen::Vector2d(0.3, -0.5));
  const auto step = [&](double until) {
    while (told.sense().time < until - 1e-9) {
      const Eigen::VectorXd before = told.sense().qd;
      fall(told, kTick);
      EXPECT_LT((told.sense().qd - before).norm(), 0.2) << told.sense().time;
    }
  };
  step(0.1);
  fall(plain, 0.1);
  EXPECT_EQ(told.sense().q, plain.sense().q) << "not a bit else before it begins";
  step(0.2);
  fall(plain, 0.1);
  EXPECT_GT((told.sense().q - plain.sense().q).norm(), 1e-3);
  step(0.4);

  std::vector<const control::FaultRecord*> records;
  told.faults(records);
  ASSERT_EQ(records.size(), 1u);
  EXPECT_EQ(records[0]->kind, "wrong-mass");
  EXPECT_NEAR(records[0]->began, 0.1, 1e-12);
  EXPECT_NEAR(records[0]->ended, 0.2, 1e-12);
  EXPECT_FALSE(records[0]->strikes);
}

TEST(WrongMass, IsFeltByTheWrenchThatBearsIt) {
  const WrongMass load{"load", {0, kForever}, {{.link = kTool}}, 1, 0.6};  // at the tool's origin
  SimbodyPlant plant(arm(), {}, Eigen::Vector2d(0, 0), with({load}, {}, {kTool}));
  plant.advance(holding() - 9.81 * 0.6 * Eigen::Vector2d(0.8, 0.4), kTick);
  EXPECT_LT(plant.sense().qd.norm(), 1e-6);
  EXPECT_LT((toolAxes() * plant.sense().wrenches[0].force_L - Vector3d(0, 0, 9.81 * 0.9)).norm(), 1e-4);
}

TEST(WrongMass, OfAnObjectChangesWhatAShoveDoesToIt) {
  for (const double factor : {1.0, 2.0}) {
    SimbodyPlant plant({arm()}, ball(), Eigen::Vector2d(0, 0),
                       with({{"heavy", {0, kForever}, {{.object = 0}}, factor, 0.1}},
                            {{"kick", {0.02, 0.03}, {.object = 0}, Vector3d(3, 0, 0)}}));
    fall(plant, 0.05);
    EXPECT_NEAR(plant.objects()[0].linear_W.x(), 0.03 / (0.1 * factor + 0.1), 1e-9);
  }
}

TEST(WrongMass, OfSeveralBodiesIsThatOfEach) {
  const Eigen::Vector2d start(0.3, -0.5);
  SimbodyPlant together(arm(), {}, start, with({{"both", {0, kForever}, {{.link = kElbow}, {.link = kTool}}, 1.3}}));
  SimbodyPlant each(arm(), {}, start, with({{"one", {0, kForever}, {{.link = kElbow}}, 1.3},
                                            {"other", {0, kForever}, {{.link = kTool}}, 1.3}}));
  SimbodyPlant plain(arm(), {}, start);
  for (SimbodyPlant* plant : {&together, &each, &plain}) fall(*plant, 0.3);
  EXPECT_EQ(together.sense().q, each.sense().q);
  EXPECT_GT((together.sense().q - plain.sense().q).norm(), 1e-4);
  std::vector<const control::FaultRecord*> records;
  together.faults(records);
  EXPECT_EQ(records.size(), 1u) << "one fault, however many bodies";
}

TEST(WrongMass, StaysStableWhereAJointLeansAtItsStop) {
  description::Robot robot = arm();
  for (description::Joint& joint : robot.joints) joint.lower = -0.6, joint.upper = 0.4;
  SimbodyPlant plant(robot, {}, Eigen::Vector2d(0, 0),
                     with({{"light", {0.5, kForever}, {{.link = kElbow}}, 0.01},
                           {"tool", {0.5, kForever}, {{.link = kTool}}, 0.01}}));
  fall(plant, 3);
  EXPECT_LT(plant.sense().qd.norm(), 1e-3);
}

/// One hinge without weight: I q̈ = τ − friction.
SimbodyPlant hinge(std::vector<description::JointFriction> frictions) {
  description::Robot robot = sim_tests::world();
  addJoint(robot, "hinge", JointType::revolute, Vector3d::UnitZ(), 1, 0.01);
  PlantOptions options;
  options.frictions = std::move(frictions);
  return SimbodyPlant(robot, {}, Eigen::VectorXd::Zero(1), options);
}

void push(SimbodyPlant& plant, double torque, double seconds) {
  for (int i = 0; i < std::lround(seconds / kTick); ++i) plant.advance(Eigen::VectorXd::Constant(1, torque), kTick);
}

TEST(JointFriction, HoldsAJointUntilItIsPushedHarder) {
  SimbodyPlant held = hinge({{"rust", {0, kForever}, {0}, {0.3}}});
  push(held, 0.29, 0.2);
  EXPECT_LT(std::abs(held.sense().q[0]), 1e-3);
  EXPECT_LT(std::abs(held.sense().qd[0]), 1e-3);

  SimbodyPlant rubs = hinge({{"rust", {0, kForever}, {0}, {0.3}}}), free = hinge({});
  push(rubs, 0.8, 0.2);
  push(free, 0.5, 0.2);
  EXPECT_NEAR(rubs.sense().qd[0], free.sense().qd[0], 1e-6 + 0.02 * free.sense().qd[0])
      << "it slides with what is left, but for the first moments";
}

TEST(JointFriction, AddsUpAndIsGoneAfterItsTime) {
  SimbodyPlant plant = hinge({{"rust", {0, 0.1}, {0}, {0.3}}, {"sand", {0.05, 0.1}, {0}, {0.4}}});
  push(plant, 0.6, 0.05);
  const double speed = plant.sense().qd[0];
  EXPECT_GT(speed, 0) << "0.3 N m do not hold it";
  push(plant, 0.6, 0.05);
  EXPECT_LT(plant.sense().qd[0], speed) << "0.7 N m do";
  const double slowed = plant.sense().qd[0];
  SimbodyPlant free = hinge({});
  push(free, 0.6, 0.05);
  push(plant, 0.6, 0.05);
  EXPECT_NEAR(plant.sense().qd[0] - slowed, free.sense().qd[0], 1e-9);

  std::vector<const control::FaultRecord*> records;
  plant.faults(records);
  ASSERT_EQ(records.size(), 2u);
  EXPECT_EQ(records[1]->kind, "joint-friction");
  EXPECT_NEAR(records[1]->began, 0.05, 1e-12);
  EXPECT_NEAR(records[1]->ended, 0.1, 1e-12);
}

TEST(MassPeriods, BeginWhereverAFaultBeginsOrEnds) {
  const std::vector<MassPeriod> none = massPeriods({});
  ASSERT_EQ(none.size(), 1u);
  const std::vector<MassPeriod> periods = massPeriods({{"one", {1, 3}, {}}, {"other", {2, kForever}, {}}});
  ASSERT_EQ(periods.size(), 4u);
  EXPECT_EQ(periods[0].holds, (std::vector<bool>{false, false}));
  EXPECT_EQ(periods[1].holds, (std::vector<bool>{true, false}));
  EXPECT_EQ(periods[2].holds, (std::vector<bool>{true, true}));
  EXPECT_EQ(periods[3].holds, (std::vector<bool>{false, true}));
  EXPECT_EQ(periods[3].from, 3);
}

TEST(Shove, GivesAnObjectItsImpulseWhateverPartOfAStepItLasts) {
  // Of steps of 0.25 ms: whole ones, parts at both ends, a part of one alone.
  for (const description::Window window : {description::Window{0.01, 0.02}, {0.0101, 0.0187}, {0.01003, 0.01009}}) {
    const Vector3d force(3, -2, 4), moment(0.01, 0.02, 0);
    const Shove kick{"kick", window, {.object = 0}, force, moment};
    SimbodyPlant plant(arm(), ball(), Eigen::Vector2d(0, 0), with({}, {kick}));
    fall(plant, 0.05);
    const double lasted = window.until - window.from;
    const Vector3d weight(0, 0, -9.81 * 0.05);
    EXPECT_LT((plant.objects()[0].linear_W - weight - force * lasted / 0.1).norm(), 1e-9);
    EXPECT_LT((plant.objects()[0].angular_W - moment * lasted / 1e-5).norm(), 1e-6 * moment.norm() * lasted / 1e-5);
    std::vector<const control::FaultRecord*> records;
    plant.faults(records);
    EXPECT_NEAR(records.at(0)->began, window.from, 0.25e-3) << "told, too, where no tick saw it";
    EXPECT_NEAR(records.at(0)->ended, window.until, 0.25e-3);
  }
}

TEST(Shove, AtAPointTurnsTheBody) {
  const Shove kick{"kick", {0, 0.001}, {.object = 0}, Vector3d(1, 0, 0), Vector3d::Zero(), Vector3d(0, 0.02, 0)};
  SimbodyPlant plant(arm(), ball(), Eigen::Vector2d(0, 0), with({}, {kick}));
  fall(plant, 0.001);
  EXPECT_NEAR(plant.objects()[0].angular_W.z(), -0.02 * 0.001 / 1e-5, 1e-6);
}

TEST(Shove, OfALinkIsTheTorqueThatItsJacobianMakesOfIt) {
  const Vector3d force(2, 0, -5);
  // About y, with r from the joint to the tool's origin: (r × F)·y = −r_x F_z.
  const Eigen::Vector2d pushed = -force.z() * Eigen::Vector2d(0.8, 0.4);
  SimbodyPlant plant(arm(), {}, Eigen::Vector2d(0, 0),
                     with({}, {{"push", {0, kForever}, {.link = kTool}, force}}, {1, kTool}));
  plant.advance(holding() - pushed, kTick);
  EXPECT_LT(plant.sense().qd.norm(), 1e-6);
  // The joint above the arm bears its weight, less the push; the tool's, fixed, its own.
  EXPECT_LT((plant.sense().wrenches[0].force_L - (Vector3d(0, 0, 9.81 * 2.3) - force)).norm(), 1e-4);
  EXPECT_LT((toolAxes() * plant.sense().wrenches[1].force_L - (Vector3d(0, 0, 9.81 * 0.3) - force)).norm(), 1e-4);
}

TEST(Shove, ThatIsTooMuchIsARunawayWithAName) {
  SimbodyPlant plant(arm(), ball(), Eigen::Vector2d(0, 0),
                     with({}, {{"blast", {0.01, kForever}, {.object = 0}, Vector3d(1e5, 0, 0)}}));
  try {
    fall(plant, 0.05);
    FAIL();
  } catch (const runtime::PlantError& error) {
    EXPECT_EQ(std::string(error.what()).find("object 'ball' runs away"), 0u) << error.what();
  }
}

}  // namespace
}  // namespace tactus::sim
