// A pill dropped on every shape: it comes to rest or falls clear, and a second after the first touch nothing chatters.
//
// Chatter is motion that goes back and forth.  Velocities over a tenth of a second, a sample a millisecond, are split into
// a cubic in time (rolling, sliding, slow rocking, falling) and the rest, which holds whatever goes back and forth in less
// than about 50 ms; of it the largest speed of any point of the pill counts.

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <numbers>
#include <random>

#include "framework/geometry/cone.h"
#include "framework/geometry/ellipsoid.h"
#include "framework/geometry/extrusion.h"
#include "framework/geometry/heights.h"
#include "framework/geometry/mesh.h"
#include "framework/geometry/revolution.h"
#include "framework/geometry/torus.h"
#include "sim/simbody_plant.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using Eigen::Vector3d;
using sim_tests::at;

constexpr double pill_radius = 0.012, pill_length = 0.05;
constexpr double reach = pill_radius + pill_length / 2;
constexpr double still = 1e-3;                                     // m/s
const Eigen::VectorXd nothing;

struct Floor {
  const char* name;
  std::vector<description::Primitive> shapes;
  double height;                                                   // m, of the lowest drop
  double spread;                                                   // m, places around the middle
};
std::ostream& operator<<(std::ostream& out, const Floor& floor) { return out << floor.name; }

std::shared_ptr<const geometry::Shape> wavyHeights() {
  Eigen::MatrixXd heights(9, 9);
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) heights(i, j) = 0.01 * std::sin(1.1 * i) * std::cos(0.9 * j);
  return std::make_shared<geometry::Mesh>(geometry::heightMesh(heights, {0.025, 0.025}, -0.03), 2e-3);
}

/// A pyramid, 8 cm high.
std::shared_ptr<const geometry::Shape> pyramid() {
  geometry::TriangleMesh mesh;
  mesh.vertices = {{-0.1, -0.1, -0.02}, {0.1, -0.1, -0.02}, {0.1, 0.1, -0.02}, {-0.1, 0.1, -0.02}, {0, 0, 0.02}};
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  return std::make_shared<geometry::Mesh>(mesh, 3e-3);
}

std::vector<Floor> floors() {
  const std::vector<Eigen::Vector2d> cup{{0, 0}, {0.05, 0}, {0.05, 0.1}, {0.046, 0.1}, {0.046, 0.006}, {0, 0.006}};
  const std::vector<Eigen::Vector2d> angle{{-0.1, -0.1}, {0.1, -0.1}, {0.1, -0.05}, {0, -0.05}, {0, 0.1}, {-0.1, 0.1}};
  const auto alone = [](std::shared_ptr<const geometry::Shape> shape) {
    return std::vector<description::Primitive>{{std::move(shape), Eigen::Isometry3d::Identity()}};
  };
  const Eigen::AngleAxisd lying(0.5 * std::numbers::pi, Vector3d::UnitY());
  const auto log = std::make_shared<geometry::Cylinder>(0.03, 0.3);
  return {{"plane", alone(std::make_shared<geometry::Plane>()), 0.05, 0.05},
          {"box", alone(std::make_shared<geometry::Box>(Vector3d(0.2, 0.2, 0.04))), 0.07, 0.05},
          {"sphere", alone(std::make_shared<geometry::Sphere>(0.05)), 0.1, 0.02},
          {"cylinder", alone(std::make_shared<geometry::Cylinder>(0.06, 0.1)), 0.1, 0.05},
          {"capsule", {{std::make_shared<geometry::Capsule>(0.03, 0.2), at(0, 0, 0) * lying}}, 0.08, 0.02},
          {"cone", alone(std::make_shared<geometry::Cone>(0.06, 0.03, 0.1)), 0.1, 0.02},
          {"ellipsoid", alone(std::make_shared<geometry::Ellipsoid>(Vector3d(0.2, 0.1, 0.03))), 0.07, 0.02},
          {"ring", alone(std::make_shared<geometry::Torus>(0.03, 0.012, 2 * std::numbers::pi)), 0.05, 0.01},
          {"heights", alone(wavyHeights()), 0.06, 0.04},
          {"angle", alone(std::make_shared<geometry::Extrusion>(angle, 0.05)), 0.07, 0.08},
          {"lying_angle", {{std::make_shared<geometry::Extrusion>(angle, 0.2),
                            at(0, 0, 0) * Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX())}}, 0.15, 0.05},
          {"cup_and_its_rim", alone(std::make_shared<geometry::Revolution>(cup)), 0.13, 0.05},
          {"groove", {{log, at(0, -0.035, 0) * lying}, {log, at(0, 0.035, 0) * lying}}, 0.06, 0.01},
          {"mesh", alone(pyramid()), 0.07, 0.03}};
}

