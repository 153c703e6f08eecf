// The plant as a whole: energy, joint stops, time, repeatability, and every error with its text.

#include "sim/simbody_plant.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using sim_tests::at;
using sim_tests::object;

description::Scene ground(double dissipation, double friction) {
  description::Scene scene;
  scene.objects = {object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>())};
  scene.objects[0].material = {.stiffness = 2000, .dissipation = dissipation, .friction = friction};
  return scene;
}

std::string messageOf(const std::function<void()>& act) {
  try {
    act();
  } catch (const runtime::PlantError& error) {
    return error.what();
  }
  return "(no PlantError)";
}

/// An arm of two links, 0.5 m each, hanging from its hinge.
description::Robot pendulum() {
  description::Robot robot = sim_tests::world();
  robot.name = "pendulum";
  for (const char* name : {"shoulder", "elbow"}) {
    description::Joint& joint =
        sim_tests::addJoint(robot, name, description::JointType::revolute, Eigen::Vector3d::UnitY(), 1, 1e-3);
    if (std::string(name) == "elbow") joint.origin = at(0, 0, -0.5);
    robot.links.back().centre_of_mass = {0, 0, -0.25};
    robot.links.back().shapes = {description::CapsuleShape{{0, 0, 0}, {0, 0, -0.5}, 0.03}};
  }
  return robot;
}

/// Kinetic and potential energy of a free capsule at pitch θ, yaw and roll at rest: planar motion.
double planarEnergy(const control::Sensed& sensed, double inertia) {
  return 0.5 * sim_tests::mass * sensed.qd.head<3>().squaredNorm() + 0.5 * inertia * sensed.qd[4] * sensed.qd[4] +
         sim_tests::mass * 9.81 * sensed.q[2];
}

TEST(Energy, NeverGrowsOverFrictionlessBounces) {
  constexpr double inertia = 4e-5;
  for (double dissipation : {0.0, 2.0})
    for (double pitch : {0.0, 0.1, 0.4, 0.9}) {
      SCOPED_TRACE("dissipation " + std::to_string(dissipation) + ", pitch " + std::to_string(pitch));
      Eigen::VectorXd start(6);
      start << 0, 0, 0.1, 0, pitch, 0;
      SimbodyPlant plant(sim_tests::freeBody(sim_tests::capsule(0.012, 0.05), inertia), ground(dissipation, 0), start);
      const double first = planarEnergy(plant.sense(), inertia);
      double lowest = first;
      int flights = 0;
      for (int i = 0; i < 2000; ++i) {
        plant.advance(Eigen::VectorXd::Zero(6), 1e-3);
        if (!plant.sense().contacts.empty()) continue;             // elastic energy is not counted: look in flight
        const double energy = planarEnergy(plant.sense(), inertia);
        ++flights;
        if (dissipation == 0) {
          EXPECT_NEAR(energy, first, 0.01 * first);                // conserved up to the step's error
        } else {
          EXPECT_LE(energy, lowest + 2e-4 * first);
          lowest = std::min(lowest, energy);
        }
      }
      EXPECT_GT(flights, 100);
      EXPECT_TRUE(dissipation == 0 || lowest < 0.8 * first);
    }
}

TEST(JointStops, TakeTheImpactAndHoldTheRange) {
  description::Robot robot = pendulum();
  for (description::Joint& joint : robot.joints) {
    joint.lower = -0.6;
    joint.upper = 0.4;
  }
  SimbodyPlant plant(robot, {}, Eigen::Vector2d(0, 0));
  for (double torque : {20.0, -20.0}) {                            // hits the stops at some 10 rad/s
    for (int i = 0; i < 2000; ++i) {
      plant.advance(Eigen::Vector2d::Constant(torque), 1e-3);
      ASSERT_LT(plant.sense().q.maxCoeff(), 0.4 + 0.1);
      ASSERT_GT(plant.sense().q.minCoeff(), -0.6 - 0.1);
    }
    EXPECT_LT(plant.sense().qd.norm(), 1e-3) << "comes to rest there,";
    EXPECT_LT(plant.sense().q.maxCoeff(), 0.4 + 5e-3) << "bent little by the torque";
    EXPECT_GT(plant.sense().q.minCoeff(), -0.6 - 5e-3);
  }
}

