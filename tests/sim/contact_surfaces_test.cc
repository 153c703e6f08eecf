#include "sim/contact_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

TEST(LinkFeatures, KeepCapsulesInOrderOfLinksAndShapes) {
  description::Robot robot = sim_tests::world();
  sim_tests::addJoint(robot, "a", description::JointType::revolute, Eigen::Vector3d::UnitZ());
  robot.links[1].shapes = {sim_tests::sphere(0.01), sim_tests::capsule(0.02, 0.1)};
  robot.links[0].shapes = {sim_tests::sphere(0.03)};
  const std::vector<Feature> features = linkFeatures(robot);
  ASSERT_EQ(features.size(), 3u);
  EXPECT_EQ(features[0].owner.link, 0);
  EXPECT_EQ(features[1].owner.link, 1);
  EXPECT_EQ(features[2].owner.link, 1);
  EXPECT_EQ(features[2].feeler.radius, 0.02);
  EXPECT_EQ(features[2].feeler.from, Eigen::Vector3d(-0.05, 0, 0));
}

TEST(LinkFeatures, RowOfCapsulesSharesTheBoxsOuterFaces) {
  const Eigen::Vector3d size(0.0408, 0.1130, 0.095);               // the palm of the Allegro hand
  description::BoxShape box;
  box.size = size;
  box.pose = Eigen::Translation3d(-0.0093, 0.01, -0.0475) *
             Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized());
  description::Robot robot = sim_tests::world();
  robot.links[0].shapes = {box};
  const std::vector<Feature> features = linkFeatures(robot);
  ASSERT_GE(features.size(), 3u);

  Eigen::Vector3d low = Eigen::Vector3d::Constant(1), high = -low;
  for (const Feature& feature : features)
    for (const Eigen::Vector3d& end_L : {feature.feeler.from, feature.feeler.to}) {
      const Eigen::Vector3d end = box.pose.inverse() * end_L;
      low = low.cwiseMin((end.array() - feature.feeler.radius).matrix());
      high = high.cwiseMax((end.array() + feature.feeler.radius).matrix());
    }
  EXPECT_LT((low + 0.5 * size).norm(), 1e-12) << "all six faces are reached and none is passed";
  EXPECT_LT((high - 0.5 * size).norm(), 1e-12);
  for (size_t i = 1; i < features.size(); ++i)
    EXPECT_LE((features[i].feeler.from - features[i - 1].feeler.from).norm(), features[i].feeler.radius + 1e-12);
}

TEST(LinkFeatures, CubeIsASphereAndSquareRodOneCapsule) {
  description::Robot robot = sim_tests::world();
  description::BoxShape cube, rod;
  cube.size = {0.1, 0.1, 0.1};
  rod.size = {0.02, 0.1, 0.02};
  robot.links[0].shapes = {cube, rod};
  const std::vector<Feature> features = linkFeatures(robot);
  ASSERT_EQ(features.size(), 2u);
  EXPECT_EQ(features[0].feeler.from, features[0].feeler.to);
  EXPECT_NEAR((features[1].feeler.to - features[1].feeler.from).norm(), 0.08, 1e-15);
}

}  // namespace
}  // namespace tactus::sim
