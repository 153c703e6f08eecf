#include "framework/dynamics/kinematics.h"

#include <gtest/gtest.h>

#include "tests/dynamics/random_state.h"

// Laws on random trees: poses against the product of the joint transforms as the description states them; Jacobians and
// J̇ q̇ against finite differences.  Then check points of the arm and the hand, worked out elsewhere from their tables.
namespace tactus::dynamics {
namespace {

using description::JointType;
using test_robots::Random;

constexpr double step = 1e-6;                                      // of central differences: error about 1e-9

/// The joint's own positions, by its name, or what its driver makes of them.
Eigen::VectorXd positionsOf(const RandomState& state, const description::Joint& joint) {
  if (joint.mimic) {
    const Eigen::VectorXd driver = positionsOf(state, state.robot.joints[joint.mimic->driver]);
    return (driver * joint.mimic->multiplier).array() + joint.mimic->offset;
  }
  for (const Model::Joint& one : state.model.joints())
    if (one.name == joint.name) return state.q.segment(one.position, one.position_count);
  return {};
}

/// Pose of a link by the plain product of transforms from the base.
Eigen::Isometry3d productOfJoints(const RandomState& state, int link) {
  for (const description::Joint& joint : state.robot.joints) {
    if (joint.child != link) continue;
    Eigen::Isometry3d X = productOfJoints(state, joint.parent) * joint.origin;
    const Eigen::VectorXd q = positionsOf(state, joint);
    const auto quaternion = [&](int i) { return Eigen::Quaterniond(q[i], q[i + 1], q[i + 2], q[i + 3]); };
    switch (joint.type) {
      case JointType::fixed: break;
      case JointType::revolute: X.rotate(Eigen::AngleAxisd(q[0], joint.axis)); break;
      case JointType::prismatic: X.translate(q[0] * joint.axis); break;
      case JointType::planar: {
        const Eigen::Matrix3d plane = description::planeFrame(joint.axis);
        X.translate(plane.col(0) * q[0] + plane.col(1) * q[1]).rotate(Eigen::AngleAxisd(q[2], joint.axis));
        break;
      }
      case JointType::spherical: X.rotate(quaternion(0)); break;
      case JointType::floating: X.translate(q.head<3>()).rotate(quaternion(3)); break;
    }
    return X;
  }
  return Eigen::Isometry3d::Identity();
}

/// A frame, and a point of it in its own coordinates.
struct Place {
  int frame;
  Eigen::Vector3d point_F;
};

Place randomPlace(const RandomState& state, Random& random) {
  const int frame = static_cast<int>(random() % state.model.frames().size());
  return {frame, test_robots::uniformVector3(random, 0.5)};
}

/// ω with [ω]× = Ṙ Rᵀ, from two poses 2·step apart.
Eigen::Vector3d angularRate(const Eigen::Matrix3d& before, const Eigen::Matrix3d& after) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(after * before.transpose()));
  return turn.angle() * turn.axis() / (2 * step);
}

Eigen::MatrixXd pointJacobianOf(const RandomState& state, int frame, const Eigen::Vector3d& point_W) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Constant(3, state.model.dof(), 17);
  pointJacobian(state.model, state.workspace, frame, point_W, J);
  return J;
}

Eigen::MatrixXd frameJacobianOf(const RandomState& state, int frame) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Constant(6, state.model.dof(), 17);
  frameJacobian(state.model, state.workspace, frame, J);
  return J;
}

TEST(Kinematics, PosesAreTheProductOfTheJoints) {
  onRandomStates(31, [](RandomState& state, Random&) {
    forwardKinematics(state.model, state.q, state.workspace);
    for (size_t i = 0; i < state.robot.links.size(); ++i) {
      const int frame = static_cast<int>(i);
      const Eigen::Isometry3d X_WF = framePose(state.model, state.workspace, frame);
      EXPECT_TRUE(near(X_WF.matrix(), productOfJoints(state, frame).matrix(), 1e-13));
      EXPECT_EQ(X_WF.translation(), framePosition(state.model, state.workspace, frame));
    }
  });
}

