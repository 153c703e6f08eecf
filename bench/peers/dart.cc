#include <dart/config.hpp>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>

#include "bench/peers/coordinates.h"

namespace tactus::bench {
namespace {

namespace dd = dart::dynamics;

/// DART: it computes what is asked for when it is asked for; every setPositions makes it forget all.
class Dart : public Engine {
 public:
  explicit Dart(const Problem& problem) : problem_(problem) {
    skeleton_->setGravity(problem.gravity_W);
    for (const Body& body : problem.bodies) addBody(body);
    std::vector<int> first_speed;
    for (const dd::BodyNode* node : nodes_)
      first_speed.push_back(static_cast<int>(node->getParentJoint()->getIndexInSkeleton(0)));
    for (const State& s : problem.states) {
      const Coordinates coordinates(problem, s, first_speed, FloatingBase::body_axes);
      const Eigen::MatrixXd& T = coordinates.T;
      states_.push_back({positions(s, first_speed), T * s.qd, T * s.qdd + coordinates.drift,
                         T.transpose().partialPivLu().solve(s.tau), coordinates});
    }
  }

  std::string name() const override { return "DART " DART_VERSION; }
  bool offers(Operation operation) const override { return operation != Operation::cache_tick; }

  void run(Operation operation, int state) override {
    const Own& s = states_[state];
    skeleton_->setPositions(s.q);
    switch (operation) {
      case Operation::rnea:
        skeleton_->setVelocities(s.u);
        skeleton_->setAccelerations(s.udot);
        return skeleton_->computeInverseDynamics(false, false, false);
      case Operation::bias:
        skeleton_->setVelocities(s.u);
        skeleton_->getCoriolisAndGravityForces();
        return;
      case Operation::mass_matrix:
        skeleton_->getMassMatrix();
        return;
      case Operation::forward_dynamics:
        skeleton_->setVelocities(s.u);
        skeleton_->setForces(s.tau);
        return skeleton_->computeForwardDynamics();
      case Operation::point_jacobians: return pointJacobians();
      case Operation::tick:
        skeleton_->setVelocities(s.u);
        skeleton_->getMassMatrix();
        skeleton_->getCoriolisAndGravityForces();
        return pointJacobians();
      case Operation::cache_tick: return;
    }
  }

  Results results(Operation operation, int state) override {
    Results own;
    if (operation == Operation::rnea) own.vector = skeleton_->getForces();
    if (operation == Operation::forward_dynamics) own.vector = skeleton_->getAccelerations();
    if (operation == Operation::bias || operation == Operation::tick)
      own.vector = skeleton_->getCoriolisAndGravityForces();
    if (operation == Operation::mass_matrix || operation == Operation::tick)
      own.mass_matrix = skeleton_->getMassMatrix();
    if (operation == Operation::point_jacobians || operation == Operation::tick) own.jacobians = J_;
    return states_[state].coordinates.toOurs(operation, own, skeleton_->getMassMatrix());
  }

 private:
  struct Own {
    Eigen::VectorXd q, u, udot, tau;
    Coordinates coordinates;
  };

  void addBody(const Body& body) {
    dd::BodyNode* parent = body.parent < 0 ? nullptr : nodes_[body.parent];
    const dd::BodyNode::AspectProperties properties(body.name);
    // Named at once: DART reports every name that it has to change.
    if (body.type == description::JointType::floating) {
      dd::FreeJoint::Properties joint;
      joint.mName = body.name;
      nodes_.push_back(skeleton_->createJointAndBodyNodePair<dd::FreeJoint>(parent, joint, properties).second);
    } else {
      dd::RevoluteJoint::Properties joint;
      joint.mName = body.name;
      joint.mAxis = Eigen::Vector3d::UnitZ();
      nodes_.push_back(skeleton_->createJointAndBodyNodePair<dd::RevoluteJoint>(parent, joint, properties).second);
    }
    nodes_.back()->getParentJoint()->setTransformFromParentBodyNode(body.origin);
    nodes_.back()->setInertia(dd::Inertia(body.mass, body.centre_of_mass, body.inertia));
  }

  Eigen::VectorXd positions(const State& state, const std::vector<int>& first) const {
    Eigen::VectorXd q(problem_.dof);
    for (size_t i = 0; i < problem_.bodies.size(); ++i) {
      const Body& body = problem_.bodies[i];
      if (body.type == description::JointType::floating) {
        const auto wxyz = state.q.segment<4>(body.position + 3);
        Eigen::Isometry3d pose(Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]));
        pose.translation() = state.q.segment<3>(body.position);
        q.segment<6>(first[i]) = dd::FreeJoint::convertToPositions(pose);
      } else {
        q[first[i]] = state.q[body.position];
      }
    }
    return q;
  }

  void pointJacobians() {
    for (int k = 0; k < point_count; ++k) {
      const Point& point = problem_.points[k];
      const dd::BodyNode* node = nodes_[point.body];
      const Eigen::Vector3d point_B = node->getTransform().inverse() * point.position_W;
      J_.middleRows<3>(3 * k) = skeleton_->getLinearJacobian(node, point_B);
    }
  }

  const Problem& problem_;
  dd::SkeletonPtr skeleton_ = dd::Skeleton::create("robot");
  std::vector<dd::BodyNode*> nodes_;                               // by body
  std::vector<Own> states_;
  Eigen::MatrixXd J_{Eigen::MatrixXd::Zero(3 * point_count, problem_.dof)};
};

}  // namespace

std::unique_ptr<Engine> makeDart(const Problem& problem) { return std::make_unique<Dart>(problem); }

}  // namespace tactus::bench
