// The contact force alone, without an engine: laws on random poses (signs, power, energy, order, allocation), then
// cases with an answer on paper.

#include "sim/contact_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "framework/geometry/revolution.h"
#include "tests/sim/bodies.h"
#include "tests/sim/count_allocations.h"

namespace tactus::sim {
namespace {

using Eigen::Vector3d;
using sim_tests::at;
using sim_tests::object;

constexpr double h = 0.25e-3;

Feature feature(const description::CapsuleShape& shape, int body = 0) {
  return {{body, -1}, body, {shape.from, shape.to, shape.radius}};
}

std::vector<control::ContactRecord> read(const ContactForce& contact) {
  std::vector<control::ContactRecord> records;
  contact.read(records);
  return records;
}

class Random {
 public:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector3d inCube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Eigen::Matrix3d rotation() {
    return Eigen::Quaterniond(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized().matrix();
  }

 private:
  std::mt19937_64 engine_{7};
};

std::vector<std::shared_ptr<const geometry::Shape>> shapes() {
  return {std::make_shared<geometry::Plane>(), std::make_shared<geometry::Box>(Eigen::Vector3d(0.05, 0.08, 0.03)),
          std::make_shared<geometry::Sphere>(0.03), std::make_shared<geometry::Cylinder>(0.03, 0.05),
          std::make_shared<geometry::Capsule>(0.02, 0.05)};
}

/// A capsule that touches the shape by at most a few millimetres, in a random pose, found by drawing.
BodyMotion touchingPose(const geometry::Shape& shape, const description::CapsuleShape& capsule,
                        Random& random) {
  while (true) {
    BodyMotion motion;
    motion.R_WB = random.rotation();
    motion.p_WB = random.inCube(0.08);
    double nearest = 1;
    for (double t = 0; t <= 1; t += 0.02)
      nearest = std::min(
          nearest,
          shape.distance(motion.p_WB + motion.R_WB * (capsule.from + t * (capsule.to - capsule.from))).distance);
    const double depth = capsule.radius - nearest;
    if (depth > 1e-4 && depth < 4e-3) return motion;
  }
}

TEST(ContactForce, NormalsPointOutOfTheRobotAndFrictionOpposesSlip) {
  Random random;
  const description::CapsuleShape capsule = sim_tests::capsule(0.01, 0.05);
  for (const auto& shape : shapes())
    for (int trial = 0; trial < 200; ++trial) {
      description::Scene scene;
      scene.objects = {object("thing", at(0, 0, 0), shape)};
      ContactForce contact({feature(capsule)}, scene, 1);
      BodyMotion motion = touchingPose(*shape, capsule, random);
      motion.linear_W = random.inCube(0.1);
      contact.evaluate({motion}, h);
      const auto records = read(contact);
      ASSERT_EQ(records.size(), 1u);
      const control::ContactRecord& record = records[0];
      EXPECT_NEAR(record.normal_W.norm(), 1, 1e-12);
      EXPECT_NEAR(record.normal_W.dot(record.friction_W), 0, 1e-12);
      EXPECT_NEAR(shape->distance(record.point_W).distance, 0, 1e-9) << "the point lies on the object";
      // Into the object: against its outward normal.  Capsules across an edge have two; their mean still goes inwards.
      EXPECT_LT(record.normal_W.dot(shape->distance(record.point_W).gradient), 0);
      EXPECT_GE(record.force_N, 0);
      // On the robot the force is the opposite of what the robot does to the object.
      const Vector3d force_W = record.force_N * record.normal_W + record.friction_W;
      EXPECT_LT((contact.wrenches()[0].force_W + force_W).norm(), 1e-12);
      EXPECT_GE(record.friction_W.dot(motion.linear_W), -1e-9) << "the robot drags the object along";
    }
}

/// Work that the elastic force does along a small random displacement equals the loss of Σ ½ k w δ², because the
/// interior point stands where that energy is stationary.
TEST(ContactForce, ElasticForceIsTheGradientOfAnEnergy) {
  Random random;
  const description::CapsuleShape capsule = sim_tests::capsule(0.01, 0.05);
  for (const auto& shape : shapes())
    for (int trial = 0; trial < 100; ++trial) {
      description::Scene scene;
      scene.objects = {object("thing", at(0, 0, 0), shape)};
      scene.objects[0].material = {.stiffness = 2000, .dissipation = 0, .friction = 0};
      ContactForce contact({feature(capsule)}, scene, 1);
      const BodyMotion motion = touchingPose(*shape, capsule, random);
      // Energy by brute force over t, refined around the best.
      const auto energy = [&](const BodyMotion& m) {
        const auto depth = [&](double t) {
          const Vector3d p = m.p_WB + m.R_WB * (capsule.from + t * (capsule.to - capsule.from));
          return std::max(0.0, capsule.radius - shape->distance(p).distance);
        };
        const auto interior = [&](double t) { return 4 * t * (1 - t) * depth(t) * depth(t); };
        double best = 0, span = 0.5, middle = 0.5;
        for (int round = 0; round < 6; ++round, span *= 0.01) {
          double best_t = middle;
          for (int i = -1000; i <= 1000; ++i) {
            const double t = std::clamp(middle + span * i / 1000.0, 0.0, 1.0);
            if (interior(t) > best) {
              best = interior(t);
              best_t = t;
            }
          }
          middle = best_t;
        }
        return 0.5 * 2000 * (depth(0) * depth(0) + depth(1) * depth(1) + best);
      };
      contact.evaluate({motion}, h);
      const BodyWrench wrench = contact.wrenches()[0];
      const double step = 1e-7;
      const Vector3d shift = random.inCube(1), turn = random.inCube(30);
      const auto moved = [&](double s) {
        BodyMotion m = motion;
        m.p_WB += s * shift;
        m.R_WB = Eigen::AngleAxisd(s * turn.norm(), turn.normalized()).toRotationMatrix() * motion.R_WB;
        return m;
      };
      const double loss = -(energy(moved(step)) - energy(moved(-step))) / (2 * step);
      const double work = wrench.force_W.dot(shift) + wrench.torque_W.dot(turn);
      EXPECT_NEAR(work, loss, 1e-3 * (wrench.force_W.norm() * shift.norm() + wrench.torque_W.norm() * turn.norm()))
          << typeid(*shape).name();
    }
}

TEST(ContactForce, ElasticForceIsContinuousInThePose) {
  // A capsule longer than the box under it, rocked through the level: the deepest point jumps from edge to edge,
  // the force must not.
  description::Scene scene;
  scene.objects = {object("block", at(0, 0, -0.01), std::make_shared<geometry::Box>(Eigen::Vector3d(0.03, 0.03, 0.02)))};
  ContactForce contact({feature(sim_tests::capsule(0.01, 0.08))}, scene, 1);
  std::optional<Vector3d> last_torque_W;
  for (double pitch = -0.02; pitch <= 0.02; pitch += 1e-5) {
    BodyMotion motion;
    motion.R_WB = Eigen::AngleAxisd(pitch, Vector3d::UnitY()).toRotationMatrix();
    motion.p_WB = {0, 0, 0.01 - 0.5e-3};
    contact.evaluate({motion}, h);
    const Vector3d torque_W = contact.wrenches()[0].torque_W;
    // Springs at most 4 cm out turn with k L² ≈ 3 N m/rad each; a jump from edge to edge would be 27 mN m at once.
    EXPECT_LT((torque_W - last_torque_W.value_or(torque_W)).norm(), 10 * 1e-5);
    last_torque_W = torque_W;
  }
}

TEST(ContactForce, SpherePairFollowsHuntCrossley) {
  description::Scene scene;
  scene.objects = {object("ball", at(0.1, 0.2, 0.3), std::make_shared<geometry::Sphere>(0.03))};
  scene.objects[0].material = {.stiffness = 1500, .dissipation = 3, .friction = 0.4};
  const Vector3d direction = Vector3d(1, -2, 2).normalized();
  for (double depth : {1e-5, 1e-4, 1e-3, 5e-3})
    for (double rate : {-1.0, -0.1, 0.0, 0.2}) {
      ContactForce contact({feature(sim_tests::sphere(0.01))}, scene, 1);
      BodyMotion motion;
      motion.p_WB = Vector3d(0.1, 0.2, 0.3) - (0.04 - depth) * direction;
      motion.linear_W = rate * direction;
      contact.evaluate({motion}, h);
      const auto records = read(contact);
      ASSERT_EQ(records.size(), 1u);
      EXPECT_NEAR(records[0].depth, depth, 1e-15);
      EXPECT_NEAR(records[0].force_N, std::max(0.0, 1500 * depth * (1 + 3 * rate)), 1e-10);
      EXPECT_LT((records[0].normal_W - direction).norm(), 1e-12);
      EXPECT_LT((records[0].point_W - (Vector3d(0.1, 0.2, 0.3) - 0.03 * direction)).norm(), 1e-12);
    }
}

TEST(ContactForce, NormalForceIsCappedAndNeverPulls) {
  description::Scene scene;
  scene.objects = {object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>())};
  scene.objects[0].material.stiffness = 1e6;
  ContactForce contact({feature(sim_tests::sphere(0.01))}, scene, 1, {.force_limit = 50});
  BodyMotion motion;
  motion.p_WB = {0, 0, 0.005};
  contact.evaluate({motion}, h);
  EXPECT_DOUBLE_EQ(read(contact)[0].force_N, 50);
  motion.linear_W = {0, 0, 10};                                    // leaving fast: c δ̇ < −1
  contact.evaluate({motion}, h);
  EXPECT_DOUBLE_EQ(read(contact)[0].force_N, 0);
  EXPECT_EQ(contact.wrenches()[0].force_W, Vector3d::Zero());
}

TEST(ContactForce, BristlesLoadUpToCoulombAndForgetOnRelease) {
  description::Scene scene;
  scene.objects = {object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>())};
  scene.objects[0].material = {.stiffness = 2000, .dissipation = 0, .friction = 0.3};
  ContactForce contact({feature(sim_tests::sphere(0.01))}, scene, 1);
  BodyMotion motion;
  motion.p_WB = {0, 0, 0.0095};                                    // 1 N
  const auto friction = [&](double speed, bool keep) {
    motion.linear_W = {speed, 0, 0};
    contact.evaluate({motion}, h);
    const double drag = -contact.wrenches()[0].force_W.x();
    if (keep) contact.commit();
    return drag;
  };
  const double once = friction(0.01, false);
  EXPECT_DOUBLE_EQ(friction(0.01, false), once) << "an evaluation that is not committed leaves no trace";
  double last = 0;
  for (int i = 0; i < 400; ++i) last = friction(0.01, true);
  EXPECT_NEAR(last, 0.3, 1e-12) << "sliding: μN";
  EXPECT_NEAR(friction(0, true), 0.3, 1e-12) << "a loaded bristle holds";
  motion.p_WB.z() = 0.02;
  contact.evaluate({motion}, h);
  contact.commit();
  motion.p_WB.z() = 0.0095;
  EXPECT_NEAR(friction(0, true), 0, 1e-15) << "lifted off, it is straight again";
}

/// A sphere sunk into a table, as a bump: what lies under the table's top cannot be touched.
class SunkSphere : public ::testing::Test {
 protected:
  SunkSphere() {
    scene_.objects = {object("table", at(0, 0, -0.05), std::make_shared<geometry::Box>(Eigen::Vector3d(1, 1, 0.1))),
                      object("bump", at(0, 0, -0.015), std::make_shared<geometry::Sphere>(0.03))};
  }
  std::vector<control::ContactRecord> touch(const Vector3d& centre, double radius) {
    ContactForce contact({feature(sim_tests::sphere(radius))}, scene_, 1);
    BodyMotion motion;
    motion.p_WB = centre;
    contact.evaluate({motion}, h);
    total_force_W_ = contact.wrenches()[0].force_W;
    return read(contact);
  }
  description::Scene scene_;
  Vector3d total_force_W_;
};

TEST_F(SunkSphere, BuriedPartGivesNoGhostForce) {
  // A probe thick in the table's side of the bump: its nearest point on the sphere is far below the top.
  const auto records = touch({0.036, 0, -0.012}, 0.01);
  for (const control::ContactRecord& record : records) EXPECT_EQ(record.object, 0) << "only the table answers";
  ASSERT_EQ(records.size(), 1u);
  EXPECT_NEAR(total_force_W_.x(), 0, 1e-12);
}

TEST_F(SunkSphere, TopOfTheBumpAndFlatTableAreFeltAlone) {
  const auto top = touch({0, 0, 0.0245}, 0.01);                    // on the bump, the table's top is buried here
  ASSERT_EQ(top.size(), 1u);
  EXPECT_EQ(top[0].object, 1);
  EXPECT_NEAR(top[0].point_W.z(), 0.015, 1e-12);
  const auto table = touch({0.1, 0, 0.0095}, 0.01);
  ASSERT_EQ(table.size(), 1u);
  EXPECT_EQ(table[0].object, 0);
}

TEST_F(SunkSphere, ForceFadesContinuouslyAcrossTheFoot) {
  std::optional<Vector3d> last_W;
  for (int i = 0; i <= 4000; ++i) {                                // 10 µm at a time, a few millimetres deep
    touch({0.02 + 1e-5 * i, 0, 0.0075 - 2e-6 * i}, 0.01);
    // k δ changes by 2000 × 10 µm; the fade multiplies forces of up to 10 N by 1.5 × 10 µm / 1 mm.
    EXPECT_LT((total_force_W_ - last_W.value_or(total_force_W_)).norm(), 0.02 + 0.15) << "at step " << i;
    last_W = total_force_W_;
  }
}

TEST(ContactForce, RecordsComeInTheStatedOrder) {
  description::Scene scene;
  scene.objects = {object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>()),
                   object("pair", at(0, 0, 0), std::make_shared<geometry::Box>(Eigen::Vector3d(0.1, 0.1, 1e-3)))};
  scene.objects[1].primitives.push_back({std::make_shared<geometry::Sphere>(0.02), at(0, 0, 0)});
  const description::CapsuleShape ball = sim_tests::sphere(0.03);
  ContactForce contact({feature(ball, 0), feature(ball, 0), feature(ball, 1)}, scene, 2, {.burial_fade = 1});
  contact.evaluate({{.p_WB = {0, 0, 0.0295}}, {.p_WB = {0.01, 0, 0.0295}}}, h);
  const auto records = read(contact);
  ASSERT_EQ(records.size(), 9u);
  for (size_t i = 0; i < 9; ++i) {
    EXPECT_EQ(records[i].link, i < 6 ? 0 : 1);
    EXPECT_EQ(records[i].object, i % 3 == 0 ? 0 : 1);
  }
}

