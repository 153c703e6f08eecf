// Objects that move: free, held and on a path; at rest, pushed, rolling, struck.
//
// Strategy: analytic cases (weight on a spring, Coulomb's slope, two balls), laws (momentum, energy never grows, the same
// bits again), and rest under a load for every shape that is known by points of its surface alone.

#include <gtest/gtest.h>

#include <numbers>

#include "framework/geometry/cone.h"
#include "framework/geometry/ellipsoid.h"
#include "framework/geometry/extrusion.h"
#include "framework/geometry/revolution.h"
#include "framework/geometry/torus.h"
#include "sim/object_path.h"
#include "sim/simbody_plant.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using description::Mobility;
using Eigen::Vector3d;
using sim_tests::at;

constexpr double g = 9.81;
const Eigen::VectorXd nothing;

description::Object free(const char* name, const Eigen::Isometry3d& pose, std::shared_ptr<const geometry::Shape> shape,
                         double mass, const Vector3d& inertia) {
  description::Object object = sim_tests::object(name, pose, std::move(shape));
  object.mobility = Mobility::free;
  object.mass = {mass, Vector3d::Zero(), inertia.asDiagonal()};
  return object;
}

description::Object ball(const char* name, const Vector3d& centre, double radius = 0.02, double mass = 0.1) {
  return free(name, at(centre.x(), centre.y(), centre.z()), std::make_shared<geometry::Sphere>(radius), mass,
              Vector3d::Constant(0.4 * mass * radius * radius));
}

/// A can of 0.3 kg, 10 cm high.
description::Object can(const Eigen::Isometry3d& pose) {
  const double m = 0.3, r = 0.03, h = 0.1;
  const double across = m * (3 * r * r + h * h) / 12;
  return free("can", pose, std::make_shared<geometry::Cylinder>(r, h), m, {across, across, m * r * r / 2});
}

description::Object brick(const Eigen::Isometry3d& pose) {
  const Vector3d size(0.06, 0.1, 0.04);
  const Vector3d squares = size.cwiseAbs2();
  return free("brick", pose, std::make_shared<geometry::Box>(size), 0.3,
              0.3 / 12 * Vector3d(squares.y() + squares.z(), squares.x() + squares.z(), squares.x() + squares.y()));
}

description::Object ground(double friction = 0.5) {
  description::Object plane = sim_tests::object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>());
  plane.material.friction = friction;
  return plane;
}

description::Scene scene(std::vector<description::Object> objects) {
  description::Scene made;
  made.objects = std::move(objects);
  for (description::Object& object : made.objects) object.material.friction = 0.5;
  return made;
}

/// The plant of a scene whose robot is a lone base, which touches nothing.
SimbodyPlant plantOf(const description::Scene& scene) { return {sim_tests::world(), scene, nothing}; }

double speedOf(const control::ObjectMotion& motion, double reach) {
  return motion.linear_W.norm() + reach * motion.angular_W.norm();
}

TEST(FreeObject, FallsAsStonesDo) {
  SimbodyPlant plant = plantOf(scene({ball("stone", {0, 0, 10})}));
  plant.advance(nothing, 1);
  EXPECT_NEAR(plant.objects()[0].linear_W.z(), -g, 1e-9);
  EXPECT_NEAR(plant.objects()[0].pose.translation().z(), 10 - 0.5 * g * (1 + 0.25e-3), 1e-9);  // semi-explicit
}

TEST(FreeObject, SinksIntoTheGroundByItsWeightOverBothSprings) {
  SimbodyPlant plant = plantOf(scene({ground(), ball("stone", {0, 0, 0.02})}));
  plant.advance(nothing, 2);
  const double stiffness = 1000;                                   // two springs of 2000 N/m in series
  EXPECT_NEAR(plant.objects()[1].pose.translation().z(), 0.02 - 0.1 * g / stiffness, 1e-7);
  EXPECT_LT(speedOf(plant.objects()[1], 0.02), 1e-6);
}

