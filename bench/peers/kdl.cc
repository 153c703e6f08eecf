#include <kdl/chaindynparam.hpp>
#include <kdl/chainfdsolver_recursive_newton_euler.hpp>
#include <kdl/config.h>
#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#include <kdl/treejnttojacsolver.hpp>

#include <optional>

#include "bench/peers/engine.h"

namespace tactus::bench {
namespace {

KDL::Vector toKdl(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
KDL::Rotation toKdl(const Eigen::Matrix3d& R) {
  return {toKdl(Eigen::Vector3d(R.col(0))), toKdl(Eigen::Vector3d(R.col(1))), toKdl(Eigen::Vector3d(R.col(2)))};
}

KDL::JntArray toKdl(const Eigen::VectorXd& v) {
  KDL::JntArray array(v.size());
  array.data = v;
  return array;
}

KDL::Segment segment(const Body& body) {
  const KDL::Vector p = toKdl(Eigen::Vector3d(body.origin.translation()));
  const KDL::Frame pose(toKdl(Eigen::Matrix3d(body.origin.linear())), p);
  const Eigen::Matrix3d& I = body.inertia;
  const KDL::RigidBodyInertia inertia(
      body.mass, toKdl(body.centre_of_mass),
      KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)));
  const KDL::Joint joint(body.name, p, pose.M * KDL::Vector(0, 0, 1), KDL::Joint::RotAxis);
  return KDL::Segment(body.name, joint, pose, inertia);
}

/// Orocos KDL.  Trees have inverse dynamics and Jacobians; serial chains the mass matrix and forward dynamics too.
/// Jacobians are of the origins of bodies and then moved to the points: the way there is found beforehand.
class Kdl : public Engine {
 public:
  explicit Kdl(const Problem& problem)
      : problem_(problem), tree_(makeTree(problem)), zero_(problem.dof), vector_(problem.dof), M_(problem.dof) {
    const KDL::Vector gravity = toKdl(problem.gravity_W);
    inverse_dynamics_.emplace(tree_, gravity);
    jacobian_solver_.emplace(tree_);
    tree_.getChain("root", problem.bodies.back().name, chain_);
    is_chain_ = static_cast<int>(chain_.getNrOfJoints()) == problem.dof;
    if (is_chain_) {
      chain_dynamics_.emplace(chain_, gravity);
      forward_dynamics_.emplace(chain_, gravity);
      no_wrenches_.assign(chain_.getNrOfSegments(), KDL::Wrench::Zero());
    }
    KDL::TreeFkSolverPos_recursive kinematics(tree_);
    for (const State& s : problem.states) {
      Own own{toKdl(s.q), toKdl(s.qd), toKdl(s.qdd), toKdl(s.tau), {}};
      for (const Point& point : problem.points) {
        KDL::Frame pose;
        kinematics.JntToCart(own.q, pose, problem.bodies[point.body].name);
        own.from_origin.push_back(toKdl(point.position_W) - pose.p);
      }
      states_.push_back(own);
    }
    jacobians_.assign(point_count, KDL::Jacobian(problem.dof));
  }

  std::string name() const override { return "KDL " KDL_VERSION_STRING; }
  bool offers(Operation operation) const override {
    if (operation == Operation::cache_tick) return false;
    return is_chain_ || operation == Operation::rnea || operation == Operation::bias ||
           operation == Operation::point_jacobians;
  }

  void run(Operation operation, int state) override {
    const Own& s = states_[state];
    switch (operation) {
      case Operation::rnea:
        inverse_dynamics_->CartToJnt(s.q, s.qd, s.qdd, {}, vector_);
        return;
      case Operation::bias:
        inverse_dynamics_->CartToJnt(s.q, s.qd, zero_, {}, vector_);
        return;
      case Operation::mass_matrix:
        chain_dynamics_->JntToMass(s.q, M_);
        return;
      case Operation::forward_dynamics:
        forward_dynamics_->CartToJnt(s.q, s.qd, s.tau, no_wrenches_, vector_);
        return;
      case Operation::point_jacobians: return pointJacobians(s);
      case Operation::tick:
        chain_dynamics_->JntToMass(s.q, M_);
        inverse_dynamics_->CartToJnt(s.q, s.qd, zero_, {}, vector_);
        return pointJacobians(s);
      case Operation::cache_tick: return;
    }
  }

  Results results(Operation operation, int) override {
    Eigen::MatrixXd J(3 * point_count, problem_.dof);
    for (int k = 0; k < point_count; ++k) J.middleRows<3>(3 * k) = jacobians_[k].data.topRows<3>();
    switch (operation) {
      case Operation::mass_matrix: return {{}, M_.data, {}};
      case Operation::point_jacobians: return {{}, {}, J};
      case Operation::tick: return {vector_.data, M_.data, J};
      default: return {vector_.data, {}, {}};
    }
  }

 private:
  struct Own {
    KDL::JntArray q, qd, qdd, tau;
    std::vector<KDL::Vector> from_origin;                          ///< of its body to each point
  };

  static KDL::Tree makeTree(const Problem& problem) {
    KDL::Tree tree("root");
    for (const Body& body : problem.bodies)
      tree.addSegment(segment(body), body.parent < 0 ? "root" : problem.bodies[body.parent].name);
    return tree;
  }

  void pointJacobians(const Own& s) {
    for (int k = 0; k < point_count; ++k) {
      jacobian_solver_->JntToJac(s.q, jacobians_[k], problem_.bodies[problem_.points[k].body].name);
      jacobians_[k].changeRefPoint(s.from_origin[k]);
    }
  }

  const Problem& problem_;
  KDL::Tree tree_;
  KDL::Chain chain_;                                               // its solvers keep a reference
  bool is_chain_ = false;
  std::optional<KDL::TreeIdSolver_RNE> inverse_dynamics_;
  std::optional<KDL::TreeJntToJacSolver> jacobian_solver_;
  std::optional<KDL::ChainDynParam> chain_dynamics_;
  std::optional<KDL::ChainFdSolver_RNE> forward_dynamics_;
  KDL::Wrenches no_wrenches_;
  std::vector<Own> states_;
  KDL::JntArray zero_, vector_;
  KDL::JntSpaceInertiaMatrix M_;
  std::vector<KDL::Jacobian> jacobians_;
};

}  // namespace

/// None for a floating base, which KDL does not have.
std::unique_ptr<Engine> makeKdl(const Problem& problem) {
  for (const Body& body : problem.bodies)
    if (body.type == description::JointType::floating) return nullptr;
  return std::make_unique<Kdl>(problem);
}

}  // namespace tactus::bench
