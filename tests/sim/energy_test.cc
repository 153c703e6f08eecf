// Energy never grows.  A free body, integrated here as the plant does it (semi-explicit Euler), meets every shape: fixed,
// and free itself.  Kinetic, potential and elastic energy (springs and bristles) together may only fall; what they rise is
// the integrator's error, which is a stated part of the energy of a fall of 5 cm, and shrinks with the step.

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "framework/geometry/cone.h"
#include "framework/geometry/ellipsoid.h"
#include "framework/geometry/extrusion.h"
#include "framework/geometry/heights.h"
#include "framework/geometry/mesh.h"
#include "framework/geometry/revolution.h"
#include "framework/geometry/torus.h"
#include "sim/contact_force.h"
#include "tests/sim/bodies.h"

namespace tactus::sim {
namespace {

using Eigen::Vector3d;
using sim_tests::at;

struct Body {
  double mass;
  Vector3d inertia;                                                // about its axes
  BodyMotion motion;
};

class World {
 public:
  World(std::shared_ptr<const geometry::Shape> shape, bool is_free, const description::ContactMaterial& material,
        const geometry::Feeler& feeler)
      : contact_({{{-1, 1}, 0, feeler}}, {{{-1, 0}, is_free ? 1 : world_body, std::move(shape)}}, {{0, 0, material}}, 2) {}

  Body bodies[2] = {{0.1, {4e-5, 4e-5, 7e-6}, {}}, {0.5, {5e-4, 5e-4, 5e-4}, {}}};
  Vector3d gravity{0, 0, -9.81};                                   // of the first alone, so that a free partner floats

  void evaluate(double h) { contact_.evaluate({bodies[0].motion, bodies[1].motion}, h); }

  double energy() const {
    double sum = contact_.elasticEnergy() - bodies[0].mass * gravity.dot(bodies[0].motion.p_WB);
    for (const Body& body : bodies) {
      const Vector3d spin = body.motion.R_WB.transpose() * body.motion.angular_W;
      sum += 0.5 * body.mass * body.motion.linear_W.squaredNorm() + 0.5 * spin.dot(body.inertia.cwiseProduct(spin));
    }
    return sum;
  }

  void step(double h) {
    evaluate(h);
    contact_.commit();
    for (int i = 0; i < 2; ++i) {
      Body& body = bodies[i];
      BodyMotion& motion = body.motion;
      const BodyWrench& wrench = contact_.wrenches()[i];
      motion.linear_W += h * (wrench.force_W / body.mass + (i == 0 ? gravity : Vector3d::Zero().eval()));
      const Eigen::Matrix3d& R = motion.R_WB;
      const Vector3d momentum_W = R * body.inertia.asDiagonal() * R.transpose() * motion.angular_W + h * wrench.torque_W;
      motion.p_WB += h * motion.linear_W;
      // The momentum stays while the body turns by half a step, and by another half.
      for (int half = 0; half < 2; ++half) {
        motion.angular_W = R * body.inertia.cwiseInverse().asDiagonal() * R.transpose() * momentum_W;
        const double angle = 0.5 * h * motion.angular_W.norm();
        if (angle > 0)
          motion.R_WB = Eigen::Quaterniond(Eigen::AngleAxisd(angle, motion.angular_W.normalized()) *
                                           Eigen::Quaterniond(motion.R_WB)).normalized().matrix();
      }
      motion.angular_W = motion.R_WB * body.inertia.cwiseInverse().asDiagonal() * motion.R_WB.transpose() * momentum_W;
    }
  }

