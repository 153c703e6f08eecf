// Which links of a robot touch each other: all but neighbours and those that overlap where it starts.

#include "framework/dynamics/self_contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace tactus::dynamics {
namespace {

using description::BoxShape;
using description::CapsuleShape;
using description::JointType;
using description::LinkPair;
using Eigen::Vector3d;
using testing::ElementsAre;

Eigen::Isometry3d at(double x, double y, double z) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, z)); }

description::Link linkWith(const description::LinkShape& shape) {
  description::Link link;
  link.shapes = {shape};
  return link;
}

/// A chain along x: base, upper, sleeve fixed on it, lower, tip; each 10 cm, a capsule of 1 cm about the middle.
description::Robot chain() {
  description::Robot robot;
  for (const char* name : {"base", "upper", "sleeve", "lower", "tip"}) {
    description::Link link = linkWith(CapsuleShape{{0.03, 0, 0}, {0.07, 0, 0}, 0.01});
    link.name = name;
    link.has_inertial = true;
    link.mass = 1;
    link.inertia = 1e-3 * Eigen::Matrix3d::Identity();
    robot.links.push_back(link);
    if (robot.links.size() == 1) continue;
    description::Joint joint;
    joint.name = name;
    joint.type = robot.links.size() == 3 ? JointType::fixed : JointType::revolute;
    joint.parent = static_cast<int>(robot.links.size()) - 2;
    joint.child = joint.parent + 1;
    joint.origin = at(0.1, 0, 0);
    robot.joints.push_back(joint);
  }
  return robot;
}

const std::vector<int> kAll{0, 1, 2, 3, 4};

TEST(SelfContact, LeavesOutNeighboursAndSaysWhy) {
  const SelfContact found = findSelfContact(chain(), Vector3d::Zero(), kAll);
  EXPECT_THAT(found.touching, ElementsAre(LinkPair{0, 3}, LinkPair{0, 4}, LinkPair{1, 4}, LinkPair{2, 4}));
  ASSERT_EQ(found.left_out.size(), 6u);
  EXPECT_EQ(found.left_out[0].links, (LinkPair{0, 1}));
  EXPECT_EQ(found.left_out[0].why, "joint 'upper' joins them");
  EXPECT_EQ(found.left_out[1].links, (LinkPair{0, 2}));
  EXPECT_EQ(found.left_out[1].why, "joint 'upper' joins them") << "through the fixed joint";
  EXPECT_EQ(found.left_out[2].links, (LinkPair{1, 2}));
  EXPECT_EQ(found.left_out[2].why, "they are one body");
}

/// Folded back: the tip lies in the upper link.
TEST(SelfContact, LeavesOutWhatOverlapsAtTheStart) {
  const Vector3d folded(0, 0.5 * std::numbers::pi, 0.5 * std::numbers::pi);
  description::Robot robot = chain();
  robot.joints[3].origin = at(0.015, 0, 0);                        // the tip's, near the lower link's joint
  const SelfContact found = findSelfContact(robot, folded, kAll);
  const auto left_out = std::find_if(found.left_out.begin(), found.left_out.end(),
                                     [](const auto& one) { return one.links == LinkPair{2, 4}; });
  ASSERT_NE(left_out, found.left_out.end());
  EXPECT_EQ(left_out->why, "they overlap at the start, by 5.0 mm");
  EXPECT_THAT(found.touching, testing::Not(testing::Contains(LinkPair{2, 4})));
}

TEST(SelfContact, KnowsOnlyTheLinksAskedForThatHaveShapes) {
  description::Robot robot = chain();
  robot.links[4].shapes.clear();
  EXPECT_THAT(findSelfContact(robot, Vector3d::Zero(), kAll).touching, ElementsAre(LinkPair{0, 3}));
  EXPECT_THAT(findSelfContact(chain(), Vector3d::Zero(), {4, 0, 4}).touching, ElementsAre(LinkPair{0, 4}));
}

TEST(Gap, OfCapsulesIsThatOfTheirAxesLessTheRadii) {
  const description::Link along_x = linkWith(CapsuleShape{{-1, 0, 0}, {1, 0, 0}, 0.1});
  const description::Link along_y = linkWith(CapsuleShape{{0, -1, 0}, {0, 1, 0}, 0.2});
  const Eigen::Isometry3d here = Eigen::Isometry3d::Identity();
  EXPECT_NEAR(gapBetween(along_x, here, along_y, at(0.3, 0.2, 1)), 0.7, 1e-9);
  EXPECT_NEAR(gapBetween(along_x, here, along_y, at(0.3, 0.2, 0.25)), -0.05, 1e-9);
  EXPECT_NEAR(gapBetween(along_x, here, along_y, at(2, 0, 0)), 0.7, 1e-9) << "end against side";
  EXPECT_EQ(gapBetween(along_x, here, description::Link(), here), description::infinity);
}

/// Random boxes: they overlap where a point of a fine grid in one lies in the other.
TEST(Gap, OfBoxesIsBelowZeroWhereTheyOverlap) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vector3d size(0.6, 0.4, 0.2);
  const description::Link box = linkWith(BoxShape{Eigen::Isometry3d::Identity(), size});
  int overlapping = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Eigen::Isometry3d X = at(0.5 * uniform(random), 0.4 * uniform(random), 0.4 * uniform(random));
    X.linear() = Eigen::Quaterniond(uniform(random), uniform(random), uniform(random), uniform(random))
                     .normalized()
                     .toRotationMatrix();
    const double gap = gapBetween(box, Eigen::Isometry3d::Identity(), box, X);
    bool inside = false;
    for (double u = -0.5; u <= 0.501; u += 0.05)
      for (double v = -0.5; v <= 0.501; v += 0.05)
        for (double w = -0.5; w <= 0.501; w += 0.05)
          inside = inside || ((X * Vector3d(u * 0.6, v * 0.4, w * 0.2)).cwiseAbs().array() <= 0.5 * size.array()).all();
    if (inside) {
      EXPECT_LE(gap, 1e-9) << trial;
    }
    if (gap < -0.03) {
      EXPECT_TRUE(inside) << trial;
    }
    overlapping += inside;
  }
  EXPECT_GT(overlapping, 50);
  EXPECT_LT(overlapping, 190);
}

}  // namespace
}  // namespace tactus::dynamics