/// A brick falls on a corner and spins away; in free flight its angular momentum stays.
TEST(FreeObject, KeepsItsAngularMomentumInFlight) {
  description::Object tilted = brick(at(0, 0, 0.045) * Eigen::AngleAxisd(0.7, Vector3d(1, 2, 0.5).normalized()));
  description::Object step = sim_tests::object("step", at(0.05, 0, -0.02), std::make_shared<geometry::Box>(Vector3d(0.06, 0.2, 0.04)));
  SimbodyPlant plant = plantOf(scene({step, tilted}));
  const auto momentum = [&] {
    const control::ObjectMotion& motion = plant.objects()[1];
    const Eigen::Matrix3d R = motion.pose.linear();
    return Vector3d(R * tilted.mass.inertia * R.transpose() * motion.angular_W);
  };
  plant.advance(nothing, 1);                                       // it has tumbled off the step by then
  const Vector3d before = momentum();
  ASSERT_GT(before.norm(), 1e-5);
  ASSERT_LT(plant.objects()[1].pose.translation().z(), -0.3);
  plant.advance(nothing, 0.5);
  EXPECT_LT((momentum() - before).norm(), 0.01 * before.norm());   // of the order of the step
}

struct Thing {
  const char* name;
  description::Object object;
};
std::ostream& operator<<(std::ostream& out, const Thing& thing) { return out << thing.name; }

class Rest : public ::testing::TestWithParam<Thing> {};

/// On a table that leans: by 0.5 N for 0.3 kg, and by 10°.
TEST_P(Rest, UnderALoadDoesNotCreep) {
  for (const double tilt : {std::asin(0.5 / (0.3 * g)), std::numbers::pi / 18}) {
    description::Scene table = scene({ground(), GetParam().object});
    table.gravity = g * Vector3d(std::sin(tilt), 0, -std::cos(tilt));
    SimbodyPlant plant = plantOf(table);
    plant.advance(nothing, 8);                                     // the can rocks for a while
    const Vector3d before = plant.objects()[1].pose.translation();
    plant.advance(nothing, 2);
    const double creep = (plant.objects()[1].pose.translation() - before).norm() / 2;
    EXPECT_LT(creep, 0.05e-3) << "m/s, at " << tilt;
    EXPECT_LT(speedOf(plant.objects()[1], 0.05), 0.5e-3);
    EXPECT_LT(before.norm(), 0.06) << "it slid at first";
    RecordProperty("creep_um_per_s", std::to_string(1e6 * creep));
  }
}

/// What is known by points of its surface alone gives way on a plane hardly more than one spring would.
TEST(Object, SinksHardlyDeeperThanOnASpring) {
  const double mass = 0.3;
  const std::vector<Eigen::Vector2d> square{{-0.02, -0.02}, {0.02, -0.02}, {0.02, 0.02}, {-0.02, 0.02}};
  const std::pair<std::shared_ptr<const geometry::Shape>, double> solids[] = {
      {std::make_shared<geometry::Extrusion>(square, 0.04), 0.02},
      {std::make_shared<geometry::Ellipsoid>(Vector3d(0.05, 0.05, 0.02)), 0.02},
      {std::make_shared<geometry::Torus>(0.04, 0.01, 2 * std::numbers::pi), 0.01},
      {std::make_shared<geometry::Cone>(0.03, 0.01, 0.06), 0.03}};
  for (const auto& [shape, height] : solids) {
    description::Object thing = free("thing", at(0, 0, height), shape, mass, Vector3d::Constant(1e-4));
    thing.material.dissipation = 4;
    SimbodyPlant plant = plantOf(scene({ground(), thing}));
    plant.advance(nothing, 3);
    const double stiffness = 0.5 * description::ContactMaterial().stiffness;
    EXPECT_LT(height - plant.objects()[1].pose.translation().z(), 1.5 * mass * g / stiffness);
  }
}

TEST(Can, PushedWithHalfANewtonDoesNotCreep) {
  const description::Scene table = scene({ground(), can(at(0, 0, 0.05))});
  PlantOptions options;
  description::Shove push;
  push.name = "push";
  push.window.from = 0;
  push.body.object = 1;
  push.force_W.x() = 0.5;
  push.point.z() = -0.04;                                          // low, where it does not tip
  options.shoves = {push};
  SimbodyPlant plant(sim_tests::world(), table, nothing, options);
  plant.advance(nothing, 8);
  const Vector3d before = plant.objects()[1].pose.translation();
  plant.advance(nothing, 2);
  const double creep = (plant.objects()[1].pose.translation() - before).norm() / 2;
  EXPECT_LT(creep, 0.05e-3) << "m/s";
  EXPECT_LT(before.head<2>().norm(), 1e-3);
  RecordProperty("creep_um_per_s", std::to_string(1e6 * creep));
}

