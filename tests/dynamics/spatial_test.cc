#include "framework/dynamics/spatial.h"

#include <gtest/gtest.h>

#include "tests/dynamics/random_state.h"

// Laws: transforms keep power and compose; the cross products are what transforms do in a small motion; an inertia
// keeps its energy under transforms and adds up.  Each on random numbers.
namespace tactus::dynamics {
namespace {

using test_robots::Random;
using test_robots::uniform;

Eigen::Isometry3d randomPose(Random& random) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = test_robots::rotation(random);
  X.translation() = test_robots::uniformVector3(random, 2);
  return X;
}

Vector6d random6(Random& random) { return test_robots::uniformVector(random, 6, 2); }

RigidBodyInertia randomInertia(Random& random) {
  description::Link link;
  test_robots::giveRandomInertia(random, link);
  return RigidBodyInertia::aboutCentreOfMass(link.mass, link.centre_of_mass, link.inertia);
}

/// The pose after moving with the constant velocity v for a time t, to first order; t is small.
Eigen::Isometry3d smallMotion(const MotionVector& v, double t) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d turn = v.angular() * t;
  X.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  X.translation() = v.linear() * t;
  return X;
}

TEST(Spatial, TransformsKeepPowerAndCompose) {
  Random random(11);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Isometry3d X = randomPose(random), Y = randomPose(random);
    const MotionVector m(random6(random));
    const ForceVector f(random6(random));
    EXPECT_NEAR(transform(X, m).dot(transform(X, f)), m.dot(f), 1e-12);
    EXPECT_TRUE(near(transform(X * Y, m).coordinates(), transform(X, transform(Y, m)).coordinates(), 1e-13));
    EXPECT_TRUE(near(transform(X * Y, f).coordinates(), transform(X, transform(Y, f)).coordinates(), 1e-13));
  }
}

TEST(Spatial, TransformMovesThePointOfReference) {
  Random random(12);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Isometry3d X = randomPose(random);
    const MotionVector m(random6(random));
    const Eigen::Vector3d p = test_robots::uniformVector3(random, 2);
    EXPECT_TRUE(near(transform(X, m).at(X * p), X.linear() * m.at(p), 1e-13));
  }
}

TEST(Spatial, CrossProductsAreRatesOfTransforms) {
  Random random(13);
  const double t = 1e-6;
  for (int trial = 0; trial < 100; ++trial) {
    const MotionVector v(random6(random)), m(random6(random));
    const ForceVector f(random6(random));
    const Eigen::Isometry3d after = smallMotion(v, t), before = smallMotion(v, -t);
    const Vector6d motion_rate = (transform(after, m).coordinates() - transform(before, m).coordinates()) / (2 * t);
    const Vector6d force_rate = (transform(after, f).coordinates() - transform(before, f).coordinates()) / (2 * t);
    EXPECT_TRUE(near(v.cross(m).coordinates(), motion_rate, 1e-8));
    EXPECT_TRUE(near(v.cross(f).coordinates(), force_rate, 1e-8));
    // (2.30): the power of f on m does not change when both are carried along.
    EXPECT_NEAR(v.cross(m).dot(f) + m.dot(v.cross(f)), 0, 1e-12);
  }
}

TEST(Spatial, InertiaKeepsItsEnergyInEveryFrame) {
  Random random(14);
  for (int trial = 0; trial < 100; ++trial) {
    const Eigen::Isometry3d X = randomPose(random);
    const RigidBodyInertia I = randomInertia(random);
    const MotionVector v(random6(random));
    const MotionVector v_A = transform(X, v);
    EXPECT_TRUE(near((I.transformed(X) * v_A).coordinates(), transform(X, I * v).coordinates(), 1e-12));
    EXPECT_NEAR(v_A.dot(I.transformed(X) * v_A), v.dot(I * v), 1e-12 * (1 + v.dot(I * v)));
    EXPECT_TRUE(near(I.matrix() * v.coordinates(), (I * v).coordinates(), 1e-14));
    EXPECT_TRUE(near(I.transformed(X).transformed(X.inverse()).matrix(), I.matrix(), 1e-12));
  }
}

TEST(Spatial, KineticEnergyIsThatOfTheCentreOfMassAndTheTurning) {
  Random random(15);
  for (int trial = 0; trial < 100; ++trial) {
    description::Link link;
    test_robots::giveRandomInertia(random, link);
    const RigidBodyInertia I = RigidBodyInertia::aboutCentreOfMass(link.mass, link.centre_of_mass, link.inertia);
    const MotionVector v(random6(random));
    const double energy = 0.5 * link.mass * v.at(link.centre_of_mass).squaredNorm() +
                          0.5 * v.angular().dot(link.inertia * v.angular());
    EXPECT_NEAR(0.5 * v.dot(I * v), energy, 1e-12 * (1 + energy));
    EXPECT_TRUE(near(I.centreOfMass(), link.centre_of_mass, 1e-13));
    EXPECT_TRUE(near(I.inertiaAboutCentreOfMass(), link.inertia, 1e-12));
  }
}

TEST(Spatial, InertiasAddUp) {
  Random random(16);
  for (int trial = 0; trial < 100; ++trial) {
    const RigidBodyInertia a = randomInertia(random), b = randomInertia(random);
    const MotionVector v(random6(random));
    RigidBodyInertia sum = a;
    sum += b;
    EXPECT_TRUE(near((sum * v).coordinates(), (a * v + b * v).coordinates(), 1e-13));
    EXPECT_TRUE(near(sum.centreOfMass(), (a.first_moment + b.first_moment) / (a.mass + b.mass), 1e-14));
  }
}

TEST(Spatial, TwoPointMassesMakeADumbbell) {
  RigidBodyInertia dumbbell = RigidBodyInertia::aboutCentreOfMass(2, {0.5, 0, 0}, Eigen::Matrix3d::Zero());
  dumbbell += RigidBodyInertia::aboutCentreOfMass(2, {-0.5, 0, 0}, Eigen::Matrix3d::Zero());
  EXPECT_EQ(dumbbell.mass, 4);
  EXPECT_EQ(dumbbell.first_moment, Eigen::Vector3d::Zero());
  EXPECT_EQ(dumbbell.rotational, Eigen::Matrix3d(Eigen::Vector3d(0, 1, 1).asDiagonal()));
}

}  // namespace
}  // namespace tactus::dynamics