/// One hinge without gravity, whose link hits the stop at `speed`; a spring and a damper of natural frequency ω =
/// √0.05/h and ratio ζ = 0.22/2√0.05 that only push.
class Stop : public ::testing::Test {
 protected:
  Stop() : robot_(sim_tests::world()) {
    description::Joint& hinge = sim_tests::addJoint(robot_, "hinge", description::JointType::revolute,
                                                    Eigen::Vector3d::UnitZ(), 1, inertia);
    hinge.lower = -0.5;
    hinge.upper = 0.5;
    scene_.gravity.setZero();
  }
  SimbodyPlant atTheMiddle() const { return {robot_, scene_, Eigen::VectorXd::Zero(1)}; }
  static void strike(SimbodyPlant& plant, double speed) {
    plant.advance(Eigen::VectorXd::Constant(1, speed * inertia / h), h);
  }
  static constexpr double inertia = 1e-3, h = 0.25e-3;
  description::Robot robot_;
  description::Scene scene_;
};

TEST_F(Stop, IsOvershotAsASpringAndADamperAre) {
  const double omega = std::sqrt(0.05) / h, zeta = 0.22 / (2 * std::sqrt(0.05));
  const double deepest = std::exp(-zeta / std::sqrt(1 - zeta * zeta) * std::acos(zeta)) / omega;  // per rad/s
  for (const double speed : {0.1, 1.0, 7.0, 50.0}) {
    SimbodyPlant plant = atTheMiddle();
    strike(plant, speed);
    double overshoot = 0;
    for (int i = 0; i < static_cast<int>(1.5 / speed / h) && plant.sense().qd[0] > 0; ++i) {
      plant.advance(Eigen::VectorXd::Zero(1), h);
      overshoot = std::max(overshoot, plant.sense().q[0] - 0.5);
    }
    EXPECT_NEAR(overshoot / speed, deepest, 0.25 * deepest) << speed << " rad/s: within a step's way";
  }
}

/// From stop to stop without anything to brake it: each blow takes energy, none gives.
TEST_F(Stop, TakesEnergyAtEveryBlow) {
  SimbodyPlant plant = atTheMiddle();
  strike(plant, 20);
  double speed = std::abs(plant.sense().qd[0]);
  int blows = 0;
  for (int i = 0; i < 20000; ++i) {
    plant.advance(Eigen::VectorXd::Zero(1), h);
    if (std::abs(plant.sense().q[0]) > 0.5) continue;              // the spring's energy is not counted: look between
    const double now = std::abs(plant.sense().qd[0]);
    ASSERT_LE(now, speed * (1 + 1e-12));
    if (now < 0.99 * speed) {
      EXPECT_NEAR(now / speed, 0.35, 0.2) << "rebound";
      ++blows;
    }
    speed = now;
  }
  EXPECT_GE(blows, 4);
}

TEST_F(Stop, YieldsToALoadByLoadOverStiffness) {
  SimbodyPlant plant = atTheMiddle();
  const double load = 0.5, stiffness = 0.05 * inertia / (h * h);
  plant.advance(Eigen::VectorXd::Constant(1, load), 2);
  EXPECT_NEAR(plant.sense().q[0] - 0.5, load / stiffness, 1e-9);
  EXPECT_LT(std::abs(plant.sense().qd[0]), 1e-9);
}

TEST(JointFriction, HoldsAPendulumAside) {
  description::Robot robot = pendulum();
  robot.joints[0].friction = 4;
  robot.joints[1].friction = 2;
  SimbodyPlant plant(robot, {}, Eigen::Vector2d(0.2, 0.1));
  plant.advance(Eigen::Vector2d::Zero(), 2);
  EXPECT_NEAR(plant.sense().q[0], 0.2, 1e-3);
  EXPECT_NEAR(plant.sense().q[1], 0.1, 1e-3);
}