TEST_P(Rest, SlidesWhereTheSlopeIsSteeperThanFriction) {
  const double tilt = std::atan(0.4), friction = 0.3;              // low enough that the can does not tip
  description::Scene table = scene({ground(), GetParam().object});
  for (description::Object& object : table.objects) object.material.friction = friction;
  table.gravity = g * Vector3d(0, std::sin(tilt), -std::cos(tilt));
  SimbodyPlant plant = plantOf(table);
  plant.advance(nothing, 1);
  const double from = plant.objects()[1].linear_W.y();
  plant.advance(nothing, 2);
  const double acceleration = (plant.objects()[1].linear_W.y() - from) / 2;
  EXPECT_NEAR(acceleration, g * (std::sin(tilt) - friction * std::cos(tilt)), 1e-3 * g);
}

INSTANTIATE_TEST_SUITE_P(Of, Rest,
                         ::testing::Values(Thing{"can", can(at(0, 0, 0.05))}, Thing{"brick", brick(at(0, 0, 0.02))}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(FreeObject, RollsOnItsSide) {
  const Eigen::Isometry3d lying = at(0, 0, 0.03) * Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX());
  description::Scene slope = scene({ground(), can(lying)});
  const double tilt = 0.1;
  slope.gravity = g * Vector3d(std::sin(tilt), 0, -std::cos(tilt));
  SimbodyPlant plant = plantOf(slope);
  plant.advance(nothing, 1);
  // A disk that rolls without slip has a = 2/3 g sin(tilt); rims of points take a part of it.
  const double speed = plant.objects()[1].linear_W.x(), disk = 2.0 / 3 * g * std::sin(tilt);
  EXPECT_LT(speed, disk);
  EXPECT_GT(speed, 0.7 * disk);
  EXPECT_NEAR(plant.objects()[1].angular_W.y(), speed / 0.03, 0.1 * speed / 0.03);
}

/// A ball on a slope: rolling resistance holds it up to tan(slope) = ρ/r, and slows it down above.
TEST(FreeObject, RollsDownSlopesAboveItsRollingResistance) {
  const double r = 0.02, rho = 4e-4;
  const auto accelerationAt = [&](double slope) {
    description::Scene leaning = scene({ground(), ball("ball", {0, 0, r}, r)});
    for (description::Object& object : leaning.objects) object.material.rolling = rho;
    leaning.gravity = g * Vector3d(std::sin(slope), 0, -std::cos(slope));
    SimbodyPlant plant = plantOf(leaning);
    plant.advance(nothing, 1);
    const double from = plant.objects()[1].linear_W.x();
    plant.advance(nothing, 1);
    return plant.objects()[1].linear_W.x() - from;
  };
  EXPECT_NEAR(accelerationAt(0.8 * rho / r), 0, 1e-5);
  const double slope = 3 * rho / r;                                // a = (g sin − ρ/r g cos)/(1 + 2/5)
  EXPECT_NEAR(accelerationAt(slope), g * (std::sin(slope) - rho / r * std::cos(slope)) / 1.4, 0.02);
}

/// A ball in a hollow, without friction: each side carries its part of the weight, gravity leaning into the corner.
class Hollow : public ::testing::Test {
 protected:
  static constexpr double radius = 0.012, mass = 0.1, stiffness = 1000;  // two springs of 2000 N/m in series

  /// Where the ball is after 3 s, at rest by then.
  Vector3d restIn(std::shared_ptr<const geometry::Shape> shape, const Vector3d& from, const Vector3d& down) {
    description::Scene held = scene({sim_tests::object("hollow", at(0, 0, 0), std::move(shape)), ball("ball", from, radius, mass)});
    for (description::Object& object : held.objects) object.material = {2 * stiffness, 5, 0, 0};
    held.gravity = g * down.normalized();
    SimbodyPlant plant = plantOf(held);
    plant.advance(nothing, 3);
    EXPECT_LT(plant.objects()[1].linear_W.norm(), 1e-6) << "m/s";
    return plant.objects()[1].pose.translation();
  }
};

TEST_F(Hollow, OfAnAngleCarriesOnBothSides) {
  const auto angle = std::make_shared<geometry::Extrusion>(
      std::vector<Eigen::Vector2d>{{-0.1, -0.1}, {0.1, -0.1}, {0.1, -0.05}, {0, -0.05}, {0, 0.1}, {-0.1, 0.1}}, 0.2);
  const Vector3d down = Vector3d(-1, -2, 0).normalized();
  const Vector3d at_rest = restIn(angle, {radius, -0.05 + radius, 0.01}, down);
  EXPECT_NEAR(radius - at_rest.x(), -down.x() * mass * g / stiffness, 1e-7);
  EXPECT_NEAR(radius - (at_rest.y() + 0.05), -down.y() * mass * g / stiffness, 1e-7);
}

TEST_F(Hollow, OfACupCarriesOnWallAndBottom) {
  const auto cup = std::make_shared<geometry::Revolution>(
      std::vector<Eigen::Vector2d>{{0, 0}, {0.05, 0}, {0.05, 0.1}, {0.046, 0.1}, {0.046, 0.006}, {0, 0.006}});
  const Vector3d down = Vector3d(1, 0, -2).normalized();
  const Vector3d at_rest = restIn(cup, {0.046 - radius, 0, 0.006 + radius}, down);
  EXPECT_NEAR(at_rest.x() - (0.046 - radius), down.x() * mass * g / stiffness, 1e-7);
  EXPECT_NEAR(0.006 + radius - at_rest.z(), -down.z() * mass * g / stiffness, 1e-7);
}

/// The nearest point alone is on one side of the mouth at a time.
TEST_F(Hollow, MouthAndRingCarryInTheMiddle) {
  const auto tube = std::make_shared<geometry::Revolution>(
      std::vector<Eigen::Vector2d>{{0, 0}, {0.011, 0}, {0.011, 0.05}, {0.009, 0.05}, {0.009, 0.004}, {0, 0.004}});
  const Vector3d down(0, 0, -1);
  EXPECT_LT(restIn(tube, {0.0005, 0, 0.06}, down).head<2>().norm(), 1e-6);
  const auto ring = std::make_shared<geometry::Torus>(0.02, 0.012, 2 * std::numbers::pi);
  EXPECT_LT(restIn(ring, {0.0005, 0.0002, 0.02}, down).head<2>().norm(), 1e-6);
}

TEST(Objects, StackedOneOnTheOtherStayThere) {
  description::Object upper = brick(at(0, 0, 0.06));
  upper.name = "upper";
  SimbodyPlant plant = plantOf(scene({ground(), brick(at(0, 0, 0.02)), upper}));
  plant.advance(nothing, 2);
  for (int i : {1, 2}) {
    EXPECT_LT(speedOf(plant.objects()[i], 0.05), 0.05e-3) << i;
    EXPECT_LT(plant.objects()[i].pose.translation().head<2>().norm(), 1e-4) << i;
  }
  EXPECT_NEAR(plant.objects()[2].pose.translation().z(), 0.06, 2e-3);
}

/// Edge on edge, crossed: no corner of the one is in the other.
TEST(Objects, FeelEachOthersEdges) {
  const auto beam = std::make_shared<geometry::Box>(Vector3d(0.2, 0.02, 0.02));
  const double diagonal = 0.01 * std::sqrt(2);
  const Eigen::Isometry3d on_edge = at(0, 0, 0) * Eigen::AngleAxisd(std::numbers::pi / 4, Vector3d::UnitX());
  const Eigen::Isometry3d across = at(0, 0, 2 * diagonal - 1e-3) *
                                   Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()) *
                                   Eigen::AngleAxisd(std::numbers::pi / 4, Vector3d::UnitX());
  description::Object fixed = sim_tests::object("below", on_edge, beam);
  description::Object above = free("above", across, beam, 0.1, Vector3d::Constant(1e-4));
  description::Scene crossed = scene({fixed, above});
  crossed.gravity.setZero();
  SimbodyPlant plant = plantOf(crossed);
  plant.advance(nothing, 0.01);
  EXPECT_GT(plant.objects()[1].linear_W.z(), 0.01) << "they push each other apart";
  // Where two faces are equally near, the nearest one is taken: a part of the force goes aside.
  EXPECT_LT(plant.objects()[1].linear_W.head<2>().norm(), 0.5 * plant.objects()[1].linear_W.z());
}

