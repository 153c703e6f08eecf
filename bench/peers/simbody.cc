#include "bench/peers/coordinates.h"
#include "sim/simtk_eigen.h"

namespace tactus::bench {
namespace {

SimTK::Vector toSimTK(const Eigen::VectorXd& v) { return SimTK::Vector(static_cast<int>(v.size()), v.data()); }

Eigen::VectorXd toEigen(const SimTK::Vector& v) { return sim::toEigen(v); }

Eigen::MatrixXd toEigen(const SimTK::Matrix& m) {
  return Eigen::MatrixXd::NullaryExpr(m.nrow(), m.ncol(), [&](Eigen::Index i, Eigen::Index j) {
    return m(static_cast<int>(i), static_cast<int>(j));
  });
}

SimTK::MassProperties massProperties(const Body& body) {
  const Eigen::Vector3d& c = body.centre_of_mass;
  const Eigen::Matrix3d I =                                        // about the origin
      body.inertia + body.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  return {body.mass, sim::toSimTK(c),
          SimTK::Inertia(SimTK::SymMat33(I(0, 0), I(1, 0), I(1, 1), I(2, 0), I(2, 1), I(2, 2)))};
}

/// Simbody: the matter subsystem alone, weights as body forces, realized no further than an operation needs.
class Simbody : public Engine {
 public:
  explicit Simbody(const Problem& problem) : problem_(problem) {
    matter_.setShowDefaultGeometry(false);
    for (const Body& body : problem.bodies) addBody(body);
    state_ = system_.realizeTopology();
    system_.realizeModel(state_);
    std::vector<int> first_speed;
    for (const SimTK::MobilizedBodyIndex index : bodies_)
      first_speed.push_back(matter_.getMobilizedBody(index).getFirstUIndex(state_));
    for (const State& s : problem.states) {
      const Coordinates coordinates(problem, s, first_speed, FloatingBase::world_axes);
      const Eigen::MatrixXd& T = coordinates.T;
      states_.push_back({positions(s), toSimTK(T * s.qd), toSimTK(T * s.qdd + coordinates.drift),
                         toSimTK(T.transpose().partialPivLu().solve(s.tau)), coordinates});
    }
    for (const Point& point : problem.points) touched_.push_back(bodies_[point.body]);
    stations_.resize(point_count);
    weights_.resize(matter_.getNumBodies());
    zero_.resize(problem.dof);
    zero_ = 0;
  }

  std::string name() const override { return "Simbody 3.7"; }
  bool offers(Operation operation) const override { return operation != Operation::cache_tick; }

  void run(Operation operation, int state) override {
    const Own& s = states_[state];
    state_.updQ() = s.q;
    if (operation != Operation::mass_matrix && operation != Operation::point_jacobians) state_.updU() = s.u;
    switch (operation) {
      case Operation::rnea:
        system_.realize(state_, SimTK::Stage::Velocity);
        return inverseDynamics(s.udot);
      case Operation::bias:
        system_.realize(state_, SimTK::Stage::Velocity);
        return inverseDynamics(zero_);
      case Operation::mass_matrix:
        system_.realize(state_, SimTK::Stage::Position);
        return matter_.calcM(state_, M_);
      case Operation::forward_dynamics:
        system_.realize(state_, SimTK::Stage::Dynamics);
        updateWeights();
        return matter_.calcAccelerationIgnoringConstraints(state_, s.tau, weights_, vector_, accelerations_);
      case Operation::point_jacobians:
        system_.realize(state_, SimTK::Stage::Position);
        return pointJacobians();
      case Operation::tick:
        system_.realize(state_, SimTK::Stage::Velocity);
        matter_.calcM(state_, M_);
        inverseDynamics(zero_);
        return pointJacobians();
      case Operation::cache_tick: return;
    }
  }

  Results results(Operation operation, int state) override {
    Results own;
    const bool is_tick = operation == Operation::tick;
    if (operation == Operation::mass_matrix || is_tick) own.mass_matrix = toEigen(M_);
    if (operation == Operation::point_jacobians || is_tick) own.jacobians = toEigen(J_);
    if (own.mass_matrix.size() + own.jacobians.size() == 0 || is_tick) own.vector = toEigen(vector_);
    SimTK::Matrix M;
    matter_.calcM(state_, M);
    return states_[state].coordinates.toOurs(operation, own, toEigen(M));
  }

 private:
  struct Own {
    SimTK::Vector q, u, udot, tau;
    Coordinates coordinates;
  };

  void addBody(const Body& body) {
    SimTK::MobilizedBody& parent =
        body.parent < 0 ? matter_.updGround() : matter_.updMobilizedBody(bodies_[body.parent]);
    const SimTK::Body::Rigid rigid(massProperties(body));
    const SimTK::Transform origin = sim::toSimTK(body.origin);
    if (body.type == description::JointType::floating)
      bodies_.push_back(SimTK::MobilizedBody::Free(parent, origin, rigid, SimTK::Transform()).getMobilizedBodyIndex());
    else
      bodies_.push_back(SimTK::MobilizedBody::Pin(parent, origin, rigid, SimTK::Transform()).getMobilizedBodyIndex());
  }

  SimTK::Vector positions(const State& state) const {
    SimTK::Vector q(state_.getNQ());
    for (size_t i = 0; i < problem_.bodies.size(); ++i) {
      const Body& body = problem_.bodies[i];
      const int first = matter_.getMobilizedBody(bodies_[i]).getFirstQIndex(state_);
      if (body.type == description::JointType::floating) {
        for (int k = 0; k < 4; ++k) q[first + k] = state.q[body.position + 3 + k];
        for (int k = 0; k < 3; ++k) q[first + 4 + k] = state.q[body.position + k];
      } else {
        q[first] = state.q[body.position];
      }
    }
    return q;
  }

  void updateWeights() {
    weights_[0] = SimTK::SpatialVec(SimTK::Vec3(0), SimTK::Vec3(0));
    for (size_t i = 0; i < bodies_.size(); ++i) {
      const SimTK::MobilizedBody& body = matter_.getMobilizedBody(bodies_[i]);
      const SimTK::MassProperties& mass = body.getBodyMassProperties(state_);
      const SimTK::Vec3 weight = mass.getMass() * sim::toSimTK(problem_.gravity_W);
      weights_[bodies_[i]] =
          SimTK::SpatialVec((body.getBodyRotation(state_) * mass.getMassCenter()) % weight, weight);
    }
  }

  void inverseDynamics(const SimTK::Vector& udot) {
    updateWeights();
    matter_.calcResidualForceIgnoringConstraints(state_, zero_, weights_, udot, vector_);
  }

  void pointJacobians() {
    for (int k = 0; k < point_count; ++k)
      stations_[k] = matter_.getMobilizedBody(touched_[k])
                         .findStationAtGroundPoint(state_, sim::toSimTK(problem_.points[k].position_W));
    matter_.calcStationJacobian(state_, touched_, stations_, J_);
  }

  const Problem& problem_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::State state_;
  std::vector<SimTK::MobilizedBodyIndex> bodies_;                  // by body
  std::vector<Own> states_;
  SimTK::Array_<SimTK::MobilizedBodyIndex> touched_;
  SimTK::Array_<SimTK::Vec3> stations_;
  SimTK::Vector_<SimTK::SpatialVec> weights_, accelerations_;
  SimTK::Vector zero_, vector_;
  SimTK::Matrix M_, J_;
};

}  // namespace

std::unique_ptr<Engine> makeSimbody(const Problem& problem) { return std::make_unique<Simbody>(problem); }

}  // namespace tactus::bench
