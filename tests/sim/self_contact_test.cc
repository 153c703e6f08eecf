// Links that touch each other.
//
// Strategy: two bodies on slides for what can be known by hand (force, momentum, record), then the hand of the main
// example for what is meant: fingers that close on each other stop there.

#include <gtest/gtest.h>

#include "dsl/read_robot.h"
#include "framework/dynamics/kinematics.h"
#include "framework/dynamics/self_contact.h"
#include "sim/simbody_plant.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using description::JointType;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Two balls of 2 cm and 0.1 kg side by side on slides of their own, x, y, z each; they may touch.
description::Robot twoBalls() {
  description::Robot robot = sim_tests::world();
  for (const std::string name : {"left", "right"}) {
    for (int axis = 0; axis < 3; ++axis) {
      description::Joint& joint =
          sim_tests::addJoint(robot, name + "xyz"[axis], JointType::prismatic, Vector3d::Unit(axis));
      if (axis == 0) joint.parent = 0;
    }
    robot.links.back().mass = sim_tests::mass;
    robot.links.back().shapes = {sim_tests::sphere(0.02)};
  }
  robot.self_contact = {{3, 6}};
  return robot;
}

description::Scene weightless() {
  description::Scene scene;
  scene.gravity.setZero();
  return scene;
}

VectorXd six(double a, double b, double c, double d, double e, double f) {
  VectorXd v(6);
  v << a, b, c, d, e, f;
  return v;
}

TEST(SelfContact, IsOneRecordOfTwoLinksThatPressEachOther) {
  SimbodyPlant plant(twoBalls(), weightless(), six(0, 0, 0, 0.041, 0, 0));
  EXPECT_TRUE(plant.sense().contacts.empty());
  const double push = 1.5;
  for (int i = 0; i < 4000; ++i) {
    const VectorXd& v = plant.sense().qd;                          // damped, so that they come to rest
    VectorXd torque = six(push, 0, 0, -push, 0, 0) - 2.0 * v;
    plant.advance(torque, 1e-3);
  }
  ASSERT_EQ(plant.sense().contacts.size(), 1u);
  const control::ContactRecord& record = plant.sense().contacts[0];
  EXPECT_EQ(record.link, 3);
  EXPECT_EQ(record.other_link, 6);
  EXPECT_EQ(record.object, -1);
  EXPECT_TRUE(record.isOfSelf());
  EXPECT_NEAR(record.force_N, push, 1e-6);
  EXPECT_LT((record.normal_W - Vector3d::UnitX()).norm(), 1e-9) << "out of the first link into the other";
  EXPECT_NEAR(record.depth, push / 2000, 1e-9);
  EXPECT_LT(record.friction_W.norm(), 1e-6);
}

/// Nothing but each other acts on them: their momentum stays as a blow and friction change both of theirs.
TEST(SelfContact, KeepsTheMomentumOfBoth) {
  description::Scene scene = weightless();
  scene.pairs.emplace_back().friction = 0.5;
  SimbodyPlant plant(twoBalls(), scene, six(0, 0, 0, 0.05, 0.01, 0));
  const VectorXd none = VectorXd::Zero(6);
  plant.advance(six(20, 0, 0, 0, 0, 0), 0.005);                    // 1 m/s
  const auto momentum = [&] {
    const VectorXd& v = plant.sense().qd;
    return Vector3d(sim_tests::mass * (v.head<3>() + v.tail<3>()));
  };
  const Vector3d before = momentum();
  const double speed = plant.sense().qd[0];
  EXPECT_GT(before.x(), 0.09);
  bool touched = false, rubbed = false;
  for (int i = 0; i < 200; ++i) {
    plant.advance(none, 1e-3);
    for (const control::ContactRecord& record : plant.sense().contacts) {
      touched = true;
      rubbed = rubbed || record.friction_W.norm() > 0.01;
    }
    ASSERT_LT((momentum() - before).norm(), 1e-4 * before.norm()) << "carriers of 1e-6 of their mass move along";
  }
  EXPECT_TRUE(touched);
  EXPECT_TRUE(rubbed);
  EXPECT_LT(plant.sense().qd[0], 0.9 * speed);
  EXPECT_GT(plant.sense().qd[3], 0.1 * speed);
}

TEST(SelfContact, IsOffWhereNoPairOfLinksIsNamed) {
  description::Robot robot = twoBalls();
  robot.self_contact.clear();
  SimbodyPlant plant(robot, weightless(), six(0, 0, 0, 0.03, 0, 0));
  plant.advance(VectorXd::Zero(6), 0.1);
  EXPECT_TRUE(plant.sense().contacts.empty());
  EXPECT_EQ(plant.sense().qd.norm(), 0);
}

