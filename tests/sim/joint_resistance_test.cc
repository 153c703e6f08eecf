#include "sim/joint_resistance.h"

#include <gtest/gtest.h>

#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

constexpr double h = 0.25e-3;
constexpr double inertia = 1e-4;

class OneJoint : public ::testing::Test {
 protected:
  OneJoint() : robot_(sim_tests::world()) {
    joint_ = &sim_tests::addJoint(robot_, "hinge", description::JointType::revolute, Eigen::Vector3d::UnitZ());
  }
  JointResistance resistance() const { return {robot_, Eigen::VectorXd::Constant(1, inertia), h}; }
  static double torque(JointResistance& resistance, double q, double qd) {
    Eigen::VectorXd torque = Eigen::VectorXd::Zero(1);
    resistance.add(Eigen::VectorXd::Constant(1, q), Eigen::VectorXd::Constant(1, qd), torque);
    return torque[0];
  }
  description::Robot robot_;
  description::Joint* joint_;
};

TEST_F(OneJoint, DampingIsViscous) {
  joint_->damping = 0.004;
  JointResistance resistance = this->resistance();
  EXPECT_DOUBLE_EQ(torque(resistance, 0.3, 2), -0.008);
  EXPECT_DOUBLE_EQ(torque(resistance, 0.3, -2), 0.008);
}

TEST_F(OneJoint, StopPushesInwardsOnlyPastTheLimit) {
  joint_->lower = -0.5;
  joint_->upper = 1;
  JointResistance resistance = this->resistance();
  EXPECT_EQ(torque(resistance, 0.999, 5), 0);
  EXPECT_LT(torque(resistance, 1.001, 0), 0);
  EXPECT_GT(torque(resistance, -0.501, 0), 0);
  EXPECT_LT(torque(resistance, 1.001, 1), torque(resistance, 1.001, 0)) << "damps the way outwards";
  EXPECT_EQ(torque(resistance, 1.0001, -100), 0) << "does not hold back what returns";
  EXPECT_NEAR(torque(resistance, 1.001, 0), -0.05 * inertia / (h * h) * 0.001, 1e-12);
}

TEST_F(OneJoint, CoulombFrictionSticksThenSlides) {
  joint_->friction = 0.02;
  JointResistance resistance = this->resistance();
  double last = 0;
  for (int i = 0; i < 2000; ++i) {
    last = torque(resistance, 0, 0.5);
    resistance.commit();
  }
  EXPECT_DOUBLE_EQ(last, -0.02) << "slides at the limit";
  EXPECT_NEAR(torque(resistance, 0, 0), -0.02, 1e-15) << "and stays bent at rest";
  resistance.commit();
  for (int i = 0; i < 2000; ++i) {
    last = torque(resistance, 0, -0.5);
    resistance.commit();
  }
  EXPECT_DOUBLE_EQ(last, 0.02);
}

}  // namespace
}  // namespace tactus::sim
