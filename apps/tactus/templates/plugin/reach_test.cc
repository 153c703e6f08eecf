#include <gtest/gtest.h>

#include "conformance/bench.h"
#include "conformance/conformance.h"

namespace {

using tactus::conformance::Bench;

/// The stack's task 'reach', at a state that each test chooses.
class ReachTest : public ::testing::Test {
 protected:
  Eigen::Vector3d force() {
    bench.tick();
    return bench.rows("reach").F();
  }
  Eigen::Vector3d tip() const {
    return bench.robot().framePose(bench.robot().model().frameIndex("flange")).translation();
  }

  Bench bench{STACK, {PLUGIN}};
  const Eigen::Vector3d target{0.5, 0.1, 0.6};                     // as in the stack
};

TEST_F(ReachTest, AtRestItPullsStraightToTheTarget) {
  const Eigen::Vector3d pull = force();
  const Eigen::Vector3d away = target - tip();
  EXPECT_NEAR(pull.normalized().dot(away.normalized()), 1, 1e-12);
}

TEST_F(ReachTest, TheSpringIsBounded) {
  bench.sensed.q[0] = 3;                                           // the arm points away
  EXPECT_NEAR(force().norm(), 20, 1e-9);
  EXPECT_GT((target - tip()).norm() * 200, 20) << "too near to show it";
}

TEST_F(ReachTest, MotionIsBraked) {
  const Eigen::Vector3d at_rest = force();
  bench.sensed.qd.setConstant(0.3);
  const Eigen::Vector3d brake = force() - at_rest;
  const Eigen::Vector3d velocity = bench.rows("reach").J() * bench.sensed.qd;
  EXPECT_LT(brake.dot(velocity), 0);
}

TEST(Plugin, KeepsTheLawsOfEveryTask) {
  const auto report = tactus::conformance::checkPlugin(PLUGIN, STACK);
  EXPECT_TRUE(report.conforms()) << report.text();
}

}  // namespace
