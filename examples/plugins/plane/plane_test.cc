#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "conformance/bench.h"
#include "conformance/conformance.h"

namespace {

using tactus::conformance::Bench;

double port(const Bench& bench, const char* name) {
  return *static_cast<const double*>(bench.signal("floor").port(name));
}

/// Touches `count` random points of a plane that leans by `tilt` about x, each `noise` off; one finger, one tick each.
void touchPlane(Bench& bench, double tilt, int count, double noise) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()).toRotationMatrix();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> along(-0.1, 0.1), off(-noise, noise);
  for (int k = 0; k < count; ++k) {
    tactus::control::ContactRecord contact;
    contact.link = bench.robot().model().frameIndex("index_distal");
    contact.object = 0;
    contact.point_W = R * Eigen::Vector3d(along(random), along(random), off(random)) + Eigen::Vector3d(0.6, 0, 0.2);
    contact.normal_W = -R.col(2);
    contact.force_N = 1;
    bench.sensed.contacts = {contact};
    bench.tick();
  }
}

TEST(PlaneFit, FindsHowAPlaneLeans) {
  Bench bench(STACK, {PLUGIN});
  touchPlane(bench, 0.3, 200, 0);
  EXPECT_EQ(port(bench, "known"), 1);
  EXPECT_NEAR(port(bench, "tilt"), 0.3, 1e-9);
  EXPECT_LT(port(bench, "rms"), 1e-9);
}

// Uniform noise of ±1 mm has a standard deviation of 1/√3 mm.
TEST(PlaneFit, NoiseShowsInTheRms) {
  Bench bench(STACK, {PLUGIN});
  touchPlane(bench, 0.3, 1000, 0.001);
  EXPECT_NEAR(port(bench, "tilt"), 0.3, 1e-3);
  EXPECT_NEAR(port(bench, "rms"), 0.001 / std::sqrt(3), 5e-5);
}

TEST(PlaneFit, FewPointsAreNoPlane) {
  Bench bench(STACK, {PLUGIN});
  touchPlane(bench, 0.3, 5, 0);
  EXPECT_EQ(port(bench, "known"), 0);
}

TEST(Plugin, KeepsTheLaws) {
  const auto report = tactus::conformance::checkPlugin(PLUGIN, STACK);
  EXPECT_TRUE(report.conforms()) << report.text();
}

}  // namespace