TEST(Objects, ThatCollideGainNoEnergy) {
  description::Object left = ball("left", {-0.03, 0, 0}), right = ball("right", {0.03, 0.005, 0}, 0.025, 0.3);
  description::Scene space = scene({left, right});
  space.gravity = Vector3d(0.5, 0, 0);                             // both fall aside; left starts behind a spring
  space.objects[0].mobility = Mobility::held;
  space.objects[0].holder = {50, 0, 0, 0};
  space.objects[0].path = {{0, at(0.03, 0, 0)}};
  SimbodyPlant plant = plantOf(space);
  double last = 1e9;
  const auto energy = [&] {
    double total = 0;
    const double masses[] = {0.1, 0.3}, radii[] = {0.02, 0.025};
    for (int i : {0, 1}) {
      const control::ObjectMotion& motion = plant.objects()[i];
      total += 0.5 * masses[i] * motion.linear_W.squaredNorm() +
               0.2 * masses[i] * radii[i] * radii[i] * motion.angular_W.squaredNorm() -
               masses[i] * space.gravity.dot(motion.pose.translation());
    }
    total += 25 * (plant.objects()[0].pose.translation() - Vector3d(0.03, 0, 0)).squaredNorm();
    const double depth = 0.045 - (plant.objects()[0].pose.translation() - plant.objects()[1].pose.translation()).norm();
    return total + 500 * std::max(0.0, depth) * std::max(0.0, depth);
  };
  const double start = energy();
  for (int i = 0; i < 1000; ++i) {
    plant.advance(nothing, 1e-3);
    last = energy();
    EXPECT_LT(last, start * (start > 0 ? 1.01 : 0.99) + 1e-4) << "at " << i << " ms";
  }
  EXPECT_LT(last, start) << "the blow took some";
}