/// What is left of samples a millisecond apart when a cubic is taken off.
Eigen::MatrixXd withoutCubic(const Eigen::MatrixXd& samples) {
  const Eigen::VectorXd s = Eigen::VectorXd::LinSpaced(samples.rows(), -1, 1);
  Eigen::MatrixXd basis(samples.rows(), 4);
  basis << Eigen::VectorXd::Ones(s.size()), s, s.cwiseAbs2(), s.cwiseAbs2().cwiseProduct(s);
  return samples - basis * basis.householderQr().solve(samples);
}

double fastest(const Eigen::MatrixXd& velocities) {                // rows: linear, angular
  return (velocities.leftCols<3>().rowwise().norm() + reach * velocities.rightCols<3>().rowwise().norm()).maxCoeff();
}

class Dropped : public ::testing::TestWithParam<Floor> {
 protected:
  static Eigen::MatrixXd velocities(SimbodyPlant& plant) {
    Eigen::MatrixXd samples(100, 6);
    for (int i = 0; i < 100; ++i) {
      plant.advance(nothing, 1e-3);
      samples.row(i) << plant.objects()[1].linear_W.transpose(), plant.objects()[1].angular_W.transpose();
    }
    return samples;
  }
};

TEST_P(Dropped, SettlesOrFallsClear) {
  std::mt19937_64 random(11);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const Floor& floor = GetParam();
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE("drop " + std::to_string(trial));
    description::Object below, pill;
    below.name = "floor";
    below.primitives = floor.shapes;
    pill = sim_tests::object("pill", at(uniform(-floor.spread, floor.spread), uniform(-floor.spread, floor.spread),
                                        floor.height + uniform(0, 0.03)),
                             std::make_shared<geometry::Capsule>(pill_radius, pill_length));
    pill.pose.rotate(Eigen::AngleAxisd(uniform(-3, 3), Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(std::numbers::pi / 2 + uniform(-0.8, 0.8), Vector3d::UnitY()));
    pill.mobility = description::Mobility::free;
    pill.mass = {0.1, Vector3d::Zero(), Vector3d(4e-5, 4e-5, 7e-6).asDiagonal()};
    description::Scene drop;
    drop.objects = {below, pill};
    for (description::Object& object : drop.objects) object.material = {4000, 2, 0.5, 2e-4};
    SimbodyPlant plant(sim_tests::world(), drop, nothing);

    const auto pose = [&]() -> const Eigen::Isometry3d& { return plant.objects()[1].pose; };
    double time = 0;
    while (std::abs(plant.objects()[1].linear_W.z() + 9.81 * time) < 1e-6) {
      plant.advance(nothing, 1e-3);
      time += 1e-3;
    }
    plant.advance(nothing, 1);
    const Eigen::MatrixXd then = velocities(plant);
    if (getenv("TALK")) printf("%s %d chatter %.3g speed %.3g z %.3f |", floor.name, trial, fastest(withoutCubic(then)), fastest(then), pose().translation().z());
    EXPECT_LT(fastest(withoutCubic(then)), still) << "m/s, at " << pose().translation().transpose();
    double speed = fastest(then);
    for (time = 1; time < 8 && speed > still && pose().translation().z() > -0.3; time += 0.1)
      speed = fastest(velocities(plant));
    if (getenv("TALK")) printf(" rest %.3g at %.1f s z %.3f\n", speed, time, pose().translation().z());
    if (pose().translation().z() > -0.3) {
      EXPECT_LT(speed, still) << "m/s, at " << pose().translation().transpose();
    }
  }
}

INSTANTIATE_TEST_SUITE_P(On, Dropped, ::testing::ValuesIn(floors()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace tactus::sim