TEST(ContactForce, AllocatesNothing) {
  description::Scene scene;
  scene.objects = {object("ground", at(0, 0, 0), std::make_shared<geometry::Plane>()),
                   object("block", at(0, 0, 0), std::make_shared<geometry::Box>(Eigen::Vector3d(0.2, 0.1, 0.02))),
                   object("ball", at(0.02, 0, 0), std::make_shared<geometry::Sphere>(0.03)),
                   object("can", at(-0.02, 0, 0), std::make_shared<geometry::Cylinder>(0.03, 0.05)),
                   object("pill", at(0, 0.02, 0), std::make_shared<geometry::Capsule>(0.02, 0.05)),
                   object("cup", at(0.01, 0.01, -0.02), std::make_shared<geometry::Revolution>(std::vector<Eigen::Vector2d>{
                       {0, 0}, {0.05, 0}, {0.05, 0.06}, {0.046, 0.06}, {0.046, 0.006}, {0, 0.006}}))};
  std::vector<Feature> features;
  std::vector<BodyMotion> motions(10);
  for (int i = 0; i < 10; ++i) features.push_back(feature(sim_tests::capsule(0.012, 0.03), i));
  ContactForce contact(features, scene, 10);
  std::vector<control::ContactRecord> records;
  records.reserve(contact.capacity());
  Random random;
  size_t touches = 0;
  const long before = sim_tests::allocations();
  for (int step = 0; step < 200; ++step) {
    for (BodyMotion& motion : motions) {
      motion.R_WB = random.rotation();
      motion.p_WB = random.inCube(0.05);
      motion.linear_W = random.inCube(0.1);
    }
    contact.evaluate(motions, h);
    contact.commit();
    contact.read(records);
    touches += records.size();
  }
  EXPECT_EQ(sim_tests::allocations(), before);
  records = std::vector<control::ContactRecord>(records);
  EXPECT_GT(sim_tests::allocations(), before) << "the count counts";
  EXPECT_GT(touches, 1000u);
}

}  // namespace
}  // namespace tactus::sim