TEST(Time, IsACountOfSteps) {
  SimbodyPlant plant(pendulum(), {}, Eigen::Vector2d(0.1, 0));
  EXPECT_EQ(plant.sense().time, 0);
  for (int i = 0; i < 3000; ++i) plant.advance(Eigen::Vector2d::Zero(), 1e-3);
  EXPECT_EQ(plant.sense().time, 12000 * 0.25e-3);
}

TEST(FreeFall, IsExactForTheStep) {
  SimbodyPlant plant(sim_tests::slidingBody(sim_tests::sphere(0.01)), {}, Eigen::Vector3d(0, 0, 10));
  plant.advance(Eigen::Vector3d::Zero(), 0.5);
  const double n = 2000, h = 0.25e-3;
  EXPECT_NEAR(plant.sense().qd[2], -9.81 * n * h, 1e-9);
  EXPECT_NEAR(plant.sense().q[2], 10 - 9.81 * h * h * n * (n + 1) / 2, 1e-9);
}

TEST(Repeatability, TwoPlantsGiveTheSameBytes) {
  const auto run = [] {
    std::vector<double> trace;
    description::Robot robot = pendulum();
    robot.joints[0].friction = 0.05;
    robot.joints[1].damping = 0.01;
    robot.joints[1].upper = 0.5;
    description::Scene scene;
    scene.objects = {object("wall", at(0, 0, -0.98), std::make_shared<geometry::Plane>()),
                     object("ball", at(0.3, 0, -0.9), std::make_shared<geometry::Sphere>(0.1))};
    SimbodyPlant plant(robot, scene, Eigen::Vector2d(0.3, 0.1));
    std::mt19937_64 random(3);
    size_t touches = 0;
    for (int i = 0; i < 1500; ++i) {
      const double push = std::uniform_real_distribution<double>(-5, 5)(random);
      plant.advance(Eigen::Vector2d(push, 0.2 * push), 1e-3);
      const control::Sensed& sensed = plant.sense();
      trace.insert(trace.end(), {sensed.time, sensed.q[0], sensed.q[1], sensed.qd[0], sensed.qd[1]});
      for (const control::ContactRecord& record : sensed.contacts) {
        trace.insert(trace.end(), {static_cast<double>(record.link), static_cast<double>(record.object), record.depth,
                                   record.force_N});
        trace.insert(trace.end(), record.point_W.begin(), record.point_W.end());
        trace.insert(trace.end(), record.normal_W.begin(), record.normal_W.end());
        trace.insert(trace.end(), record.friction_W.begin(), record.friction_W.end());
      }
      touches += sensed.contacts.size();
    }
    EXPECT_GT(touches, 100u);
    return trace;
  };
  const std::vector<double> one = run(), two = run();
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(double)), 0);
}

TEST(Errors, RunawayNamesJointSpeedTimeAndCausesAndKeepsTheLastGoodStep) {
  SimbodyPlant plant(pendulum(), {}, Eigen::Vector2d(0.1, 0));
  for (int i = 0; i < 3; ++i) plant.advance(Eigen::Vector2d::Zero(), 1e-3);
  const control::Sensed before = plant.sense();
  EXPECT_THAT(messageOf([&] { plant.advance(Eigen::Vector2d(0, 1e7), 1e-3); }),
              AllOf(HasSubstr("joint 'elbow' runs away: its speed reaches "),
                    HasSubstr(" rad/s at t = 0.00325 s (limit 100)"),
                    HasSubstr("Usual causes: damping gains too high")));
  EXPECT_TRUE(plant.sense().q.allFinite());
  EXPECT_EQ(plant.sense().q, before.q);
  EXPECT_EQ(plant.sense().time, before.time);
  plant.advance(Eigen::Vector2d::Zero(), 1e-3);                    // it can go on from there
  EXPECT_DOUBLE_EQ(plant.sense().time, 0.004);
}

TEST(Errors, AJointRunsAwayFarBeyondItsOwnVelocityLimit) {
  description::Robot robot = pendulum();
  const auto messageWith = [&](double limit, double torque) {
    robot.joints[1].velocity = limit;
    SimbodyPlant plant(robot, {}, Eigen::Vector2d(0.1, 0));
    return messageOf([&] { plant.advance(Eigen::Vector2d(0, torque), 0.01); });
  };
  EXPECT_THAT(messageWith(2, 1e3), HasSubstr("(limit 10)"));
  EXPECT_THAT(messageWith(0, 1e7), HasSubstr("(limit 100)")) << "a limit that nobody knew";
  EXPECT_THAT(messageWith(50, 1e7), HasSubstr("(limit 100)"));
}