/// The robot's finger pushes a ball: what the one loses the other gets.
TEST(Objects, AndLinksPushEachOther) {
  description::Scene space = scene({ball("ball", {0.05, 0, 0}, 0.02, 0.1)});
  space.gravity.setZero();
  SimbodyPlant plant(sim_tests::slidingBody(sim_tests::sphere(0.02)), space, Vector3d(0, 0, 0));
  Eigen::Vector3d push(1, 0, 0);                                   // N, for 0.1 s
  plant.advance(push, 0.1);
  double heaviest = 0;
  for (int i = 0; i < 300; ++i) {
    plant.advance(Vector3d::Zero(), 1e-3);
    for (const control::ContactRecord& record : plant.sense().contacts) heaviest = std::max(heaviest, record.force_N);
  }
  const double robot_mass = sim_tests::mass + 2 * sim_tests::carrier_mass;
  EXPECT_NEAR(robot_mass * plant.sense().qd.x() + 0.1 * plant.objects()[0].linear_W.x(), 0.1, 1e-5);
  EXPECT_GT(plant.objects()[0].linear_W.x(), plant.sense().qd.x());
  EXPECT_GT(heaviest, 0.5);
}

TEST(HeldObject, FollowsItsPathAndTheReferencesTwist) {
  description::Object cup = ball("cup", {0, 0, 0}, 0.02, 0.3);
  cup.mobility = Mobility::held;
  cup.holder = {500, 15, 2, 0.02};
  cup.path = {{0, at(0, 0, 0)}, {1, at(0.15, 0, 0)}, {2, at(0, 0, 0)}};
  description::Scene space = scene({cup});
  SimbodyPlant plant = plantOf(space);
  plant.advance(nothing, 0.001);
  double lag = 0;
  for (int i = 1; i < 2000; ++i) {
    plant.advance(nothing, 1e-3);
    const BodyMotion wanted = motionOn(cup.path, 1e-3 * (i + 1));
    lag = std::max(lag, std::abs(plant.objects()[0].pose.translation().x() - wanted.p_WB.x()));
  }
  // The damper follows the reference's speed, so that only the inertia m a = 0.3 · 0.87 lags: 0.5 mm.
  EXPECT_LT(lag, 0.8e-3);
  EXPECT_NEAR(plant.objects()[0].pose.translation().z(), -0.3 * g / 500, 1e-4) << "it sags by its weight";
}

