// What pairs of the scene say goes before the usual rule: of two objects, of a link and an object, and in their order.

#include <gtest/gtest.h>

#include "sim/simbody_plant.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using Eigen::Vector3d;
using sim_tests::at;

constexpr double g = 9.81;
const Eigen::VectorXd nothing;

/// A ball of 0.1 kg on the ground, both 2000 N/m.
description::Scene ballOnTheGround() {
  description::Scene scene;
  scene.objects.push_back(sim_tests::object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>()));
  scene.objects.push_back(sim_tests::object("ball", at(0, 0, 0.02), std::make_shared<geometry::Sphere>(0.02)));
  scene.objects[1].mobility = description::Mobility::free;
  scene.objects[1].mass = {0.1, Vector3d::Zero(), Vector3d::Constant(0.4 * 0.1 * 4e-4).asDiagonal()};
  return scene;
}

double depthOf(const description::Scene& scene) {
  SimbodyPlant plant(sim_tests::world(), scene, nothing);
  plant.advance(nothing, 2);
  return 0.02 - plant.objects()[1].pose.translation().z();
}

TEST(Pairs, StiffnessIsThatOfBothSurfacesTogether) {
  description::Scene scene = ballOnTheGround();
  EXPECT_NEAR(depthOf(scene), 0.1 * g / 1000, 1e-7);
  scene.pairs.push_back({{.object = 1}, {.object = 0}, 500.0});
  EXPECT_NEAR(depthOf(scene), 0.1 * g / 500, 1e-7) << "in whichever order the two are named";
}

TEST(Pairs, OfOthersChangeNothing) {
  description::Scene scene = ballOnTheGround();
  scene.pairs.push_back({{.object = 1}, {.link = 0}, 500.0});
  scene.pairs.push_back({{.object = 1}, {}, 400.0});
  EXPECT_NEAR(depthOf(scene), 0.1 * g / 1000, 1e-7);
}

TEST(Pairs, FrictionDecidesWhatSlides) {
  description::Scene scene = ballOnTheGround();
  scene.objects[1] =
      sim_tests::object("brick", at(0, 0, 0.02), std::make_shared<geometry::Box>(Vector3d(0.06, 0.1, 0.04)));
  scene.objects[1].mobility = description::Mobility::free;
  scene.objects[1].mass = {0.3, Vector3d::Zero(), Vector3d(2.9e-4, 1.3e-4, 3.4e-4).asDiagonal()};
  const double tilt = 0.25;                                        // tan 0.255: above 0.2, which both have
  scene.gravity = g * Vector3d(0, std::sin(tilt), -std::cos(tilt));
  const auto speed = [&] {
    SimbodyPlant plant(sim_tests::world(), scene, nothing);
    plant.advance(nothing, 1);
    return plant.objects()[1].linear_W.y();
  };
  EXPECT_NEAR(speed(), g * (std::sin(tilt) - 0.2 * std::cos(tilt)), 0.02);
  scene.pairs.push_back({{.object = 0}, {.object = 1}, {}, {}, 0.4});
  EXPECT_LT(std::abs(speed()), 1e-3);
}

/// A link of 0.1 kg that slides freely comes to rest on the ground.
TEST(Pairs, ALinkIsNamedMoreCloselyThanTheRobot) {
  description::Scene scene;
  scene.objects.push_back(sim_tests::object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>()));
  const description::Robot body = sim_tests::slidingBody(sim_tests::sphere(0.02));
  const int link = static_cast<int>(body.links.size()) - 1;
  const auto depth = [&] {
    SimbodyPlant plant(body, scene, Vector3d(0, 0, 0.02));
    plant.advance(Vector3d::Zero(), 2);
    return 0.02 - plant.sense().q[2];
  };
  const double weight = g * sim_tests::mass;
  EXPECT_NEAR(depth(), weight / 2000, 1e-6);
  scene.pairs.push_back({{}, {.object = 0}, 1000.0});
  EXPECT_NEAR(depth(), weight / 1000, 1e-6);
  scene.pairs.push_back({{.object = 0}, {.link = link}, 4000.0});
  EXPECT_NEAR(depth(), weight / 4000, 1e-6) << "the later one";
  scene.pairs.push_back({{.object = 0}, {.link = link}, {}, 0.5});
  EXPECT_NEAR(depth(), weight / 4000, 1e-6) << "what it does not say stays";
}

}  // namespace
}  // namespace tactus::sim
