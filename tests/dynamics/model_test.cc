#include "framework/dynamics/model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/dynamics/random_state.h"

// What a Model says of a description: numbers, names, limits, merged inertias.  Its poses are tried in
// kinematics_test.cc, its refusals in check_robot_test.cc.
namespace tactus::dynamics {
namespace {

using description::JointType;

TEST(Model, CoordinatesAreThoseOfTheDescriptionInItsOrder) {
  onRandomStates(21, [](RandomState& state, test_robots::Random&) {
    int position = 0, coordinate = 0;
    for (const int j : state.robot.movingJoints()) {
      const description::Joint& joint = state.robot.joints[j];
      const auto own = std::ranges::find(state.model.joints(), joint.name, &Model::Joint::name);
      ASSERT_NE(own, state.model.joints().end());
      EXPECT_EQ(own->type, joint.type);
      EXPECT_EQ(own->driver, -1);
      EXPECT_EQ(own->position, position);
      EXPECT_EQ(own->coordinate, coordinate);
      EXPECT_EQ(state.model.frames()[joint.child].body, own->first_body + own->body_count - 1);
      if (own->coordinate_count == 1) {
        EXPECT_EQ(state.model.jointIndex(joint.name), coordinate);
      }
      position += description::positionCount(joint.type);
      coordinate += description::velocityCount(joint.type);
    }
    EXPECT_EQ(state.model.positionCount(), position);
    EXPECT_EQ(state.model.dof(), coordinate);
    EXPECT_EQ(state.model.jointNames().size(), static_cast<size_t>(coordinate));
    for (int i = 0; i < state.model.bodyCount(); ++i) EXPECT_LT(state.model.parent(i), i);
    for (size_t i = 0; i < state.robot.links.size(); ++i) {
      EXPECT_EQ(state.model.frames()[i].name, state.robot.links[i].name);
      EXPECT_EQ(state.model.frameIndex(state.robot.links[i].name), static_cast<int>(i));
    }
  });
}

TEST(Model, NamesOfCoordinatesSayWhatMoves) {
  description::Robot robot;
  for (const char* name : {"base", "sled", "wrist", "body"}) test_robots::addLink(robot, name, 1, {0, 0, 0}, {1, 1, 1});
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  test_robots::addJoint(robot, "slide", JointType::planar, 0, 1, here);
  test_robots::addJoint(robot, "ball", JointType::spherical, 1, 2, here);
  test_robots::addJoint(robot, "free", JointType::floating, 0, 3, here);
  const Model model(robot);
  EXPECT_THAT(model.jointNames(), ::testing::ElementsAre("slide.x", "slide.y", "slide.angle", "ball.wx", "ball.wy",
                                                         "ball.wz", "free.x", "free.y", "free.z", "free.wx", "free.wy",
                                                         "free.wz"));
  EXPECT_THAT(model.positionNames(), ::testing::ElementsAre("slide.x", "slide.y", "slide.angle", "ball.qw", "ball.qx",
                                                            "ball.qy", "ball.qz", "free.x", "free.y", "free.z",
                                                            "free.qw", "free.qx", "free.qy", "free.qz"));
  EXPECT_EQ(model.neutral(), (Eigen::VectorXd(14) << 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0).finished());
}

TEST(Model, ADriverKeepsTheLimitsOfWhatItDrives) {
  description::Robot robot = test_robots::lwr();
  robot.joints[0].lower = -1;
  robot.joints[0].upper = 1;
  robot.joints[0].velocity = 2;
  robot.joints[0].damping = 0.5;
  robot.joints[0].friction = 0.25;
  description::Joint& driven = robot.joints[3];
  driven.mimic = description::Mimic{0, -2, 0.5};
  driven.lower = -1.5;                                             // -2 q + 0.5 ≥ -1.5: q ≤ 1
  driven.upper = 1.5;                                              // q ≥ -0.5
  driven.velocity = 3;
  driven.damping = 1;
  driven.friction = 1;
  const Model model(robot);
  EXPECT_EQ(model.dof(), 6);
  EXPECT_EQ(model.bodyCount(), 7);
  EXPECT_TRUE(model.coupled());
  EXPECT_EQ(model.lower()[0], -0.5);
  EXPECT_EQ(model.upper()[0], 1);
  EXPECT_EQ(model.velocityLimit()[0], 1.5);
  EXPECT_EQ(model.damping()[0], 4.5);
  EXPECT_EQ(model.friction()[0], 2.25);
  EXPECT_EQ(model.joints()[3].driver, 0);
  EXPECT_EQ(model.jointIndex("a3"), -1);
  EXPECT_TRUE(model.supports(0, model.frameIndex("4")));
}

TEST(Model, AJointSupportsWhatItCarries) {
  onRandomStates(22, [](RandomState& state, test_robots::Random&) {
    const Model& model = state.model;
    for (size_t frame = 0; frame < model.frames().size(); ++frame) {
      std::vector<bool> carries(model.dof(), false);
      for (int body = model.frames()[frame].body; body >= 0; body = model.parent(body))
        carries[model.bodies()[body].coordinate] = true;
      for (int joint = 0; joint < model.dof(); ++joint) {
        EXPECT_EQ(model.supports(joint, static_cast<int>(frame)), carries[joint]);
      }
    }
  });
}

TEST(Model, LimitsFollowTheOrderOfQ) {
  description::Robot robot = test_robots::lwr();
  robot.joints[3].lower = -2.0944;
  robot.joints[3].upper = 2.0944;
  robot.joints[3].effort = 100;
  robot.joints[3].velocity = 2.23402;
  const Model model(robot);
  EXPECT_EQ(model.lower()[3], -2.0944);
  EXPECT_EQ(model.upper()[3], 2.0944);
  EXPECT_EQ(model.effort()[3], 100);
  EXPECT_EQ(model.velocityLimit()[3], 2.23402);
  EXPECT_EQ(model.effort()[2], description::infinity);
  EXPECT_EQ(model.lower().size(), 7);
}

TEST(Model, TheTestRobotsHaveTheirDegreesOfFreedom) {
  const Model humanoid(test_robots::humanoid());
  EXPECT_EQ(humanoid.dof(), 36);
  EXPECT_EQ(humanoid.positionCount(), 37);
  double mass = 0;
  for (const Model::Body& body : humanoid.bodies()) mass += body.inertia.mass;
  EXPECT_NEAR(mass, 75.3, 1e-9);
  const Model chain(test_robots::chain(50));
  EXPECT_EQ(chain.dof(), 50);
  for (int i = 0; i < 50; ++i) EXPECT_EQ(chain.parent(i), i - 1);
}

TEST(Model, UnknownNamesHaveNoIndex) {
  const Model model(test_robots::lwr());
  EXPECT_EQ(model.frameIndex("8"), -1);
  EXPECT_EQ(model.jointIndex("7"), -1);
}

TEST(Model, MassIsKept) {
  const description::Robot robot = test_robots::lwrAllegro();
  const Model model(robot);
  EXPECT_EQ(model.dof(), 23);
  double link_mass = 0, body_mass = 0;
  for (const description::Link& link : robot.links) link_mass += link.mass;
  for (const Model::Body& body : model.bodies()) body_mass += body.inertia.mass;
  EXPECT_NEAR(body_mass, link_mass - 2.0, 1e-12);                  // the base is fixed to the world
}

/// One link on a slider, at a given axis, with a hand fixed to it: everything can be said by hand.
description::Robot slider(const Eigen::Vector3d& axis) {
  description::Robot robot;
  const int base = test_robots::addLink(robot, "base", 0, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const int post = test_robots::addLink(robot, "post", 5, Eigen::Vector3d::Zero(), {1, 1, 1});
  const int sled = test_robots::addLink(robot, "sled", 2, {1, 0, 0}, {0.1, 0.2, 0.25});
  const int hand = test_robots::addLink(robot, "hand", 3, {0, 0, 0}, {0.1, 0.2, 0.25});
  test_robots::addJoint(robot, "foot", JointType::fixed, base, post, test_robots::pose({0, 0, 1}));
  test_robots::addJoint(robot, "slide", JointType::prismatic, post, sled, test_robots::pose({0, 0, 1}), axis)
      .rotor_inertia = 0.02;
  test_robots::addJoint(robot, "wrist", JointType::fixed, sled, hand, test_robots::pose({-1, 0, 0}));
  return robot;
}

TEST(Model, FixedLinksAreMergedAndStayFrames) {
  const Model model(slider(Eigen::Vector3d::UnitX()));
  ASSERT_EQ(model.dof(), 1);
  EXPECT_EQ(model.frames()[0].body, -1);
  EXPECT_EQ(model.frames()[1].body, -1);
  EXPECT_EQ(model.frames()[1].pose.translation(), Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(model.frames()[2].body, 0);
  EXPECT_EQ(model.frames()[3].body, 0);
  const RigidBodyInertia I = model.bodies()[0].inertia.transformed(model.frames()[2].pose.inverse());  // sled's axes
  EXPECT_EQ(I.mass, 5);
  EXPECT_TRUE(near(I.first_moment, Eigen::Vector3d(2 - 3, 0, 0), 1e-15));
  // Links, Steiner's share m x² about y and z, and the rotor: 0.02 about x, 0.01 about the others.
  EXPECT_TRUE(near(I.rotational,
                   Eigen::Matrix3d(Eigen::Vector3d(0.2 + 0.02, 0.4 + 5 + 0.01, 0.5 + 5 + 0.01).asDiagonal()), 1e-14));
}

TEST(Model, BodyFramesHaveTheJointAxisAsZ) {
  onRandomStates(23, [](RandomState& state, test_robots::Random&) {
    for (const description::Joint& joint : state.robot.joints) {
      if (joint.type == JointType::fixed || joint.type == JointType::spherical || joint.type == JointType::floating)
        continue;
      const Eigen::Isometry3d& X_BF = state.model.frames()[joint.child].pose;
      EXPECT_TRUE(near(X_BF.linear() * joint.axis, Eigen::Vector3d::UnitZ(), 1e-14));
      EXPECT_EQ(X_BF.translation(), Eigen::Vector3d::Zero());
    }
  });
}

TEST(Model, CoordinateAxesCostNoRounding) {
  for (int k = 0; k < 3; ++k) {
    for (const double sign : {-1.0, 1.0}) {
      const Model model(slider(sign * Eigen::Vector3d::Unit(k)));
      const Eigen::Matrix3d R = model.frames()[2].pose.linear();
      EXPECT_EQ(R * R.transpose(), Eigen::Matrix3d::Identity());
      EXPECT_EQ(R.cwiseAbs().sum(), 3);
    }
  }
}

TEST(Model, KinematicsNeedNoMass) {
  description::Robot robot = test_robots::allegro();
  for (description::Link& link : robot.links) link.has_inertial = false;
  EXPECT_THROW(Model(robot, MassPolicy::required), ModelError);
  EXPECT_EQ(Model(robot, MassPolicy::kinematics_only).dof(), 16);
}

}  // namespace
}  // namespace tactus::dynamics