TEST(Kinematics, JacobiansAreDerivativesOfPoses) {
  onRandomStates(32, [](RandomState& state, Random& random) {
    const Place place = randomPlace(state, random);
    Eigen::MatrixXd point_rates(3, state.model.dof()), frame_rates(6, state.model.dof());
    for (int i = 0; i < state.model.dof(); ++i) {
      Eigen::Isometry3d X[2];
      for (const int side : {0, 1}) {
        forwardKinematics(state.model, nudged(state.model, state.q, i, side ? step : -step), state.workspace);
        X[side] = framePose(state.model, state.workspace, place.frame);
      }
      point_rates.col(i) = (X[1] * place.point_F - X[0] * place.point_F) / (2 * step);
      frame_rates.col(i) << (X[1].translation() - X[0].translation()) / (2 * step),
          angularRate(X[0].linear(), X[1].linear());
    }
    forwardKinematics(state.model, state.q, state.workspace);
    const Eigen::Vector3d point_W = framePose(state.model, state.workspace, place.frame) * place.point_F;
    EXPECT_TRUE(near(pointJacobianOf(state, place.frame, point_W), point_rates, 1e-8, 1));
    EXPECT_TRUE(near(frameJacobianOf(state, place.frame), frame_rates, 1e-8, 1));
  });
}

TEST(Kinematics, VelocitiesAreJacobiansTimesJointVelocities) {
  onRandomStates(33, [](RandomState& state, Random& random) {
    const Place place = randomPlace(state, random);
    forwardKinematics(state.model, state.q, state.workspace);
    forwardVelocities(state.model, state.qd, state.workspace);
    const Eigen::Vector3d point_W = framePose(state.model, state.workspace, place.frame) * place.point_F;
    EXPECT_TRUE(near(pointVelocity(state.model, state.workspace, place.frame, point_W),
                     pointJacobianOf(state, place.frame, point_W) * state.qd, 1e-12, 1));
    EXPECT_TRUE(near(frameVelocity(state.model, state.workspace, place.frame),
                     frameJacobianOf(state, place.frame) * state.qd, 1e-12, 1));
  });
}

TEST(Kinematics, AccelerationBiasIsTheRateOfTheVelocityAtConstantJointVelocity) {
  onRandomStates(34, [](RandomState& state, Random& random) {
    const Place place = randomPlace(state, random);
    Eigen::Vector3d point_velocity[2];
    Vector6d frame_velocity[2];
    for (const int side : {0, 1}) {
      forwardKinematics(state.model, moved(state.model, state.q, state.qd, side ? step : -step), state.workspace);
      const Eigen::Vector3d point_W = framePose(state.model, state.workspace, place.frame) * place.point_F;
      point_velocity[side] = pointJacobianOf(state, place.frame, point_W) * state.qd;
      frame_velocity[side] = frameJacobianOf(state, place.frame) * state.qd;
    }
    forwardKinematics(state.model, state.q, state.workspace);
    forwardVelocities(state.model, state.qd, state.workspace);
    const Eigen::Vector3d point_W = framePose(state.model, state.workspace, place.frame) * place.point_F;
    EXPECT_TRUE(near(pointAccelerationBias(state.model, state.workspace, place.frame, point_W),
                     (point_velocity[1] - point_velocity[0]) / (2 * step), 1e-7, 1));
    EXPECT_TRUE(near(frameAccelerationBias(state.model, state.workspace, place.frame),
                     (frame_velocity[1] - frame_velocity[0]) / (2 * step), 1e-7, 1));
  });
}