TEST(SelfContact, HasTheMaterialThatAPairGives) {
  description::Scene scene = weightless();
  description::ContactPair& pair = scene.pairs.emplace_back();
  pair.one.link = 6;
  pair.other.link = 3;
  pair.stiffness = 500.0;
  const SimbodyPlant plant(twoBalls(), scene, six(0, 0, 0, 0.038, 0, 0));
  ASSERT_EQ(plant.sense().contacts.size(), 1u);
  EXPECT_NEAR(plant.sense().contacts[0].force_N, 500 * 0.002, 1e-9);
}

/// A ball pressed down on a link that is fixed to the world.
TEST(SelfContact, WithWhatIsFixedHoldsTheMovingLink) {
  description::Robot robot = sim_tests::slidingBody(sim_tests::sphere(0.02));
  robot.links[0].shapes = {description::BoxShape{sim_tests::at(0, 0, -0.05), {0.2, 0.2, 0.1}}};
  robot.self_contact = {{0, 3}};
  SimbodyPlant plant(robot, description::Scene(), Vector3d(0, 0, 0.025));
  plant.advance(Vector3d::Zero(), 2);
  ASSERT_EQ(plant.sense().contacts.size(), 1u);
  EXPECT_EQ(plant.sense().contacts[0].link, 3);
  EXPECT_EQ(plant.sense().contacts[0].other_link, 0);
  EXPECT_NEAR(plant.sense().contacts[0].force_N, 9.81 * sim_tests::mass, 1e-4);
  EXPECT_LT(plant.sense().contacts[0].normal_W.z(), -0.999);
}

class Hand : public ::testing::Test {
 protected:
  Hand() {
    std::vector<dsl::Diagnostic> warnings;
    robot_ = dsl::readRobot(TACTUS_SOURCE_DIR "/models/allegro_right.urdf", warnings);
    const std::vector<int> moving = robot_.movingJoints();
    for (int i = 0; i < static_cast<int>(moving.size()); ++i) index_[robot_.joints[moving[i]].name] = i;
    start_ = VectorXd::Zero(static_cast<Eigen::Index>(moving.size()));
    for (int i = 0; i < start_.size(); ++i)
      start_[i] = std::clamp(0.0, robot_.joints[moving[i]].lower, robot_.joints[moving[i]].upper);
  }

  void touchItself() {
    std::vector<int> all;
    for (int link = 0; link < static_cast<int>(robot_.links.size()); ++link) all.push_back(link);
    robot_.self_contact = dynamics::findSelfContact(robot_, start_, all).touching;
  }

  struct Closed {
    double overlap;                                                // m, of both links' shapes
    double force_N;                                                // of one on the other
    Vector3d way;                                                  // from the one's middle to the other's, world
  };
  /// Springs of 1 N m/rad pull the joints to `target` for a while: what has become of two links.
  Closed close(const VectorXd& target, const std::string& one, const std::string& other) {
    SimbodyPlant plant(robot_, weightless(), start_);
    for (int i = 0; i < 1500; ++i) {
      const control::Sensed& sensed = plant.sense();
      plant.advance((1.0 * (target - sensed.q) - 0.03 * sensed.qd).eval(), 1e-3);
    }
    const int a = robot_.linkIndex(one), b = robot_.linkIndex(other);
    Closed closed{};
    for (const control::ContactRecord& record : plant.sense().contacts)
      if ((record.link == a && record.other_link == b) || (record.link == b && record.other_link == a))
        closed.force_N += record.force_N;
    const dynamics::Model model(robot_);
    dynamics::Workspace workspace(model);
    dynamics::forwardKinematics(model, plant.sense().q, workspace);
    const Eigen::Isometry3d X_WA = dynamics::framePose(model, workspace, a),
                            X_WB = dynamics::framePose(model, workspace, b);
    closed.overlap = -dynamics::gapBetween(robot_.links[a], X_WA, robot_.links[b], X_WB);
    closed.way = X_WB * robot_.links[b].centre_of_mass - X_WA * robot_.links[a].centre_of_mass;
    return closed;
  }

  double& at(VectorXd& q, const std::string& joint) { return q[index_.at(joint)]; }

  description::Robot robot_;
  std::map<std::string, int> index_;
  VectorXd start_;
};

