// The contact force against Simbody's own: its tracker finds where two surfaces touch, its compliant contact (Hertz, Hunt
// and Crossley, Coulomb) says how hard.  Pairs of balls that move, and balls on a half space, in random places.
//
// The laws differ in how force grows with depth: Hertz's x^1.5, here δ.  So the stiffness is chosen in each case such that
// the elastic forces are the same there; normal, depth, point, the force's loss with speed and its friction are then
// compared to 1e-6 or better, friction up to the lag of its bristle on a turning body.  Simbody's point lies in the middle of the overlap (equal materials), here on the surface felt.

#include <gtest/gtest.h>

#include <random>

#include "framework/geometry/primitives.h"
#include "sim/contact_force.h"
#include "tests/sim/simbody_contact.h"

namespace tactus::sim {
namespace {

using Eigen::Vector3d;

constexpr double modulus = 1e5, dissipation = 0.7, friction = 0.4; // Pa, s/m
constexpr double h = 1e-5;                                         // s

struct Ball {
  double radius;
  BodyMotion motion;
};

struct Touch {
  double depth;
  Vector3d point_W, normal_W;                                      // from the first body into the second
  Vector3d force_W;                                                // on the second
};

sim_tests::Triple triple(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Vector3d vector(const sim_tests::Triple& v) { return {v[0], v[1], v[2]}; }

Touch bySimbody(const Ball& first, const Ball* second) {
  const auto moving = [](const Ball& ball) -> sim_tests::MovingBall {
    return {ball.radius, triple(ball.motion.p_WB), triple(ball.motion.linear_W), triple(ball.motion.angular_W)};
  };
  const sim_tests::MovingBall one = moving(first), other = moving(second ? *second : first);
  const auto found = sim_tests::simbodyContact(one, second ? &other : nullptr, {modulus, dissipation, friction});
  EXPECT_EQ(found.count, 1);
  return {found.depth, vector(found.point_W), vector(found.normal_W), vector(found.force_W)};
}

/// What the contact force finds, with a stiffness such that the elastic force is the given one.
Touch byTactus(const Ball& first, const Ball* second, double depth, double elastic_N) {
  std::shared_ptr<const geometry::Shape> shape = std::make_shared<geometry::Plane>();
  if (second) shape = std::make_shared<geometry::Sphere>(second->radius);
  const description::ContactMaterial material{elastic_N / depth, 1.5 * dissipation, friction, 0};
  ContactForce contact({{{0, -1}, 0, {Vector3d::Zero(), Vector3d::Zero(), first.radius}}},
                       {{{-1, 0}, second ? 1 : world_body, shape}}, {{0, 0, material}}, 2);
  const std::vector<BodyMotion> motions{first.motion, second ? second->motion : BodyMotion()};
  for (int i = 0; i < 2000; ++i) {                                 // it slides: the bristle is bent to the end
    contact.evaluate(motions, h);
    contact.commit();
  }
  contact.evaluate(motions, h);
  std::vector<control::ContactRecord> records;
  contact.read(records);
  EXPECT_EQ(records.size(), 1u);
  const control::ContactRecord& record = records.front();
  const Vector3d force_W = record.force_N * record.normal_W + record.friction_W;
  EXPECT_LT((contact.wrenches()[0].force_W + force_W).norm(), 1e-12);
  return {record.depth, record.point_W, record.normal_W, force_W};
}

class ContactAgainstSimbody : public ::testing::Test {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Vector3d inCube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }

  void compare(const Ball& first, const Ball* second) {
    const Touch theirs = bySimbody(first, second);
    const double R = second ? first.radius * second->radius / (first.radius + second->radius) : first.radius;
    // Two layers of this modulus in series, each x/2 deep.
    const double hertz_N = 4.0 / 3 * modulus * std::sqrt(R) * std::pow(theirs.depth / 2, 1.5);
    const Touch ours = byTactus(first, second, theirs.depth, hertz_N);
    EXPECT_NEAR(ours.depth, theirs.depth, 1e-13);
    EXPECT_LT((ours.normal_W - theirs.normal_W).norm(), 1e-11);
    // The surface felt is reached half an overlap towards the feeling ball.
    EXPECT_LT((ours.point_W + 0.5 * theirs.depth * ours.normal_W - theirs.point_W).norm(), 1e-11);
    const double normal_N = theirs.force_W.dot(theirs.normal_W);
    EXPECT_NEAR(ours.force_W.dot(ours.normal_W), normal_N, 1e-9 * hertz_N);
    // The slip is that of either point, and they turn against each other about half an overlap.
    const BodyMotion at_rest, &other = second ? second->motion : at_rest;
    const auto slipOf = [&](const Vector3d& p_W) -> Vector3d {
      const Vector3d v = first.motion.linear_W + first.motion.angular_W.cross(p_W - first.motion.p_WB) - other.linear_W -
                         other.angular_W.cross(p_W - other.p_WB);
      return v - v.dot(theirs.normal_W) * theirs.normal_W;
    };
    const Vector3d apart = slipOf(ours.point_W).normalized() - slipOf(theirs.point_W).normalized();
    // A bristle of length μδ (1 + …) that turns with the second body follows the slip with a lag of ω μδ/slip.
    const double bend = friction * theirs.depth * normal_N / hertz_N;
    const double lag = other.angular_W.norm() * bend / slipOf(ours.point_W).norm();
    EXPECT_LT((ours.force_W - theirs.force_W - friction * normal_N * apart).norm(),
              1e-6 * hertz_N + 1.5 * lag * friction * normal_N);
    EXPECT_LT(lag, 0.1);
    EXPECT_LT(apart.norm(), 0.1) << "the points are the same to half an overlap";
    heaviest_N_ = std::max(heaviest_N_, theirs.force_W.norm());
  }

  std::mt19937_64 random_{17};
  double heaviest_N_ = 0;
};

TEST_F(ContactAgainstSimbody, PairsOfBalls) {
  for (int trial = 0; trial < 100; ++trial) {
    Ball first{uniform(0.01, 0.05), {}}, second{uniform(0.01, 0.05), {}};
    first.motion.p_WB = inCube(0.5);
    const double depth = uniform(1e-5, 2e-3);
    second.motion.p_WB = first.motion.p_WB + (first.radius + second.radius - depth) * inCube(1).normalized();
    for (Ball* ball : {&first, &second}) {
      ball->motion.linear_W = inCube(0.4);
      ball->motion.angular_W = inCube(3);
    }
    SCOPED_TRACE(trial);
    compare(first, &second);
  }
  EXPECT_GT(heaviest_N_, 0.1);
}

TEST_F(ContactAgainstSimbody, BallsOnAHalfSpace) {
  for (int trial = 0; trial < 100; ++trial) {
    Ball ball{uniform(0.01, 0.05), {}};
    ball.motion.p_WB = inCube(0.5);
    ball.motion.p_WB.z() = ball.radius - uniform(1e-5, 2e-3);
    ball.motion.linear_W = inCube(0.4);
    ball.motion.angular_W = inCube(3);
    SCOPED_TRACE(trial);
    compare(ball, nullptr);
  }
  EXPECT_GT(heaviest_N_, 0.1);
}

}  // namespace
}  // namespace tactus::sim
