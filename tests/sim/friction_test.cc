// Coulomb's law on a slope, as gravity that leans by the angle: a block that cannot turn, and a free capsule.

#include <gtest/gtest.h>

#include <cmath>

#include "sim/simbody_plant.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

description::Scene slope(double angle, double friction, std::shared_ptr<const geometry::Shape> shape,
                         const Eigen::Isometry3d& pose) {
  description::Scene scene;
  scene.objects = {sim_tests::object("slope", pose, shape)};
  scene.objects[0].material.friction = friction;
  scene.gravity = 9.81 * Eigen::Vector3d(std::sin(angle), 0, -std::cos(angle));
  return scene;
}

class Slope : public ::testing::TestWithParam<double> {
 protected:
  double friction() const { return GetParam(); }
  description::Scene at(double angle) const {
    return slope(angle, friction(), std::make_shared<geometry::Box>(Eigen::Vector3d(4, 4, 0.1)), sim_tests::at(0, 0, -0.05));
  }
  /// Distance slid along the slope from `from` to `to` seconds after being put down.
  static double slide(SimbodyPlant& plant, double from, double to) {
    const Eigen::VectorXd torque = Eigen::VectorXd::Zero(plant.sense().q.size());
    plant.advance(torque, from);
    const double start = plant.sense().q[0];
    plant.advance(torque, to - from);
    return plant.sense().q[0] - start;
  }
};

TEST_P(Slope, BlockSticksBelowAtanMuWithoutCreep) {
  for (double share : {0.5, 0.9, 0.97}) {
    SimbodyPlant plant(sim_tests::slidingBody(sim_tests::sphere(0.02)), at(std::atan(share * friction())),
                       Eigen::Vector3d(0, 0, 0.0199));
    EXPECT_LT(std::abs(slide(plant, 1, 2)), 0.05e-3) << "m in a second, at " << share << " of μ";
  }
}

TEST_P(Slope, BlockSlidesAboveAtanMuAsCoulombSays) {
  for (double share : {1.1, 1.5}) {
    const double angle = std::atan(share * friction());
    SimbodyPlant plant(sim_tests::slidingBody(sim_tests::sphere(0.02)), at(angle), Eigen::Vector3d(0, 0, 0.0199));
    const Eigen::VectorXd torque = Eigen::VectorXd::Zero(3);
    plant.advance(torque, 0.3);
    const double early = plant.sense().qd[0];
    plant.advance(torque, 0.3);
    const double acceleration = (plant.sense().qd[0] - early) / 0.3;
    EXPECT_NEAR(acceleration, 9.81 * (std::sin(angle) - friction() * std::cos(angle)), 0.01 * 9.81 * std::sin(angle));
  }
}

TEST_P(Slope, CapsuleAlongTheSlopeSticksBelowAtanMu) {
  Eigen::VectorXd start(6);
  start << 0, 0, 0.0119, 0, 0, 0;
  SimbodyPlant plant(sim_tests::freeBody(sim_tests::capsule(0.012, 0.05)), at(std::atan(0.8 * friction())), start);
  EXPECT_LT(std::abs(slide(plant, 1, 2)), 0.05e-3);
}

TEST_P(Slope, FrictionStaysInTheCone) {
  SimbodyPlant plant(sim_tests::slidingBody(sim_tests::sphere(0.02)), at(0.3), Eigen::Vector3d(0, 0, 0.03));
  const Eigen::VectorXd torque = Eigen::VectorXd::Zero(3);
  int touches = 0;
  for (int i = 0; i < 500; ++i) {
    plant.advance(torque, 1e-3);
    for (const control::ContactRecord& record : plant.sense().contacts) {
      EXPECT_LE(record.friction_W.norm(), friction() * record.force_N + 1e-12);
      ++touches;
    }
  }
  EXPECT_GT(touches, 100);
}

INSTANTIATE_TEST_SUITE_P(Mu, Slope, ::testing::Values(0.2, 0.5, 1.0));

TEST(Friction, PushedSidewaysOnATableHoldsAndReleases) {
  // A steady push below μN moves the body only by the bend of a bristle.
  const description::Scene table = slope(0, 0.5, std::make_shared<geometry::Plane>(), Eigen::Isometry3d::Identity());
  SimbodyPlant plant(sim_tests::slidingBody(sim_tests::sphere(0.02)), table, Eigen::Vector3d(0, 0, 0.0195));
  const double weight_N = 9.81 * sim_tests::mass;
  plant.advance(Eigen::Vector3d(0.4 * weight_N, 0, 0), 1);
  const double held = plant.sense().q[0];
  EXPECT_LT(held, 1e-3);
  plant.advance(Eigen::Vector3d(0.4 * weight_N, 0, 0), 1);
  EXPECT_NEAR(plant.sense().q[0], held, 0.01e-3);
  plant.advance(Eigen::Vector3d(0.6 * weight_N, 0, 0), 1);
  EXPECT_NEAR(plant.sense().q[0] - held, 0.5 * 0.1 * 9.81, 0.02);
}

}  // namespace
}  // namespace tactus::sim