/// Bent, and swung towards each other by their springs: their capsules meet long before.
TEST_F(Hand, FingersThatCloseOnEachOtherDoNotPassThroughEachOther) {
  VectorXd target = start_;
  for (const std::string finger : {"index", "middle"}) at(target, finger + "_proximal") = 1.2;
  at(target, "index_abduction") = -0.47;
  at(target, "middle_abduction") = 0.47;
  const Closed at_start = close(start_, "index_distal", "middle_distal");
  const Closed through = close(target, "index_distal", "middle_distal");
  EXPECT_LT(through.way.dot(at_start.way), 0) << "without self-contact the index ends on the other side";
  EXPECT_EQ(through.force_N, 0);
  touchItself();
  const Closed stopped = close(target, "index_distal", "middle_distal");
  EXPECT_GT(stopped.way.dot(at_start.way), 0) << "with it, it stays on its own";
  EXPECT_GT(stopped.force_N, 0.3);
  EXPECT_GT(stopped.overlap, 0);
  EXPECT_LT(stopped.overlap, 0.003) << "m: its force over 2000 N/m";
}

/// At rest what the springs do is what the records say: each presses one link forward and the other one back.
TEST_F(Hand, TheThumbOnTheIndexFingerPressesBothAlike) {
  touchItself();
  VectorXd target = start_;
  at(target, "index_proximal") = 1.35;
  at(target, "index_medial") = 0.96;
  at(target, "thumb_opposition") = 1.2;
  at(target, "thumb_proximal") = 0.56;
  at(target, "thumb_medial") = 0.53;
  at(target, "thumb_distal") = 0.45;
  SimbodyPlant plant(robot_, weightless(), start_);
  VectorXd torque;
  for (int i = 0; i < 6000; ++i) {
    torque = 1.0 * (target - plant.sense().q) - 0.03 * plant.sense().qd;
    plant.advance(torque, 1e-3);
  }
  ASSERT_LT(plant.sense().qd.norm(), 1e-4);
  const dynamics::Model model(robot_);
  dynamics::Workspace workspace(model);
  dynamics::forwardKinematics(model, plant.sense().q, workspace);
  VectorXd borne = VectorXd::Zero(torque.size());
  Eigen::Matrix<double, 3, Eigen::Dynamic> of_link(3, torque.size()), of_other(3, torque.size());
  bool thumb_on_index = false;
  for (const control::ContactRecord& record : plant.sense().contacts) {
    ASSERT_TRUE(record.isOfSelf());
    const std::string names = robot_.links[record.link].name + " " + robot_.links[record.other_link].name;
    thumb_on_index = thumb_on_index || (names.find("index") != names.npos && names.find("thumb") != names.npos);
    dynamics::pointJacobian(model, workspace, record.link, record.point_W, of_link);
    dynamics::pointJacobian(model, workspace, record.other_link, record.point_W, of_other);
    borne += (of_link - of_other).transpose() * (record.force_N * record.normal_W + record.friction_W);
  }
  EXPECT_TRUE(thumb_on_index);
  EXPECT_GT(borne.norm(), 0.02) << "N m: they do press";
  EXPECT_LT((torque - borne).norm(), 0.01 * borne.norm()) << torque.transpose() << "\n" << borne.transpose();
}

/// Curled into the palm and across it: hard pushes, everything touches everything, nothing runs away.
TEST_F(Hand, AFistWithTheThumbInItComesToRest) {
  touchItself();
  VectorXd target = start_;
  for (const std::string finger : {"index", "middle", "ring"}) {
    at(target, finger + "_proximal") = 1.6;
    at(target, finger + "_medial") = 1.7;
    at(target, finger + "_distal") = 1.6;
  }
  at(target, "thumb_opposition") = 1.39;
  at(target, "thumb_medial") = 1.6;
  at(target, "thumb_distal") = 1.7;
  PlantOptions options;
  options.overspeed = std::numeric_limits<double>::infinity();     // the fist is closed faster than a real hand could
  SimbodyPlant plant(robot_, weightless(), start_, options);
  double energy_of_motion = 0, heaviest = 0;
  for (int i = 0; i < 3000; ++i) {
    const control::Sensed& sensed = plant.sense();
    VectorXd torque = (1.0 * (target - sensed.q) - 0.03 * sensed.qd).cwiseMax(-0.7).cwiseMin(0.7);
    plant.advance(torque, 1e-3);
    if (i >= 2500) energy_of_motion = std::max(energy_of_motion, sensed.qd.norm());
  }
  for (const control::ContactRecord& record : plant.sense().contacts) heaviest = std::max(heaviest, record.force_N);
  EXPECT_GE(plant.sense().contacts.size(), 3u);
  EXPECT_LT(energy_of_motion, 0.02) << "rad/s in the last half second";
  EXPECT_LT(heaviest, 60);
}

}  // namespace
}  // namespace tactus::sim