 private:
  ContactForce contact_;
};

struct Case {
  const char* name;
  std::shared_ptr<const geometry::Shape> shape;
  double height;                                                   // m, that of the pill's centre when it starts
  double spread;
};
std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

std::vector<Case> cases() {
  const std::vector<Eigen::Vector2d> cup{{0, 0}, {0.05, 0}, {0.05, 0.1}, {0.046, 0.1}, {0.046, 0.006}, {0, 0.006}};
  const std::vector<Eigen::Vector2d> angle{{-0.1, -0.1}, {0.1, -0.1}, {0.1, -0.05}, {0, -0.05}, {0, 0.1}, {-0.1, 0.1}};
  Eigen::MatrixXd heights(5, 5);
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j) heights(i, j) = 0.01 * std::sin(1.1 * i) * std::cos(0.9 * j);
  return {{"plane", std::make_shared<geometry::Plane>(), 0.04, 0.02},
          {"box", std::make_shared<geometry::Box>(Vector3d(0.1, 0.1, 0.04)), 0.06, 0.04},
          {"sphere", std::make_shared<geometry::Sphere>(0.05), 0.09, 0.02},
          {"cylinder", std::make_shared<geometry::Cylinder>(0.06, 0.1), 0.09, 0.05},
          {"capsule", std::make_shared<geometry::Capsule>(0.03, 0.05), 0.095, 0.02},
          {"cone", std::make_shared<geometry::Cone>(0.06, 0.03, 0.1), 0.09, 0.03},
          {"ellipsoid", std::make_shared<geometry::Ellipsoid>(Vector3d(0.2, 0.1, 0.03)), 0.07, 0.03},
          {"ring", std::make_shared<geometry::Torus>(0.03, 0.012, 2 * std::numbers::pi), 0.05, 0.02},
          {"heights", std::make_shared<geometry::Mesh>(geometry::heightMesh(heights, {0.03, 0.03}, -0.03), 2e-3), 0.05, 0.02},
          {"angle", std::make_shared<geometry::Extrusion>(angle, 0.05), 0.06, 0.08},
          {"cup", std::make_shared<geometry::Revolution>(cup), 0.13, 0.05}};
}

class Energy : public ::testing::TestWithParam<Case> {
 protected:
  struct Rise {
    double mean = 0, greatest = 0;                                 // J, of the energy above its lowest so far
  };
  /// A pill falls, slides and spins; the same starts for every step.
  Rise run(double h, bool is_free, const description::ContactMaterial& material) {
    constexpr int trials = 12;
    constexpr double duration = 0.4;
    std::mt19937_64 random(3);
    const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
    const auto inCube = [&](double half) { return Vector3d(uniform(-half, half), uniform(-half, half), uniform(-half, half)); };
    Rise rise;
    for (int trial = 0; trial < trials; ++trial) {
      World world(GetParam().shape, is_free, material, {{-0.025, 0, 0}, {0.025, 0, 0}, 0.012});
      world.bodies[0].inertia = {7e-6, 4e-5, 4e-5};
      BodyMotion& pill = world.bodies[0].motion;
      pill.p_WB = {uniform(-1, 1) * GetParam().spread, uniform(-1, 1) * GetParam().spread, GetParam().height};
      pill.R_WB = (Eigen::AngleAxisd(uniform(-3, 3), Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(uniform(-0.8, 0.8), Vector3d::UnitY())).toRotationMatrix();
      pill.linear_W = inCube(0.3);
      pill.angular_W = inCube(5);
      world.evaluate(h);
      double lowest = world.energy(), greatest = 0;
      for (int i = 0; i * h < duration; ++i) {
        world.step(h);
        world.evaluate(h);
        const double now = world.energy();
        lowest = std::min(lowest, now);
        greatest = std::max(greatest, now - lowest);
      }
      rise.mean += greatest / trials;
      rise.greatest = std::max(rise.greatest, greatest);
    }
    return rise;
  }
};

constexpr double step = 0.25e-3, fall = 0.1 * 9.81 * 0.05;         // s; J

/// Elastic and smooth, so that no loss hides a gain: the error is that of the integrator, in proportion to its step.
TEST_P(Energy, IsKeptByElasticContact) {
  const description::ContactMaterial elastic{2000, 0, 0, 0};
  for (const bool is_free : {false, true}) {
    if (is_free && std::isinf(GetParam().shape->boundingRadius())) continue;
    SCOPED_TRACE(is_free ? "free" : "fixed");
    const Rise coarse = run(step, is_free, elastic), fine = run(step / 4, is_free, elastic);
    EXPECT_LT(coarse.greatest, 0.15 * fall);
    EXPECT_LT(fine.mean, 0.28 * coarse.mean);
    EXPECT_LT(fine.greatest, 0.3 * coarse.greatest);
  }
}

TEST_P(Energy, NeverGrows) {
  const description::ContactMaterial rough{2000, 2, 0.5, 2e-4};
  for (const bool is_free : {false, true}) {
    if (is_free && std::isinf(GetParam().shape->boundingRadius())) continue;
    SCOPED_TRACE(is_free ? "free" : "fixed");
    const Rise coarse = run(step, is_free, rough), fine = run(step / 4, is_free, rough);
    EXPECT_LT(coarse.greatest, 6e-3 * fall);
    EXPECT_LT(fine.mean, 0.25 * coarse.mean);
  }
}

/// Without weight: what the pill loses its partner gets, about any point.
TEST_P(Energy, AndMomentumPassesFromOneToTheOther) {
  if (std::isinf(GetParam().shape->boundingRadius())) return;
  World world(GetParam().shape, true, {2000, 2, 0.5, 2e-4}, {{-0.025, 0, 0}, {0.025, 0, 0}, 0.012});
  world.gravity.setZero();
  world.bodies[0].motion.p_WB = {0.3 * GetParam().spread, 0.01, GetParam().height};
  world.bodies[0].motion.linear_W = {0.1, 0.05, -1};
  world.bodies[0].motion.angular_W = {3, -2, 5};
  const auto momentum = [&] {
    Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
    for (const Body& body : world.bodies) {
      const Eigen::Matrix3d& R = body.motion.R_WB;
      sum.head<3>() += body.mass * body.motion.linear_W;
      sum.tail<3>() += R * body.inertia.asDiagonal() * R.transpose() * body.motion.angular_W +
                       body.motion.p_WB.cross(body.mass * body.motion.linear_W);
    }
    return sum;
  };
  const Eigen::Matrix<double, 6, 1> before = momentum();
  for (int i = 0; i < 1000; ++i) world.step(step);
  EXPECT_GT(world.bodies[1].motion.linear_W.norm(), 0.01) << "they met";
  EXPECT_LT((momentum() - before).head<3>().norm(), 1e-12);
  EXPECT_LT((momentum() - before).tail<3>().norm(), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(On, Energy, ::testing::ValuesIn(cases()),
                         [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace tactus::sim
