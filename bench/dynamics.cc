#include <benchmark/benchmark.h>

#include <array>

#include "framework/dynamics/aba.h"
#include "framework/dynamics/cholesky.h"
#include "framework/dynamics/crba.h"
#include "framework/dynamics/dynamics_cache.h"
#include "framework/dynamics/rnea.h"
#include "tests/dynamics/robots.h"

// Rigid-body dynamics of the arm with hand, 23 degrees of freedom.  64 random states are cycled, so that no branch and
// no cache line is learnt by heart.  Points: four fingers, three links each.
namespace tactus::dynamics {
namespace {

struct Setup {
  static constexpr int states = 64;

  Setup() {
    test_robots::Random random(1);
    for (int k = 0; k < states; ++k) {
      q.push_back(test_robots::uniformVector(random, model.dof(), 3));
      qd.push_back(test_robots::uniformVector(random, model.dof(), 2));
      qdd.push_back(test_robots::uniformVector(random, model.dof(), 5));
      tau.push_back(test_robots::uniformVector(random, model.dof(), 5));
    }
    int count = 0;
    for (const std::string finger : {"index_", "middle_", "ring_", "thumb_"}) {
      for (const std::string link : {"1", "2", "tip"}) {
        frames[count] = model.frameIndex(finger + link);
        points_W[count++] = test_robots::uniformVector3(random, 1);
      }
    }
  }
  int next() { return state = (state + 1) % states; }

  Model model{test_robots::lwrAllegro()};
  Workspace workspace{model};
  Eigen::Vector3d gravity_W{0, 0, -9.81};
  std::vector<Eigen::VectorXd> q, qd, qdd, tau;
  std::array<int, 12> frames;
  std::array<Eigen::Vector3d, 12> points_W;
  Eigen::VectorXd out{Eigen::VectorXd::Zero(model.dof())};
  Eigen::MatrixXd M{Eigen::MatrixXd::Zero(model.dof(), model.dof())}, L{M}, J{Eigen::MatrixXd::Zero(36, model.dof())};
  int state = 0;
};

void rneaOnly(benchmark::State& run) {
  Setup s;
  for (auto _ : run) {
    const int k = s.next();
    rnea(s.model, s.q[k], s.qd[k], s.qdd[k], s.gravity_W, s.workspace, s.out);
    benchmark::DoNotOptimize(s.out.data());
  }
}
BENCHMARK(rneaOnly)->Name("rnea");

void biasOnly(benchmark::State& run) {
  Setup s;
  for (auto _ : run) {
    const int k = s.next();
    nonlinearEffects(s.model, s.q[k], s.qd[k], s.gravity_W, s.workspace, s.out);
    benchmark::DoNotOptimize(s.out.data());
  }
}
BENCHMARK(biasOnly)->Name("bias");

void crbaOnly(benchmark::State& run) {
  Setup s;
  for (auto _ : run) {
    crba(s.model, s.q[s.next()], s.workspace, s.M);
    benchmark::DoNotOptimize(s.M.data());
  }
}
BENCHMARK(crbaOnly)->Name("crba");

void abaOnly(benchmark::State& run) {
  Setup s;
  for (auto _ : run) {
    const int k = s.next();
    aba(s.model, s.q[k], s.qd[k], s.tau[k], s.gravity_W, s.workspace, s.out);
    benchmark::DoNotOptimize(s.out.data());
  }
}
BENCHMARK(abaOnly)->Name("aba");

void kinematicsOnly(benchmark::State& run) {
  Setup s;
  for (auto _ : run) {
    forwardKinematics(s.model, s.q[s.next()], s.workspace);
    benchmark::DoNotOptimize(s.workspace.bodies.data());
  }
}
BENCHMARK(kinematicsOnly)->Name("forward kinematics");

/// From q, kinematics included.
void twelvePointJacobians(benchmark::State& run) {
  Setup s;
  for (auto _ : run) {
    forwardKinematics(s.model, s.q[s.next()], s.workspace);
    for (int c = 0; c < 12; ++c) {
      pointJacobian(s.model, s.workspace, s.frames[c], s.points_W[c], s.J.middleRows<3>(3 * c));
    }
    benchmark::DoNotOptimize(s.J.data());
  }
}
BENCHMARK(twelvePointJacobians)->Name("12 point Jacobians");

void choleskyOnly(benchmark::State& run) {
  Setup s;
  crba(s.model, s.q[0], s.workspace, s.M);
  for (auto _ : run) {
    choleskyFactor(s.M, s.L);
    benchmark::DoNotOptimize(s.L.data());
  }
}
BENCHMARK(choleskyOnly)->Name("Cholesky factor");

/// M, its factor, b + g and g: what every tick takes.
void cacheUpdate(benchmark::State& run) {
  Setup s;
  DynamicsCache cache(s.model, s.gravity_W);
  for (auto _ : run) {
    const int k = s.next();
    cache.update(s.q[k], s.qd[k]);
    benchmark::DoNotOptimize(&cache);
  }
}
BENCHMARK(cacheUpdate)->Name("cache update");

void tickSet(benchmark::State& run) {
  Setup s;
  DynamicsCache cache(s.model, s.gravity_W);
  for (auto _ : run) {
    const int k = s.next();
    cache.update(s.q[k], s.qd[k]);
    for (int c = 0; c < 12; ++c) cache.pointJacobian(s.frames[c], s.points_W[c], s.J.middleRows<3>(3 * c));
    benchmark::DoNotOptimize(s.J.data());
  }
}
BENCHMARK(tickSet)->Name("tick set (cache update, 12 point Jacobians)");

}  // namespace
}  // namespace tactus::dynamics
