// Points of a surface drawn evenly, and which of them a robot can reach.
#include "plugins/exploration/surface_samples.h"

#include <gtest/gtest.h>

#include "framework/geometry/primitives.h"
#include "tests/tasks/task_world.h"

namespace tactus::exploration {
namespace {

description::Object ballAt(const Eigen::Vector3d& p, double radius) {
  description::Object ball;
  ball.name = "ball";
  ball.pose.translation() = p;
  ball.primitives.push_back({std::make_shared<geometry::Sphere>(radius)});
  return ball;
}

TEST(SurfaceSamples, OfABallLieOnItEvenlyWithItsNormals) {
  description::Scene scene;
  scene.objects = {ballAt({1, 2, 3}, 0.1)};
  const auto samples = sampleSurface(scene, 0, 4000);
  ASSERT_EQ(samples.size(), 4000u);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  int above = 0;
  for (const SurfaceSample& sample : samples) {
    const Eigen::Vector3d out = sample.point_W - Eigen::Vector3d(1, 2, 3);
    EXPECT_NEAR(out.norm(), 0.1, 1e-9);
    EXPECT_LT((sample.normal_W - out.normalized()).norm(), 1e-9);
    mean += out.normalized() / 4000;
    above += out.z() > 0.05;                                       // Archimedes: a quarter of the area
  }
  EXPECT_LT(mean.norm(), 0.05);
  EXPECT_NEAR(above / 4000.0, 0.25, 0.025);
}

TEST(SurfaceSamples, LeaveOutWhatLiesInsideOfOtherShapes) {
  description::Scene scene;
  scene.objects = {ballAt({0, 0, 0}, 0.1), ballAt({0, 0, -0.15}, 0.1)};
  description::Primitive second{std::make_shared<geometry::Sphere>(0.08)};
  second.pose.translation() = Eigen::Vector3d(0.1, 0, 0);
  scene.objects[0].primitives.push_back(second);
  const auto samples = sampleSurface(scene, 0, 1000);
  ASSERT_EQ(samples.size(), 1000u);
  int on_second = 0;
  for (const SurfaceSample& sample : samples) {
    const double first = sample.point_W.norm() - 0.1;
    const double other = (sample.point_W - Eigen::Vector3d(0.1, 0, 0)).norm() - 0.08;
    EXPECT_GT(std::min(first, other), -1e-5);
    EXPECT_LT(std::abs(std::min(first, other)), 1e-5);
    EXPECT_GT((sample.point_W - Eigen::Vector3d(0, 0, -0.15)).norm(), 0.1 - 1e-5) << "another object";
    on_second += other < 1e-9;
  }
  EXPECT_GT(on_second, 100);
}

class ReachTest : public ::testing::Test {
 protected:
  test::TaskWorld world;
  description::Scene scene;
  ReachOptions options() {
    ReachOptions reach;
    reach.links = {world.link("middle_distal")};
    reach.clear = {world.link("palm"), world.link("lwr_6")};
    return reach;
  }
};

TEST_F(ReachTest, TheTopOfABallInFrontIsWithinItsUndersideAndWhatIsFarAwayAreNot) {
  scene.objects = {ballAt({0.7, 0, 0.1}, 0.1)};
  Reach reach(world.robot, scene, world.model, test::handOverTable(), options());
  EXPECT_TRUE(reach({{0.7, 0, 0.2}, {0, 0, 1}}));
  EXPECT_FALSE(reach({{2.7, 0, 0.2}, {0, 0, 1}}));
}

TEST_F(ReachTest, WhatTheHandWouldHaveToPassThroughCannotBeReached) {
  scene.objects = {ballAt({0.7, 0, 0.1}, 0.1)};
  EXPECT_TRUE(Reach(world.robot, scene, world.model, test::handOverTable(), options())({{0.7, 0, 0.2}, {0, 0, 1}}));
  description::Object slab = ballAt({0.7, 0, 0.27}, 1);
  slab.primitives = {{std::make_shared<geometry::Box>(Eigen::Vector3d(1, 1, 0.04))}};
  scene.objects.push_back(slab);
  EXPECT_FALSE(Reach(world.robot, scene, world.model, test::handOverTable(), options())({{0.7, 0, 0.2}, {0, 0, 1}}));
}

}  // namespace
}  // namespace tactus::exploration
