#include <array>

#include "bench/peers/engine.h"
#include "framework/dynamics/aba.h"
#include "framework/dynamics/crba.h"
#include "framework/dynamics/dynamics_cache.h"
#include "framework/dynamics/rnea.h"

namespace tactus::bench {
namespace {

using namespace dynamics;

/// This engine.  `tick` shares one sweep of kinematics, as DynamicsCache does, but leaves out what the peers' ticks do
/// not have: g alone and the factor of M.  `cache_tick` is DynamicsCache::update and the Jacobians.
class Tactus : public Engine {
 public:
  explicit Tactus(const Problem& problem) : problem_(problem), model_(problem.robot) {
    for (int k = 0; k < point_count; ++k) frames_[k] = model_.frameIndex(problem.points[k].link);
  }

  std::string name() const override { return "Tactus"; }
  bool offers(Operation) const override { return true; }

  void run(Operation operation, int state) override {
    const State& s = problem_.states[state];
    switch (operation) {
      case Operation::rnea: return rnea(model_, s.q, s.qd, s.qdd, problem_.gravity_W, workspace_, vector_);
      case Operation::bias: return nonlinearEffects(model_, s.q, s.qd, problem_.gravity_W, workspace_, vector_);
      case Operation::mass_matrix: return crba(model_, s.q, workspace_, M_);
      case Operation::forward_dynamics:
        return aba(model_, s.q, s.qd, s.tau, problem_.gravity_W, workspace_, vector_);
      case Operation::point_jacobians:
        forwardKinematics(model_, s.q, workspace_);
        return pointJacobians();
      case Operation::tick:
        forwardKinematics(model_, s.q, workspace_);
        forwardVelocities(model_, s.qd, workspace_);
        worldInertias(model_, workspace_);
        biasSweep(model_, problem_.gravity_W, workspace_, vector_);
        compositeInertias(model_, workspace_);
        massMatrixSweep(model_, workspace_, M_);
        return pointJacobians();
      case Operation::cache_tick:
        cache_.update(s.q, s.qd);
        for (int k = 0; k < point_count; ++k)
          cache_.pointJacobian(frames_[k], problem_.points[k].position_W, J_.middleRows<3>(3 * k));
        return;
    }
  }

  Results results(Operation operation, int) override {
    switch (operation) {
      case Operation::mass_matrix: return {{}, M_, {}};
      case Operation::point_jacobians: return {{}, {}, J_};
      case Operation::tick: return {vector_, M_, J_};
      case Operation::cache_tick: return {cache_.bias(), cache_.massMatrix(), J_};
      default: return {vector_, {}, {}};
    }
  }

 private:
  void pointJacobians() {
    for (int k = 0; k < point_count; ++k)
      pointJacobian(model_, workspace_, frames_[k], problem_.points[k].position_W, J_.middleRows<3>(3 * k));
  }

  const Problem& problem_;
  Model model_;
  Workspace workspace_{model_};
  DynamicsCache cache_{model_, problem_.gravity_W};
  std::array<int, point_count> frames_;
  Eigen::VectorXd vector_{Eigen::VectorXd::Zero(model_.dof())};
  Eigen::MatrixXd M_{Eigen::MatrixXd::Zero(model_.dof(), model_.dof())};
  Eigen::MatrixXd J_{Eigen::MatrixXd::Zero(3 * point_count, model_.dof())};
};

}  // namespace

std::unique_ptr<Engine> makeTactus(const Problem& problem) { return std::make_unique<Tactus>(problem); }

}  // namespace tactus::bench