TEST(Errors, InfiniteAccelerationIsALostState) {
  SimbodyPlant plant(pendulum(), {}, Eigen::Vector2d(0.1, 0));
  EXPECT_THAT(messageOf([&] { plant.advance(Eigen::Vector2d(1e308, -1e308), 1e-3); }), HasSubstr("Usual causes"));
  EXPECT_TRUE(plant.sense().q.allFinite());
  EXPECT_TRUE(plant.sense().qd.allFinite());
}

TEST(Errors, TorqueThatIsNotANumberOrOfAnotherSizeIsRefused) {
  SimbodyPlant plant(pendulum(), {}, Eigen::Vector2d(0.1, 0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(messageOf([&] { plant.advance(Eigen::Vector2d(0, nan), 1e-3); }),
              HasSubstr("the torque of joint 'elbow' is nan at t = 0 s"));
  EXPECT_EQ(plant.sense().time, 0);
  EXPECT_EQ(messageOf([&] { plant.advance(Eigen::Vector3d::Zero(), 1e-3); }), "got 3 torques for 2 moving joints");
  EXPECT_THAT(messageOf([&] { plant.advance(Eigen::Vector2d::Zero(), 1.1e-4); }),
              HasSubstr("cannot advance by 0.00011 s: not a whole number of steps of 0.00025 s"));
}

TEST(Errors, BadStartsAreRefused) {
  description::Robot robot = pendulum();
  robot.joints[1].lower = -1;
  robot.joints[1].upper = 1;
  const auto start = [&](const Eigen::VectorXd& q) { return messageOf([&] { SimbodyPlant(robot, {}, q); }); };
  EXPECT_EQ(start(Eigen::Vector3d::Zero()), "the start has 3 values, but robot 'pendulum' has 2 moving joints");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(start(Eigen::Vector2d(nan, 0)), "the start of joint 'shoulder' is nan");
  EXPECT_EQ(start(Eigen::Vector2d(0, 1.5)), "the start of joint 'elbow' is 1.5 rad, outside its range -1 to 1");
}

TEST(Errors, JointsThatThePlantCannotMoveAreRefused) {
  for (const auto type :
       {description::JointType::planar, description::JointType::spherical, description::JointType::floating}) {
    description::Robot robot = pendulum();
    robot.joints[1].type = type;
    EXPECT_EQ(messageOf([&] { SimbodyPlant(robot, {}, Eigen::Vector2d::Zero()); }),
              "joint 'elbow' has several degrees of freedom: the plant has revolute, continuous and prismatic joints "
              "only");
  }
  description::Robot robot = pendulum();
  robot.joints[1].mimic = description::Mimic{.driver = 0};
  EXPECT_EQ(messageOf([&] { SimbodyPlant(robot, {}, Eigen::Vector2d::Zero()); }),
            "joint 'elbow' follows another joint: the plant moves every joint on its own");
}

TEST(Errors, RobotsUnfitForDynamicsAreRefused) {
  description::Robot robot = pendulum();
  robot.links[2].mass = 0;
  EXPECT_EQ(messageOf([&] { SimbodyPlant(robot, {}, Eigen::Vector2d::Zero()); }),
            "link 'elbow' is moved by joint 'elbow' but has no mass: the plant needs an <inertial> with a positive "
            "mass on it");
  robot = pendulum();
  robot.links[2].centre_of_mass.setZero();
  robot.links[2].inertia = Eigen::Vector3d(1, 1e-3, 1e-3).asDiagonal();  // breaks the triangle inequality
  EXPECT_THAT(messageOf([&] { SimbodyPlant(robot, {}, Eigen::Vector2d::Zero()); }),
              HasSubstr("Simbody refuses robot 'pendulum'"));
}

}  // namespace
}  // namespace tactus::sim
