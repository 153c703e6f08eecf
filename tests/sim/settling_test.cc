// Bodies dropped on every shape come to rest, with the weight they have.  Round shapes carry a body only in pairs or
// nests, so those scenes are made of several of them.  Each drop starts from another height, place and attitude.

#include <gtest/gtest.h>

#include <numbers>
#include <ostream>
#include <random>

#include "sim/simbody_plant.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using sim_tests::at;
using sim_tests::object;

constexpr double weight_N = 9.81 * (sim_tests::mass + 5 * sim_tests::carrier_mass);

struct Drop {
  const char* name;
  description::Scene scene;
  double height;                                                   // m, of the body's centre at the lowest start
  double seconds;                                                  // until rest is expected
  double spread;                                                   // m, places around the middle
  double tilt;                                                     // rad, largest pitch
  double turn;                                                     // rad, largest yaw
  double length = 0.05;                                            // m, straight part of the capsule
};
std::ostream& operator<<(std::ostream& out, const Drop& drop) { return out << drop.name; }

Eigen::Isometry3d lying(double x, double y, double z) {            // axis along x
  return at(x, y, z) * Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY());
}

description::Scene scene(std::vector<description::Object> objects) {
  description::Scene made;
  made.objects = std::move(objects);
  return made;
}

std::vector<Drop> drops() {
  const auto wall = std::make_shared<geometry::Box>(Eigen::Vector3d(0.002, 0.2, 0.04));
  const auto log = std::make_shared<geometry::Cylinder>(0.03, 0.3);
  const auto pill = std::make_shared<geometry::Capsule>(0.03, 0.3);
  const auto ball = std::make_shared<geometry::Sphere>(0.03);
  description::Object nest = object("nest", at(0, 0, 0), ball);
  nest.primitives.clear();
  for (double x : {-0.025, 0.025})
    for (double y : {-0.02, 0.02}) nest.primitives.push_back({ball, at(x, y, 0)});
  return {
      {"plane", scene({object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>())}),
       0.05, 2, 0.1, 0.8, 3},
      {"box", scene({object("table", at(0, 0, -0.01), std::make_shared<geometry::Box>(Eigen::Vector3d(0.4, 0.4, 0.02)))}),
       0.05, 2, 0.05, 0.8, 3},
      // Across the walls a body rolls on for ever (there is no rolling resistance), so it falls straight.
      {"two_sharp_walls", scene({object("left", at(-0.03, 0, -0.02), wall), object("right", at(0.03, 0, -0.02), wall)}),
       0.02, 2, 0.003, 0.15, 0, 0.1},
      {"cylinder_groove", scene({object("a", lying(0, -0.035, 0), log), object("b", lying(0, 0.035, 0), log)}),
       0.05, 2, 0.003, 0.3, 0.1},
      {"capsule_groove", scene({object("a", lying(0, -0.035, 0), pill), object("b", lying(0, 0.035, 0), pill)}),
       0.05, 2, 0.003, 0.3, 0.1},
      // Flat nest: the body rocks for a while.
      {"sphere_nest", scene({nest}),
       0.042, 4, 0.003, 0.1, 0.1},
  };
}

class Settling : public ::testing::TestWithParam<Drop> {
 protected:
  /// Drops a body 20 times and expects rest.
  void dropAll(const description::Robot& robot) {
    std::mt19937_64 random(11);
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    const Drop& drop = GetParam();
    for (int trial = 0; trial < 20; ++trial) {
      SCOPED_TRACE("drop " + std::to_string(trial));
      Eigen::VectorXd q(6);
      q << uniform(-drop.spread, drop.spread), uniform(-drop.spread, drop.spread), drop.height + uniform(0, 0.03),
          uniform(-drop.turn, drop.turn), uniform(-drop.tilt, drop.tilt), uniform(-3, 3);
      SimbodyPlant plant(robot, drop.scene, q);
      plant.advance(Eigen::VectorXd::Zero(6), drop.seconds);
      double fastest = 0;                                          // over a tenth of a second: chatter shows
      Eigen::Vector3d mean_force_W = Eigen::Vector3d::Zero();
      for (int i = 0; i < 100; ++i) {
        plant.advance(Eigen::VectorXd::Zero(6), 1e-3);
        const control::Sensed& sensed = plant.sense();
        // The body reaches at most 3 cm from its centre.
        fastest = std::max(fastest, sensed.qd.head<3>().norm() + 0.03 * sensed.qd.tail<3>().norm());
        for (const control::ContactRecord& record : sensed.contacts)
          mean_force_W += 0.01 * (record.force_N * record.normal_W + record.friction_W);
      }
      EXPECT_LT(fastest, 1e-3) << "m/s, at q = " << plant.sense().q.transpose();
      EXPECT_NEAR(mean_force_W.z(), -weight_N, 2e-3 * weight_N) << "its weight rests on the object";
      EXPECT_LT(mean_force_W.head<2>().norm(), 2e-3 * weight_N);
    }
  }
};

TEST_P(Settling, Capsule) { dropAll(sim_tests::freeBody(sim_tests::capsule(0.012, GetParam().length))); }

INSTANTIATE_TEST_SUITE_P(On, Settling, ::testing::ValuesIn(drops()),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(SettlingSphere, OnEveryShape) {
  for (const Drop& drop : drops()) {
    if (std::string(drop.name) == "two_sharp_walls") continue;     // it falls between them
    SCOPED_TRACE(drop.name);
    SimbodyPlant plant(sim_tests::slidingBody(sim_tests::sphere(0.02)), drop.scene,
                       Eigen::Vector3d(0.001, 0.001, drop.height + 0.03));
    plant.advance(Eigen::VectorXd::Zero(3), 2);
    EXPECT_LT(plant.sense().qd.norm(), 1e-3);
    double lift_N = 0;
    for (const control::ContactRecord& record : plant.sense().contacts)
      lift_N -= record.force_N * record.normal_W.z() + record.friction_W.z();
    EXPECT_NEAR(lift_N, 9.81 * (sim_tests::mass + 2 * sim_tests::carrier_mass), 2e-3);
  }
}

}  // namespace
}  // namespace tactus::sim