TEST(Kinematics, EveryChoiceOfAxesIsConsistent) {
  for (const Axes axes : {Axes::mixed, Axes::world, Axes::local}) {
    onRandomStates(38, [&](RandomState& state, Random& random) {
      const int frame = randomPlace(state, random).frame;
      Vector6d velocity[2];
      for (const int side : {0, 1}) {
        const double t = side ? step : -step;
        forwardKinematics(state.model, moved(state.model, state.q, state.qd + 0.5 * t * state.qdd, t), state.workspace);
        forwardVelocities(state.model, state.qd + t * state.qdd, state.workspace);
        velocity[side] = frameVelocity(state.model, state.workspace, frame, axes);
      }
      forwardKinematics(state.model, state.q, state.workspace);
      forwardVelocities(state.model, state.qd, state.workspace);
      forwardAccelerations(state.model, state.qdd, MotionVector::Zero(), state.workspace);
      Eigen::MatrixXd J(6, state.model.dof());
      frameJacobian(state.model, state.workspace, frame, J, axes);
      const Vector6d v = frameVelocity(state.model, state.workspace, frame, axes);
      const Vector6d a = frameAcceleration(state.model, state.workspace, frame, axes);
      EXPECT_TRUE(near(J * state.qd, v, 1e-11, 1));
      EXPECT_TRUE(near(a, J * state.qdd + frameAccelerationBias(state.model, state.workspace, frame, axes), 1e-11, 1));
      EXPECT_TRUE(near(a, (velocity[1] - velocity[0]) / (2 * step), 1e-6, 1));
      // The coordinates are those of the mixed velocity, moved and turned.
      const Eigen::Isometry3d X_WF = framePose(state.model, state.workspace, frame);
      const Vector6d mixed = frameVelocity(state.model, state.workspace, frame);
      Vector6d expected = mixed;
      if (axes == Axes::world) expected.head<3>() += X_WF.translation().cross(mixed.tail<3>());
      if (axes == Axes::local)
        expected << X_WF.linear().transpose() * mixed.head<3>(), X_WF.linear().transpose() * mixed.tail<3>();
      EXPECT_TRUE(near(v, expected, 1e-12, 1));
    });
  }
}

TEST(Kinematics, DirectionJacobianIsARowOfThePointJacobian) {
  onRandomStates(35, [](RandomState& state, Random& random) {
    const Place place = randomPlace(state, random);
    forwardKinematics(state.model, state.q, state.workspace);
    const Eigen::Vector3d point_W = test_robots::uniformVector3(random, 1), n_W = test_robots::direction(random);
    Eigen::MatrixXd stacked = Eigen::MatrixXd::Constant(4, state.model.dof(), 17);
    directionJacobian(state.model, state.workspace, place.frame, point_W, n_W, stacked.row(2));
    EXPECT_TRUE(near(stacked.row(2), n_W.transpose() * pointJacobianOf(state, place.frame, point_W), 1e-13, 1));
    EXPECT_EQ(stacked.row(1).minCoeff(), 17);                      // its neighbours are left alone
    EXPECT_EQ(stacked.row(3).maxCoeff(), 17);
  });
}

TEST(Kinematics, JacobiansFillBlocksOfLargerMatrices) {
  Random random(36);
  RandomState state(test_robots::lwrAllegro(), random);
  forwardKinematics(state.model, state.q, state.workspace);
  const int tip = state.model.frameIndex("ring_tip");
  const Eigen::Vector3d point_W = framePose(state.model, state.workspace, tip).translation();
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Constant(12, 23, 17);
  pointJacobian(state.model, state.workspace, tip, point_W, stacked.middleRows<3>(1));
  frameJacobian(state.model, state.workspace, tip, stacked.middleRows<6>(5));
  EXPECT_EQ(Eigen::MatrixXd(stacked.middleRows<3>(1)), pointJacobianOf(state, tip, point_W));
  EXPECT_EQ(Eigen::MatrixXd(stacked.middleRows<6>(5)), frameJacobianOf(state, tip));
  EXPECT_EQ(stacked.row(0).minCoeff(), 17);
  EXPECT_EQ(stacked.row(4).minCoeff(), 17);
  EXPECT_EQ(stacked.row(11).minCoeff(), 17);
}

TEST(Kinematics, FramesOnTheBaseStandStill) {
  Random random(37);
  RandomState state(test_robots::lwr(), random);
  forwardKinematics(state.model, state.q, state.workspace);
  forwardVelocities(state.model, state.qd, state.workspace);
  const int base = state.model.frameIndex("base");
  EXPECT_EQ(framePose(state.model, state.workspace, base).matrix(), Eigen::Matrix4d::Identity());
  EXPECT_EQ(frameVelocity(state.model, state.workspace, base), Vector6d::Zero());
  EXPECT_EQ(frameAccelerationBias(state.model, state.workspace, base), Vector6d::Zero());
  EXPECT_EQ(frameJacobianOf(state, base), Eigen::MatrixXd::Zero(6, 7));
  EXPECT_EQ(pointJacobianOf(state, base, {1, 2, 3}), Eigen::MatrixXd::Zero(3, 7));
}

