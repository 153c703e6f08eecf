#include "framework/dynamics/dynamics_cache.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <type_traits>

#include "framework/dynamics/crba.h"
#include "framework/dynamics/forward_dynamics.h"
#include "framework/dynamics/rnea.h"
#include "conformance/allocation_count.h"
#include "tests/dynamics/random_state.h"

namespace tactus::dynamics {
namespace {

using test_robots::Random;

// Neither outlives its model by accident.
static_assert(!std::is_constructible_v<DynamicsCache, Model>);
static_assert(!std::is_constructible_v<ForwardDynamics, Model>);
static_assert(std::is_constructible_v<DynamicsCache, const Model&>);

std::string refusal(const std::function<void()>& call) {
  try {
    call();
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

TEST(DynamicsCache, WrongSizesAreRefused) {
  const Model model(test_robots::lwr());
  DynamicsCache cache(model);
  const Eigen::VectorXd three = Eigen::VectorXd::Zero(3), seven = Eigen::VectorXd::Zero(7);
  EXPECT_EQ(refusal([&] { cache.update(three, seven); }), "q has 3 numbers, the model takes 7");
  EXPECT_EQ(refusal([&] { cache.update(seven, three); }), "qd has 3 numbers, the model takes 7");
  EXPECT_EQ(cache.q(), seven);
  Workspace workspace(model);
  ForwardDynamics forward(model);
  Eigen::VectorXd qdd;
  EXPECT_EQ(refusal([&] { forward.compute(seven, seven, three, {0, 0, -9.81}, workspace, qdd); }),
            "tau has 3 numbers, the model takes 7");
  forward.compute(seven, seven, seven, {0, 0, -9.81}, workspace, qdd);
  EXPECT_EQ(qdd.size(), 7);
}

TEST(DynamicsCache, AgreesWithTheFreeFunctions) {
  onRandomStates(81, [](RandomState& state, Random& random) {
    const int dof = state.model.dof();
    DynamicsCache cache(state.model, state.gravity_W);
    cache.update(randomConfiguration(state.model, random), test_robots::uniformVector(random, dof, 2));
    cache.update(state.q, state.qd);                               // nothing of the state before may stay

    Eigen::MatrixXd M(dof, dof);
    Eigen::VectorXd bias(dof), gravity(dof);
    crba(state.model, state.q, state.workspace, M);
    gravityTorque(state.model, state.q, state.gravity_W, state.workspace, gravity);
    nonlinearEffects(state.model, state.q, state.qd, state.gravity_W, state.workspace, bias);
    forwardKinematics(state.model, state.q, state.workspace);
    forwardVelocities(state.model, state.qd, state.workspace);
    EXPECT_EQ(cache.q(), state.q);
    EXPECT_EQ(cache.qd(), state.qd);
    EXPECT_TRUE(near(cache.massMatrix(), M, 1e-13));
    EXPECT_TRUE(near(cache.massFactor() * cache.massFactor().transpose(), M, 1e-13));
    EXPECT_TRUE(cache.massFactor().isLowerTriangular(0));
    EXPECT_TRUE(near(cache.bias(), bias, 1e-12, 1));
    EXPECT_TRUE(near(cache.gravityTorque(), gravity, 1e-12, 1));

    const int frame = static_cast<int>(random() % state.model.frames().size());
    const Eigen::Vector3d point_W = test_robots::uniformVector3(random, 1), n_W = test_robots::direction(random);
    const Eigen::Isometry3d X_WF = framePose(state.model, state.workspace, frame);
    EXPECT_TRUE(near(cache.framePose(frame).matrix(), X_WF.matrix(), 1e-15));
    EXPECT_TRUE(near(cache.frameVelocity(frame), frameVelocity(state.model, state.workspace, frame), 1e-14, 1));
    EXPECT_TRUE(near(cache.frameAccelerationBias(frame), frameAccelerationBias(state.model, state.workspace, frame),
                     1e-14, 1));
    Eigen::MatrixXd J(3, dof), J_cache(3, dof), J_frame(6, dof), J_frame_cache(6, dof);
    Eigen::RowVectorXd row(dof);
    pointJacobian(state.model, state.workspace, frame, point_W, J);
    frameJacobian(state.model, state.workspace, frame, J_frame);
    cache.pointJacobian(frame, point_W, J_cache);
    cache.frameJacobian(frame, J_frame_cache);
    cache.directionJacobian(frame, point_W, n_W, row);
    EXPECT_TRUE(near(J_cache, J, 1e-14, 1));
    EXPECT_TRUE(near(J_frame_cache, J_frame, 1e-14, 1));
    EXPECT_TRUE(near(row, n_W.transpose() * J, 1e-13, 1));
    EXPECT_TRUE(near(cache.pointVelocity(frame, point_W), J * state.qd, 1e-12, 1));
    EXPECT_TRUE(near(cache.pointAccelerationBias(frame, point_W),
                     pointAccelerationBias(state.model, state.workspace, frame, point_W), 1e-14, 1));
  });
}

TEST(DynamicsCache, IsReadyAtRest) {
  const Model model(test_robots::lwrAllegro());
  const DynamicsCache cache(model);
  EXPECT_EQ(cache.q(), Eigen::VectorXd::Zero(23));
  EXPECT_GT(cache.massMatrix()(0, 0), 0);
  EXPECT_TRUE(near(cache.bias(), cache.gravityTorque(), 1e-15));
}

TEST(DynamicsCache, ACopyStandsAlone) {
  Random random(82);
  RandomState state(test_robots::lwrAllegro(), random);
  DynamicsCache cache(state.model, state.gravity_W);
  cache.update(state.q, state.qd);
  const DynamicsCache copy = cache;
  cache.update(Eigen::VectorXd::Zero(23), Eigen::VectorXd::Zero(23));
  DynamicsCache fresh(state.model, state.gravity_W);
  fresh.update(state.q, state.qd);
  EXPECT_EQ(copy.massMatrix(), fresh.massMatrix());
  EXPECT_EQ(copy.frameVelocity(20), fresh.frameVelocity(20));
}

TEST(DynamicsCache, ARobotThatCannotMoveIsNoTrouble) {
  description::Robot robot;
  test_robots::addLink(robot, "base", 1, Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones());
  const Model model(robot);
  DynamicsCache cache(model);
  cache.update(Eigen::VectorXd(0), Eigen::VectorXd(0));
  EXPECT_EQ(cache.massMatrix().size(), 0);
  EXPECT_EQ(cache.framePose(0).matrix(), Eigen::Matrix4d::Identity());
}

TEST(DynamicsCache, TakesNoMemoryAfterConstruction) {
  onRandomStates(83, [](RandomState& state, Random& random) {
    const int dof = state.model.dof();
    DynamicsCache cache(state.model, state.gravity_W);
    Eigen::MatrixXd stacked(12, dof);
    const Eigen::Vector3d point_W = test_robots::uniformVector3(random, 1);
    const int frame = static_cast<int>(state.model.frames().size()) - 1;
    double sum = 0;
    const long before = conformance::allocationCount();
    for (int tick = 0; tick < 3; ++tick) {
      state.q *= 1.001;
      cache.update(state.q, state.qd);
      cache.pointJacobian(frame, point_W, stacked.middleRows<3>(0));
      cache.frameJacobian(frame, stacked.middleRows<6>(3));
      cache.directionJacobian(frame, point_W, Eigen::Vector3d::UnitZ(), stacked.row(9));
      sum += cache.framePose(frame).translation().sum() + cache.frameVelocity(frame).sum() +
             cache.pointVelocity(frame, point_W).sum() + cache.pointAccelerationBias(frame, point_W).sum() +
             cache.frameAccelerationBias(frame).sum();
    }
    EXPECT_EQ(conformance::allocationCount(), before);
    EXPECT_TRUE(std::isfinite(sum));
  });
}

TEST(DynamicsCache, TheCounterCountsHereAndInTheFramework) {
  const Model model(test_robots::lwrAllegro());
  long before = conformance::allocationCount();
  const Eigen::VectorXd heap = Eigen::VectorXd::Zero(1000);
  const std::vector<double> more(1000);
  EXPECT_GE(conformance::allocationCount(), before + 2) << heap.size() << more.size();
  before = conformance::allocationCount();
  const DynamicsCache cache(model);
  EXPECT_GE(conformance::allocationCount(), before + 7) << cache.dof();
}

}  // namespace
}  // namespace tactus::dynamics
