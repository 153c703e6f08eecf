#include "framework/geometry/compound.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "framework/geometry/primitives.h"

namespace tactus::geometry {
namespace {

using Eigen::Vector3d;

PosedShape placed(std::shared_ptr<const Shape> shape, const Vector3d& at) {
  PosedShape part{std::move(shape)};
  part.pose.translation() = at;
  return part;
}

TEST(Compound, ByHand) {
  PosedShape bar = placed(std::make_shared<Capsule>(0.01, 0.1), {0, 0, 0.02});
  bar.pose.rotate(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()));  // lies along x
  const Compound both({placed(std::make_shared<Sphere>(0.03), Vector3d::Zero()), bar});
  EXPECT_NEAR(both.distance({0.06, 0, 0.02}).distance, 0, 1e-16);
  EXPECT_NEAR(both.distance({0.08, 0, 0.02}).distance, 0.02, 1e-16);
  EXPECT_LT((both.distance({0.08, 0, 0.02}).gradient - Vector3d(1, 0, 0)).norm(), 1e-15);
  EXPECT_NEAR(both.distance({0, 0, -0.05}).distance, 0.02, 1e-16);
  EXPECT_EQ(both.distance(Vector3d::Zero()).distance, -0.03) << "of the deepest part: a lower bound of the depth";
  EXPECT_DOUBLE_EQ(both.boundingRadius(), 0.08);
  EXPECT_FALSE(both.isConvex());
  EXPECT_LT((*both.support(Vector3d::UnitX()) - Vector3d(0.06, 0, 0.02)).norm(), 1e-15);
}

TEST(Compound, TakesOverWhatHoldsOfItsParts) {
  const Compound one({placed(std::make_shared<Sphere>(0.03), {1, 0, 0})});
  EXPECT_TRUE(one.isConvex());
  EXPECT_EQ(one.error(), 0);
  const Compound endless(
      {placed(std::make_shared<Sphere>(0.03), {1, 0, 0}), placed(std::make_shared<Plane>(), {0, 0, -1})});
  EXPECT_TRUE(std::isinf(endless.boundingRadius()));
  EXPECT_FALSE(endless.support(Vector3d::UnitX()));
  EXPECT_NEAR(endless.distance({1, 0, -0.7}).distance, 0.3, 1e-16);
  EXPECT_NEAR(endless.distance({1, 0, -0.2}).distance, 0.17, 1e-16);
  EXPECT_THROW(Compound({}), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::geometry
