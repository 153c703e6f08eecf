#include "framework/runtime/feature_truth.h"

#include <gtest/gtest.h>

#include "framework/geometry/primitives.h"

namespace tactus::runtime {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

std::shared_ptr<const geometry::Shape> slab() { return std::make_shared<geometry::Box>(Vector3d(0.6, 0.4, 0.02)); }

description::Object objectOf(const std::shared_ptr<const geometry::Shape>& shape, const Vector3d& position = Vector3d::Zero(),
                             const Eigen::Matrix3d& rotation = Eigen::Matrix3d::Identity()) {
  description::Object object;
  object.name = "thing";
  description::Primitive primitive{shape, Isometry3d::Identity()};
  primitive.pose.linear() = rotation;
  object.primitives.push_back(primitive);
  object.pose.translation() = position;
  return object;
}

void expectNear(const std::optional<Vector3d>& point, const Vector3d& expected) {
  ASSERT_TRUE(point);
  EXPECT_LT((*point - expected).norm(), 1e-12) << point->transpose() << " instead of " << expected.transpose();
}

const Eigen::Matrix3d lying = AngleAxisd(M_PI / 2, Vector3d::UnitX()).toRotationMatrix();

TEST(HighestPoint, OfUprightShapesIsTheMiddleOfTheirTops) {
  expectNear(highestPoint(objectOf(std::make_shared<geometry::Sphere>(0.03), {0.7, 0.1, 0.2})), {0.7, 0.1, 0.23});
  expectNear(highestPoint(objectOf(slab(), {1, 2, 3})), {1, 2, 3.01});
  expectNear(highestPoint(objectOf(std::make_shared<geometry::Cylinder>(0.05, 0.2), {1, 2, 3})), {1, 2, 3.1});
  expectNear(highestPoint(objectOf(std::make_shared<geometry::Capsule>(0.05, 0.2), {1, 2, 3})), {1, 2, 3.15});
}

TEST(HighestPoint, OfLyingShapesIsTheMiddleOfTheirEdges) {
  expectNear(highestPoint(objectOf(std::make_shared<geometry::Cylinder>(0.05, 0.2), {1, 2, 3}, lying)), {1, 2, 3.05});
  expectNear(highestPoint(objectOf(std::make_shared<geometry::Capsule>(0.05, 0.2), {1, 2, 3}, lying)), {1, 2, 3.05});
}

TEST(HighestPoint, OfATiltedBoxIsItsEdge) {
  const Eigen::Matrix3d tilt = AngleAxisd(M_PI / 4, Vector3d::UnitY()).toRotationMatrix();
  expectNear(highestPoint(objectOf(std::make_shared<geometry::Box>(Vector3d(0.2, 0.4, 0.2)), {0, 0, 0}, tilt)),
             {0, 0, 0.1 * M_SQRT2});
}

TEST(HighestPoint, OfAUnionIsThatOfItsHighestPart) {
  description::Object object = objectOf(slab(), {0.7, 0, 0.2});
  description::Primitive ball{std::make_shared<geometry::Sphere>(0.03), Isometry3d::Identity()};
  ball.pose.translation() = Vector3d(0.04, 0.05, 0.01);
  object.primitives.push_back(ball);
  object.pose.linear() = AngleAxisd(M_PI / 2, Vector3d::UnitZ()).toRotationMatrix();
  expectNear(highestPoint(object), {0.7 - 0.05, 0.04, 0.24});
}

TEST(HighestPoint, APlaneHasNone) { EXPECT_FALSE(highestPoint(objectOf(std::make_shared<geometry::Plane>()))); }

TEST(FeatureMetrics, HorizontalAndVerticalErrorApart) {
  control::FeatureEstimate estimate;
  estimate.found = true;
  estimate.position_W = Vector3d(0.703, 0.096, 0.2285);
  const auto metrics = featureMetrics("bump", estimate, Vector3d(0.7, 0.1, 0.23));
  ASSERT_EQ(metrics.size(), 3u);
  EXPECT_EQ(metrics[0].name, "bump_found");
  EXPECT_EQ(metrics[0].value, 1);
  EXPECT_EQ(metrics[1].name, "bump_position_error_m");
  EXPECT_NEAR(metrics[1].value, 0.005, 1e-12);
  EXPECT_EQ(metrics[2].name, "bump_height_error_m");
  EXPECT_NEAR(metrics[2].value, 0.0015, 1e-12);
}

TEST(FeatureMetrics, NothingFoundHasNoErrors) {
  const auto metrics = featureMetrics("bump", {}, Vector3d(0.7, 0.1, 0.23));
  ASSERT_EQ(metrics.size(), 1u);
  EXPECT_EQ(metrics[0].value, 0);
}

TEST(FeatureMetrics, WithoutTruthThereIsNoError) {
  control::FeatureEstimate estimate;
  estimate.found = true;
  EXPECT_EQ(featureMetrics("bump", estimate, {}).size(), 1u);
}

}  // namespace
}  // namespace tactus::runtime
