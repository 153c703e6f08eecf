#include "bench/peers/coordinates.h"

#include <gtest/gtest.h>

#include "tests/dynamics/robots.h"

// The change of coordinates between engines, checked where it could hide an error: against finite differences.
namespace tactus::bench {
namespace {

class FloatingBases : public testing::TestWithParam<FloatingBase> {};

/// The state after `time` with q̈ = 0.
State coasted(State state, double time) {
  const Eigen::Vector3d w_B = state.qd.segment<3>(3);
  const Eigen::Quaterniond before(state.q[3], state.q[4], state.q[5], state.q[6]);
  const Eigen::Quaterniond after = before * Eigen::AngleAxisd(w_B.norm() * time, w_B.normalized());
  state.q.head<3>() += time * state.qd.head<3>();
  state.q.segment<4>(3) << after.w(), after.vec();
  state.q.tail(state.q.size() - 7) += time * state.qd.tail(state.qd.size() - 6);
  return state;
}

TEST_P(FloatingBases, DriftIsTheRateOfThePeersSpeedsWithoutAcceleration) {
  const Problem problem("humanoid", test_robots::humanoid());
  std::vector<int> first_speed;
  for (const Body& body : problem.bodies) first_speed.push_back(body.coordinate);
  const State& state = problem.states[0];
  const auto speeds = [&](double time) -> Eigen::VectorXd {
    return Coordinates(problem, coasted(state, time), first_speed, GetParam()).T * state.qd;
  };
  const double h = 1e-5;
  const Eigen::VectorXd rate = (speeds(h) - speeds(-h)) / (2 * h);
  const Eigen::VectorXd drift = Coordinates(problem, state, first_speed, GetParam()).drift;
  EXPECT_LT((rate - drift).cwiseAbs().maxCoeff(), 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Both, FloatingBases, testing::Values(FloatingBase::body_axes, FloatingBase::world_axes));

TEST(Coordinates, SpeedsOfJointsAreReordered) {
  const Problem problem("chain", test_robots::chain(3));
  const Coordinates coordinates(problem, problem.states[0], {2, 0, 1}, FloatingBase::body_axes);
  const Eigen::Vector3d qd(1, 2, 3), u(2, 3, 1);
  EXPECT_EQ(coordinates.T * qd, u);
  const Results peer{u, {}, {}};
  EXPECT_EQ(coordinates.toOurs(Operation::rnea, peer, {}).vector, qd);
  EXPECT_EQ(coordinates.toOurs(Operation::forward_dynamics, peer, {}).vector, qd);
}

}  // namespace
}  // namespace tactus::bench