/// Poses of the arm and the hand to the six digits in which the check points are given.
class CheckPoints : public ::testing::Test {
 protected:
  static constexpr double digits = 1e-6;

  static Eigen::Isometry3d poseAt(const description::Robot& robot, const Eigen::VectorXd& q, const std::string& link) {
    const Model model(robot);
    Workspace workspace(model);
    forwardKinematics(model, q, workspace);
    return framePose(model, workspace, model.frameIndex(link));
  }
  static Eigen::VectorXd joints(std::initializer_list<double> values) {
    return Eigen::Map<const Eigen::VectorXd>(values.begin(), static_cast<int>(values.size()));
  }
};

TEST_F(CheckPoints, ArmStretchedUp) {
  const Eigen::Isometry3d X = poseAt(test_robots::lwr(), Eigen::VectorXd::Zero(7), "7");
  EXPECT_LT((X.translation() - Eigen::Vector3d(0, 0, 1.1785)).norm(), digits);
  EXPECT_LT((X.linear() - Eigen::Matrix3d::Identity()).norm(), digits);
}

TEST_F(CheckPoints, ArmStretchedBack) {
  const Eigen::Isometry3d X = poseAt(test_robots::lwr(), joints({0, std::numbers::pi / 2, 0, 0, 0, 0, 0}), "7");
  EXPECT_LT((X.translation() - Eigen::Vector3d(-0.868, 0, 0.3105)).norm(), digits);
  EXPECT_LT((X.linear().col(2) + Eigen::Vector3d::UnitX()).norm(), digits);
}

TEST_F(CheckPoints, ArmBent) {
  const Eigen::Isometry3d X = poseAt(test_robots::lwr(), joints({0.1, 0.5, -0.3, 1.2, 0.4, -0.7, 0.2}), "7");
  Eigen::Matrix3d R;
  R << 0.142570, -0.177037, 0.973823, 0.579064, 0.812845, 0.062995, -0.802719, 0.554925, 0.218403;
  EXPECT_LT((X.translation() - Eigen::Vector3d(0.131684, -0.097455, 0.969073)).cwiseAbs().maxCoeff(), digits);
  EXPECT_LT((X.linear() - R).cwiseAbs().maxCoeff(), digits);
}

TEST_F(CheckPoints, HandOpen) {
  const Eigen::VectorXd q = joints({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.263, 0, 0, 0});
  const auto expectTip = [&](const std::string& tip, const Eigen::Vector3d& p) {
    const Eigen::Vector3d error = poseAt(test_robots::allegro(), q, tip).translation() - p;
    EXPECT_LT(error.cwiseAbs().maxCoeff(), digits) << tip;
  };
  expectTip("index_tip", {0, 0.055310, 0.133442});
  expectTip("middle_tip", {0, 0, 0.136200});
  expectTip("ring_tip", {0, -0.055310, 0.133442});
  expectTip("thumb_tip", {0.025963, 0.161226, -0.085504});
}

TEST_F(CheckPoints, HandBent) {
  const Eigen::VectorXd q = joints({0, 0.5, 0.5, 0.5, 0, 0.5, 0.5, 0.5, 0, 0.5, 0.5, 0.5, 1.0, 0.3, 0.4, 0.5});
  const auto expectTip = [&](const std::string& tip, const Eigen::Vector3d& p) {
    const Eigen::Vector3d error = poseAt(test_robots::allegro(), q, tip).translation() - p;
    EXPECT_LT(error.cwiseAbs().maxCoeff(), digits) << tip;
  };
  expectTip("index_tip", {0.084835, 0.051033, 0.084555});
  expectTip("middle_tip", {0.084835, 0, 0.087126});
  expectTip("ring_tip", {0.084835, -0.051033, 0.084555});
  expectTip("thumb_tip", {0.103420, 0.074685, -0.026962});
}

}  // namespace
}  // namespace tactus::dynamics