TEST(MovedObject, GoesWhereItsPathSaysAndPushesWhatIsThere) {
  description::Object wall = sim_tests::object("wall", at(-0.1, 0, 0), std::make_shared<geometry::Box>(Vector3d(0.1, 0.2, 0.2)));
  wall.mobility = Mobility::moved;
  wall.path = {{0, at(-0.1, 0, 0)}, {1, at(0, 0, 0)}};
  description::Scene space = scene({wall, ball("ball", {0, 0, 0})});
  space.gravity.setZero();
  SimbodyPlant plant = plantOf(space);
  plant.advance(nothing, 1.2);
  EXPECT_EQ(plant.objects()[0].pose.translation(), Vector3d(0, 0, 0));
  EXPECT_GT(plant.objects()[1].pose.translation().x(), 0.069);
  EXPECT_GT(plant.objects()[1].linear_W.x(), 0);
}

TEST(ObjectPath, IsAtRestAtItsWaypointsAndItsTwistIsTheDerivative) {
  const Eigen::Isometry3d turned = at(0.1, 0.2, 0.3) * Eigen::AngleAxisd(1, Vector3d(1, 2, 3).normalized());
  const std::vector<description::Waypoint> path{{0.5, at(0, 0, 0)}, {1.5, turned}, {2, at(0, 0, 0.1)}};
  for (double time : {0.0, 0.5, 1.5, 2.0, 3.0}) EXPECT_LT(motionOn(path, time).linear_W.norm(), 1e-12) << time;
  EXPECT_LT((motionOn(path, 1.5).p_WB - turned.translation()).norm(), 1e-12);
  EXPECT_LT((motionOn(path, 1.5).R_WB - turned.linear()).norm(), 1e-12);
  for (double time : {0.7, 1.0, 1.4, 1.8}) {
    const double h = 1e-6;
    const BodyMotion here = motionOn(path, time), next = motionOn(path, time + h), last = motionOn(path, time - h);
    EXPECT_LT(((next.p_WB - last.p_WB) / (2 * h) - here.linear_W).norm(), 1e-7);
    const Eigen::AngleAxisd turn(next.R_WB * last.R_WB.transpose());
    EXPECT_LT((turn.angle() / (2 * h) * turn.axis() - here.angular_W).norm(), 1e-7);
  }
}

TEST(Objects, MoveBySameBitsAgain) {
  const auto run = [] {
    SimbodyPlant plant = plantOf(scene({ground(), can(at(0, 0, 0.08)), brick(at(0.03, 0, 0.15)), ball("ball", {0, 0.02, 0.3})}));
    plant.advance(nothing, 1);
    std::vector<double> numbers;
    for (const control::ObjectMotion& motion : plant.objects())
      for (int i = 0; i < 3; ++i) {
        numbers.push_back(motion.pose.translation()[i]);
        numbers.push_back(motion.angular_W[i]);
      }
    return numbers;
  };
  EXPECT_EQ(run(), run());
}

TEST(Objects, ThatCannotMoveAreRefused) {
  const auto messageOf = [](description::Object object) {
    try {
      plantOf(scene({std::move(object)}));
    } catch (const runtime::PlantError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  description::Object light = ball("feather", {0, 0, 0});
  light.mass.mass = 0;
  EXPECT_EQ(messageOf(light), "object 'feather' moves, but has no mass");
  description::Object endless = ground();
  endless.mobility = Mobility::moved;
  EXPECT_EQ(messageOf(endless), "object 'ground' has a shape without end: it cannot move");
}

}  // namespace
}  // namespace tactus::sim
