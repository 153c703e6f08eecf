// The most links that any posture lets touch: cases one can see, and grids of postures as witnesses.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>

#include "framework/dynamics/kinematics.h"
#include "framework/geometry/compound.h"
#include "framework/geometry/primitives.h"
#include "plugins/posture-search/posture_search.h"

namespace tactus::plugins {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.01, kLength = 0.04;

/// A finger of three capsules along x in the plane y = 0, whose joints lift it towards z.
description::Robot finger() {
  description::Robot robot;
  robot.name = "finger";
  robot.links.emplace_back().name = "base";
  for (int i = 0; i < 3; ++i) {
    description::Link& link = robot.links.emplace_back();
    link.name = "link" + std::to_string(i);
    link.has_inertial = true;
    link.mass = 0.05;
    link.inertia = 1e-5 * Eigen::Matrix3d::Identity();
    link.shapes.push_back(description::CapsuleShape{Vector3d(kRadius, 0, 0), Vector3d(kLength - kRadius, 0, 0), kRadius});
    description::Joint& joint = robot.joints.emplace_back();
    joint.name = "joint" + std::to_string(i);
    joint.type = description::JointType::revolute;
    joint.parent = i;
    joint.child = i + 1;
    joint.origin.translation() = Vector3d(i == 0 ? 0 : kLength, 0, 0);
    joint.axis = -Vector3d::UnitY();
    joint.lower = -0.2;
    joint.upper = 1.6;
  }
  return robot;
}

PostureSearchOptions optionsOf(double give = 1e-4) {
  PostureSearchOptions options;
  options.joints = {0, 1, 2};
  options.links = {1, 2, 3};
  options.give = give;
  return options;
}

geometry::Compound at(const Vector3d& place, std::shared_ptr<const geometry::Shape> shape) {
  return geometry::Compound({{std::move(shape), Eigen::Isometry3d(Eigen::Translation3d(place))}});
}

class Finger : public testing::Test {
 protected:
  int most(const geometry::Shape& world, PostureSearchOptions options = optionsOf()) {
    found_ = PostureSearch(robot_, model_, std::move(options))(world, Eigen::VectorXd::Zero(3));
    return found_.touching;
  }

  /// Of link i in a posture, by very many points of its axis.
  double gap(const geometry::Shape& world, const Eigen::VectorXd& q, int link) const {
    dynamics::Workspace workspace(model_);
    dynamics::forwardKinematics(model_, q, workspace);
    const Eigen::Isometry3d X_WL = dynamics::framePose(model_, workspace, link);
    double least = INFINITY;
    for (int k = 0; k <= 400; ++k)
      least = std::min(least, world.distance(X_WL * Vector3d(kRadius + (kLength - 2 * kRadius) * k / 400, 0, 0)).distance);
    return least - kRadius;
  }

  description::Robot robot_ = finger();
  dynamics::Model model_{robot_};
  PostureFound found_;
};

TEST_F(Finger, LiesAlongAPlaneWithAllLinks) {
  const auto ceiling = at({0.06, 0, kRadius + 0.05}, std::make_shared<geometry::Box>(Vector3d(0.4, 0.4, 0.1)));
  EXPECT_EQ(most(ceiling), 3);
  EXPECT_LT(found_.q.cwiseAbs().maxCoeff(), 0.05);
}

// A wall across the end of the straight finger is out of reach of all but the last link.
TEST_F(Finger, TouchesAWallWithItsTipAlone) {
  const auto wall = at({3 * kLength + 0.05 - 0.004, 0, 0}, std::make_shared<geometry::Box>(Vector3d(0.1, 0.4, 0.01)));
  EXPECT_EQ(most(wall), 1);
  EXPECT_NEAR(gap(wall, found_.q, 3), 0, 1e-4);
}

TEST_F(Finger, TouchesNothingOutOfReach) {
  const auto far = at({0.3, 0, 0}, std::make_shared<geometry::Sphere>(0.05));
  EXPECT_EQ(most(far), 0);
  EXPECT_EQ(found_.q.size(), 3);
}

// Inside of a big ball no posture is clear.
TEST_F(Finger, FindsNoPostureInsideOfThings) {
  most(at({0.05, 0, 0}, std::make_shared<geometry::Sphere>(0.5)));
  EXPECT_EQ(found_.q.size(), 0);
}

// A thing below the finger is touched with its back: a finger that feels above alone has nothing of it.
TEST_F(Finger, CountsTheSideThatFeels) {
  const auto floor = at({0.06, 0, -kRadius - 0.05}, std::make_shared<geometry::Box>(Vector3d(0.4, 0.4, 0.1)));
  EXPECT_EQ(most(floor), 3);
  PostureSearchOptions above = optionsOf();
  above.side = {Vector3d::UnitZ(), std::numbers::pi / 2};
  EXPECT_EQ(most(floor, above), 0);
}

// What is asked for less is found more: with a thing that gives way, never fewer links touch.
TEST_F(Finger, FindsNoFewerInSofterThings) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> x(0.02, 0.1), z(0.03, 0.07), radius(0.015, 0.04);
  for (int trial = 0; trial < 8; ++trial) {
    const auto ball = at({x(random), 0, z(random) + 0.02}, std::make_shared<geometry::Sphere>(radius(random)));
    EXPECT_LE(most(ball, optionsOf(1e-4)), most(ball, optionsOf(2e-3)));
  }
}

// Two witnesses: what is found does touch, by another way to measure; and no posture of a grid touches with more links
// within the depth that is allowed.
TEST_F(Finger, FindsAsManyAsAGridOfPostures) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> x(0.02, 0.1), z(0.045, 0.07), radius(0.01, 0.03);
  const double give = 1.5e-3;
  int most_of_grid = 0;
  for (int trial = 0; trial < 4; ++trial) {
    const auto ball = at({x(random), 0, z(random)}, std::make_shared<geometry::Sphere>(radius(random)));
    const int found = most(ball, optionsOf(give));
    ASSERT_EQ(found_.q.size(), 3);
    int touching = 0;
    for (int link = 1; link <= 3; ++link) {
      const double depth = -gap(ball, found_.q, link);
      EXPECT_LE(depth, give + 1e-6);
      touching += depth >= -1e-6;
    }
    EXPECT_GE(touching, found);
    constexpr int steps = 90;
    int best = 0;
    const auto position = [](int i) { return -0.2 + 1.8 * i / steps; };
    for (int i = 0; i <= steps; ++i) {
      const double first = -gap(ball, Vector3d(position(i), 0, 0), 1);
      if (first > give) continue;
      for (int j = 0; j <= steps; ++j) {
        const double second = -gap(ball, Vector3d(position(i), position(j), 0), 2);
        if (second > give || (first < 0 && second < 0 && best > 0)) continue;
        for (int k = 0; k <= steps; ++k) {
          const double third = -gap(ball, Vector3d(position(i), position(j), position(k)), 3);
          if (third <= give) best = std::max(best, (first >= 0) + (second >= 0) + (third >= 0));
        }
      }
    }
    EXPECT_GE(found, best) << "trial " << trial;
    most_of_grid = std::max(most_of_grid, best);
  }
  EXPECT_GE(most_of_grid, 2);
}

TEST_F(Finger, RefusesWhatIsNoChain) {
  PostureSearchOptions backwards = optionsOf();
  backwards.joints = {2, 1, 0};
  EXPECT_THROW(PostureSearch(robot_, model_, backwards), std::invalid_argument);
  PostureSearchOptions base = optionsOf();
  base.joints = {1, 2};
  EXPECT_THROW(PostureSearch(robot_, model_, base), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::plugins
