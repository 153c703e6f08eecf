#include <algorithm>
#include <array>
#include <vector>

#include "bench/peers/engine.h"
#include "tests/witness/mujoco/load.h"

namespace tactus::bench {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The problem's bodies as a robot: link 0 is the world, link i + 1 is body i, rotors are in its inertia.
description::Robot robotOf(const Problem& problem) {
  description::Robot robot;
  robot.name = problem.name;
  robot.links.emplace_back();
  for (const Body& body : problem.bodies) {
    description::Joint& joint = robot.joints.emplace_back();
    joint.name = body.name;
    joint.type = body.type;
    joint.parent = body.parent + 1;
    joint.child = static_cast<int>(robot.links.size());
    joint.origin = body.origin;
    description::Link& link = robot.links.emplace_back();
    link.name = body.name;
    link.has_inertial = true;
    link.mass = body.mass;
    link.centre_of_mass = body.centre_of_mass;
    link.inertia = body.inertia;
  }
  return robot;
}

/// MuJoCo: of its forward pipeline only the stages that an operation needs.  Its q, q̇ and free joint are those of
/// description::JointType.
class Mujoco : public Engine {
 public:
  explicit Mujoco(const Problem& problem)
      : problem_(problem),
        model_(witness::loadMujoco(robotOf(problem), problem.gravity_W)),
        data_(mj_makeData(model_.get())),
        vector_(model_->nv),
        M_(model_->nv, model_->nv),
        J_(3 * point_count, model_->nv) {
    for (int k = 0; k < point_count; ++k)
      bodies_[k] = mj_name2id(model_.get(), mjOBJ_BODY, problem.bodies[problem.points[k].body].name.c_str());
  }

  std::string name() const override { return std::string("MuJoCo ") + mj_versionString(); }
  bool offers(Operation operation) const override { return operation != Operation::cache_tick; }

  void run(Operation operation, int state) override {
    const mjModel* m = model_.get();
    mjData* d = data_.get();
    const State& s = problem_.states[state];
    std::copy_n(s.q.data(), m->nq, d->qpos);
    mj_kinematics(m, d);
    mj_comPos(m, d);
    switch (operation) {
      case Operation::rnea:
        std::copy_n(s.qd.data(), m->nv, d->qvel);
        std::copy_n(s.qdd.data(), m->nv, d->qacc);
        mj_comVel(m, d);
        return mj_rne(m, d, 1, vector_.data());
      case Operation::bias:
        std::copy_n(s.qd.data(), m->nv, d->qvel);
        mj_comVel(m, d);
        return mj_rne(m, d, 0, vector_.data());
      case Operation::mass_matrix:
        mj_crb(m, d);
        return mj_fullM(m, M_.data(), d->qM);
      case Operation::forward_dynamics:
        std::copy_n(s.qd.data(), m->nv, d->qvel);
        mj_crb(m, d);
        mj_factorM(m, d);
        mj_comVel(m, d);
        mj_rne(m, d, 0, d->qfrc_bias);
        for (int i = 0; i < m->nv; ++i) d->qfrc_smooth[i] = s.tau[i] - d->qfrc_bias[i];
        return mj_solveM(m, d, vector_.data(), d->qfrc_smooth, 1);
      case Operation::point_jacobians: return pointJacobians();
      case Operation::tick:
        std::copy_n(s.qd.data(), m->nv, d->qvel);
        mj_crb(m, d);
        mj_fullM(m, M_.data(), d->qM);
        mj_comVel(m, d);
        mj_rne(m, d, 0, vector_.data());
        return pointJacobians();
      case Operation::cache_tick: return;
    }
  }

  Results results(Operation operation, int) override {
    switch (operation) {
      case Operation::mass_matrix: return {{}, M_, {}};
      case Operation::point_jacobians: return {{}, {}, J_};
      case Operation::tick: return {vector_, M_, J_};
      default: return {vector_, {}, {}};
    }
  }

 private:
  void pointJacobians() {
    for (int k = 0; k < point_count; ++k)
      mj_jac(model_.get(), data_.get(), J_.data() + 3 * k * model_->nv, nullptr,
             problem_.points[k].position_W.data(), bodies_[k]);
  }

  const Problem& problem_;
  witness::MujocoModel model_;
  witness::MujocoData data_;
  std::array<int, point_count> bodies_;
  Eigen::VectorXd vector_;
  RowMajor M_, J_;
};

}  // namespace

/// None for a tree deeper than MuJoCo's XML reader goes: 100 elements, two of them around the bodies, one in the last.
std::unique_ptr<Engine> makeMujoco(const Problem& problem) {
  std::vector<int> depth;
  for (const Body& body : problem.bodies) depth.push_back(body.parent < 0 ? 1 : depth[body.parent] + 1);
  if (*std::ranges::max_element(depth) > 97) return nullptr;
  return std::make_unique<Mujoco>(problem);
}

}  // namespace tactus::bench
