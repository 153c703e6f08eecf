// The scene that a seed draws.

#include "dsl/stack.h"

#include <gtest/gtest.h>

#include <set>

namespace tactus::dsl {
namespace {

ObjectDescription object(const std::string& name, const Eigen::Vector3d& jitter, const std::string& on = "") {
  ObjectDescription described;
  described.object.name = name;
  described.jitter = jitter;
  described.on = on;
  return described;
}

Stack tableWithBump() {
  Stack stack;
  stack.objects = {object("table", {0, 0, 0.01}), object("bump", {0.02, 0.04, 0}, "table")};
  return stack;
}

Eigen::Vector3d place(const description::Scene& scene, std::size_t i) { return scene.objects[i].pose.translation(); }

TEST(Scene, SeedZeroDrawsNothing) {
  const auto scene = tableWithBump().scene(0);
  EXPECT_EQ(place(scene, 0), Eigen::Vector3d::Zero());
  EXPECT_EQ(place(scene, 1), Eigen::Vector3d::Zero());
}

TEST(Scene, DrawsStayWithinJitterAndFillIt) {
  const Stack stack = tableWithBump();
  Eigen::Vector3d least = Eigen::Vector3d::Constant(1), most = -least, sum = Eigen::Vector3d::Zero();
  const int seeds = 2000;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto scene = stack.scene(static_cast<std::uint64_t>(seed));
    const Eigen::Vector3d own = place(scene, 1) - place(scene, 0) + Eigen::Vector3d(0, 0, place(scene, 0).z());
    least = least.cwiseMin(own);
    most = most.cwiseMax(own);
    sum += own;
    EXPECT_EQ(place(scene, 1).z(), place(scene, 0).z());  // the bump moves with its table
    EXPECT_EQ(place(scene, 0).x(), 0);
  }
  const Eigen::Vector3d jitter(0.02, 0.04, 0.01);
  EXPECT_TRUE((most.array() <= jitter.array()).all() && (least.array() >= -jitter.array()).all());
  EXPECT_TRUE((most.array() > 0.99 * jitter.array()).all() && (least.array() < -0.99 * jitter.array()).all());
  EXPECT_TRUE((sum.array().abs() / seeds < 0.05 * jitter.array()).all());  // 5 σ of the mean is 0.065
}

TEST(Scene, TheSameSeedGivesTheSameSceneOnEveryMachine) {
  const auto scene = tableWithBump().scene(1);
  // SplitMix64 and FNV-1a are defined to the bit; these are their values, worked out apart in exact arithmetic.
  EXPECT_EQ(place(scene, 0).z(), 0.0032258073866376093);
  EXPECT_EQ(place(scene, 1).x(), -0.018727059088624362);
  EXPECT_EQ(place(scene, 1).y(), -0.03803227970637368);
}

TEST(Scene, OtherObjectsDoNotChangeADraw) {
  Stack more = tableWithBump();
  more.objects.insert(more.objects.begin(), object("lamp", {1, 1, 1}));
  EXPECT_EQ(place(more.scene(7), 2), place(tableWithBump().scene(7), 1));
}

TEST(Scene, SeedsDiffer) {
  std::set<double> heights;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) heights.insert(place(tableWithBump().scene(seed), 0).z());
  EXPECT_EQ(heights.size(), 100u);
}

}  // namespace
}  // namespace tactus::dsl
