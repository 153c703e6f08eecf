// The own dynamics against Simbody, which builds the same descriptions on its own.
//
// Strategy: thousands of random states of the arm with the hand, as the program reads it, of a humanoid, and of random
// trees of 1 to 100 degrees of freedom with joints of every kind.  Simbody has no couplings that eliminate coordinates:
// where joints drive others, its tree moves every joint on its own and is projected onto q̇ by the constant matrix G of
// the couplings, as M = Gᵀ M_tree G.  Every quantity to 1e-9 of its greatest entry; the worst ones are printed.  The
// articulated-body algorithm is not tried on coupled robots.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "dsl/read_robot.h"
#include "framework/dynamics/aba.h"
#include "framework/dynamics/dynamics_cache.h"
#include "framework/dynamics/rnea.h"
#include "sim/simbody_robot.h"
#include "tests/dynamics/random_state.h"
#include "tests/dynamics/worst_errors.h"

namespace tactus {
namespace {

using dynamics::relativeError;
using dynamics::WorstErrors;
using test_robots::Random;

constexpr double tolerance = 1e-9;
// Simbody's recursion of forward dynamics is off by as much from its own mass matrix in some trees.
constexpr double recursion_tolerance = 1e-8;

Eigen::MatrixXd toEigen(const SimTK::Matrix& matrix) {
  Eigen::MatrixXd m(matrix.nrow(), matrix.ncol());
  for (int i = 0; i < m.rows(); ++i)
    for (int j = 0; j < m.cols(); ++j) m(i, j) = matrix(i, j);
  return m;
}

/// Simbody's 6-vectors and 6-row blocks have the angular part first, the framework's the linear part.
Eigen::MatrixXd linearFirst(const Eigen::MatrixXd& angular_first) {
  Eigen::MatrixXd m(angular_first.rows(), angular_first.cols());
  m << angular_first.bottomRows(3), angular_first.topRows(3);
  return m;
}

/// From the coordinates of a robot to those of the same tree with every joint moving on its own:
/// q̇_tree = G q̇, and q_tree is q with ratio · q_driver + offset for the driven joints.
class Coupling {
 public:
  /// `tree_joints`: all that move, in the order of q_tree.
  Coupling(const description::Robot& robot, const std::vector<int>& tree_joints) {
    std::map<int, std::pair<int, int>> own;                        // by joint: places in q and q̇
    int position = 0, coordinate = 0;
    for (const int j : robot.movingJoints()) {
      own[j] = {position, coordinate};
      position += description::positionCount(robot.joints[j].type);
      coordinate += description::velocityCount(robot.joints[j].type);
    }
    int rows = 0;
    for (const int j : tree_joints) rows += description::velocityCount(robot.joints[j].type);
    G_ = Eigen::MatrixXd::Zero(rows, coordinate);
    int row = 0;
    for (const int j : tree_joints) {
      Part part;
      int driver = j;
      for (; robot.joints[driver].mimic; driver = robot.joints[driver].mimic->driver) {
        part.offset += part.ratio * robot.joints[driver].mimic->offset;
        part.ratio *= robot.joints[driver].mimic->multiplier;
      }
      part.from = own.at(driver).first;
      part.count = description::positionCount(robot.joints[j].type);
      parts_.push_back(part);
      const int count = description::velocityCount(robot.joints[j].type);
      G_.block(row, own.at(driver).second, count, count).diagonal().setConstant(part.ratio);
      row += count;
    }
  }

  const Eigen::MatrixXd& G() const { return G_; }
  Eigen::VectorXd treePositions(const Eigen::VectorXd& q) const {
    std::vector<double> tree;
    for (const Part& part : parts_)
      for (int k = 0; k < part.count; ++k) tree.push_back(part.ratio * q[part.from + k] + part.offset);
    return Eigen::Map<const Eigen::VectorXd>(tree.data(), tree.size());
  }

 private:
  struct Part {
    int from = 0, count = 1;
    double ratio = 1, offset = 0;
  };
  Eigen::MatrixXd G_;
  std::vector<Part> parts_;
};

/// The same robot in both engines.
class BothEngines {
 public:
  BothEngines(const description::Robot& robot, const Eigen::Vector3d& gravity_W)
      : BothEngines(robot, robot, gravity_W) {}
  BothEngines(const description::Robot& own, const description::Robot& simbody, const Eigen::Vector3d& gravity_W)
      : gravity_W_(gravity_W),
        model_(own),
        cache_(model_, gravity_W),
        workspace_(model_),
        simbody_(simbody, gravity_W),
        coupling_(simbody, simbody_.joints()),
        state_(simbody_.defaultState()) {}

  int dof() const { return model_.dof(); }
  const dynamics::Model& model() const { return model_; }

  void set(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    cache_.update(q, qd);
    q_tree_ = coupling_.treePositions(q);
    simbody_.coordinates().setState(matter(), q_tree_, coupling_.G() * qd, state_);
    simbody_.system().realize(state_, SimTK::Stage::Velocity);
    simbody_.system().realize(state_, SimTK::Stage::Dynamics);
    simbody_.gravityForces(state_, weights_);
    speeds_ = simbody_.coordinates().speedMatrix(matter(), state_) * coupling_.G();
  }

  double massMatrixError() const { return relativeError(cache_.massMatrix(), simbodyMassMatrix()); }
  double biasError() const {
    return relativeError(cache_.bias(), simbodyTorque(Eigen::VectorXd::Zero(dof())));
  }
  double gravityError() const {
    SimTK::Vector pull;
    matter().multiplyBySystemJacobianTranspose(state_, weights_, pull);
    return relativeError(-cache_.gravityTorque(), speeds_.transpose() * sim::toEigen(std::as_const(pull)), 1e-3);
  }
  double inverseDynamicsError(const Eigen::VectorXd& qdd) {
    Eigen::VectorXd torque(dof());
    dynamics::rnea(model_, cache_.q(), cache_.qd(), qdd, gravity_W_, workspace_, torque);
    return relativeError(torque, simbodyTorque(qdd));
  }
  /// Against M q̈ = τ − b − g with Simbody's M, b and g, solved with more digits than the condition of M can cost.
  double forwardDynamicsError(const Eigen::VectorXd& torque) {
    using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
    const Matrix M = simbodyMassMatrix().cast<long double>();
    const Matrix load = (torque - simbodyTorque(Eigen::VectorXd::Zero(dof()))).cast<long double>();
    return relativeError(forwardDynamics(torque), M.llt().solve(load).cast<double>());
  }
  /// Against Simbody's recursion.  Of a robot without couplings, where the matrix between q̇ and u is orthogonal.
  double recursiveForwardDynamicsError(const Eigen::VectorXd& torque) {
    SimTK::Vector forces(dof(), 0.0), udot;
    SimTK::Vector_<SimTK::SpatialVec> accelerations;
    sim::toEigen(forces) = speeds_ * torque;
    matter().calcAccelerationIgnoringConstraints(state_, forces, weights_, udot, accelerations);
    return relativeError(forwardDynamics(torque), speeds_.transpose() * sim::toEigen(std::as_const(udot)));
  }
  /// dq/dt, of a robot without couplings.
  double positionRatesError() const {
    Eigen::VectorXd rates(model_.positionCount());
    dynamics::positionRates(model_, cache_.q(), cache_.qd(), rates);
    return relativeError(rates, simbody_.coordinates().positions(matter(), state_, state_.getQDot()));
  }
  double poseError(int link) const {
    const SimTK::Transform X_WL = carrier(link).getBodyTransform(state_) * sim::toSimTK(simbody_.poseInCarrier(link));
    const Eigen::Isometry3d own = cache_.framePose(link);
    return std::max(relativeError(own.linear(), sim::toEigen(X_WL.R()), 1),
                    relativeError(own.translation(), sim::toEigen(X_WL.p()), 1));
  }
  double frameJacobianError(int link) const {
    SimTK::Matrix J;
    matter().calcFrameJacobian(state_, carrier(link).getMobilizedBodyIndex(), origin(link), J);
    Eigen::MatrixXd own(6, dof());
    cache_.frameJacobian(link, own);
    return relativeError(own, linearFirst(toEigen(J)) * speeds_, 1);
  }
  double pointJacobianError(int link, const Eigen::Vector3d& point_W) const {
    SimTK::Matrix J;
    matter().calcStationJacobian(state_, carrier(link).getMobilizedBodyIndex(), station(link, point_W), J);
    Eigen::MatrixXd own(3, dof());
    cache_.pointJacobian(link, point_W, own);
    return relativeError(own, toEigen(J) * speeds_, 1);
  }
  double frameAccelerationBiasError(int link) const {
    const SimTK::SpatialVec bias =
        matter().calcBiasForFrameJacobian(state_, carrier(link).getMobilizedBodyIndex(), origin(link));
    Eigen::Matrix<double, 6, 1> linear_first;
    linear_first << sim::toEigen(bias[1]), sim::toEigen(bias[0]);
    return relativeError(cache_.frameAccelerationBias(link), linear_first, 1);
  }
  double pointAccelerationBiasError(int link, const Eigen::Vector3d& point_W) const {
    const SimTK::Vec3 bias = matter().calcBiasForStationJacobian(state_, carrier(link).getMobilizedBodyIndex(),
                                                                 station(link, point_W));
    return relativeError(cache_.pointAccelerationBias(link, point_W), sim::toEigen(bias), 1);
  }
  double stateError() const {
    return relativeError(q_tree_, simbody_.coordinates().positions(matter(), state_, state_.getQ()));
  }

 private:
  Eigen::VectorXd forwardDynamics(const Eigen::VectorXd& torque) {
    Eigen::VectorXd qdd(dof());
    dynamics::aba(model_, cache_.q(), cache_.qd(), torque, gravity_W_, workspace_, qdd);
    return qdd;
  }
  Eigen::MatrixXd simbodyMassMatrix() const {
    SimTK::Matrix M;
    matter().calcM(state_, M);
    return speeds_.transpose() * toEigen(M) * speeds_;
  }
  const SimTK::SimbodyMatterSubsystem& matter() const { return simbody_.matter(); }
  const SimTK::MobilizedBody& carrier(int link) const { return simbody_.carrier(link); }
  SimTK::Vec3 origin(int link) const {
    return sim::toSimTK(Eigen::Vector3d(simbody_.poseInCarrier(link).translation()));
  }
  SimTK::Vec3 station(int link, const Eigen::Vector3d& point_W) const {
    return carrier(link).findStationAtGroundPoint(state_, sim::toSimTK(point_W));
  }
  /// Simbody's inverse dynamics.
  Eigen::VectorXd simbodyTorque(const Eigen::VectorXd& qdd) const {
    SimTK::Vector udot(static_cast<int>(speeds_.rows()), 0.0), forces;
    sim::toEigen(udot) = speeds_ * qdd;
    matter().calcResidualForceIgnoringConstraints(state_, SimTK::Vector(), weights_, udot, forces);
    return speeds_.transpose() * sim::toEigen(std::as_const(forces));
  }

  Eigen::Vector3d gravity_W_;
  dynamics::Model model_;
  dynamics::DynamicsCache cache_;
  dynamics::Workspace workspace_;
  sim::SimbodyRobot simbody_;
  Coupling coupling_;
  SimTK::State state_;
  SimTK::Vector_<SimTK::SpatialVec> weights_;
  Eigen::VectorXd q_tree_;
  Eigen::MatrixXd speeds_;                                         // u = speeds q̇, of Simbody's tree
};

/// Compares everything in one random state; one random point of every link.
void compare(BothEngines& engines, Random& random, WorstErrors& errors) {
  const int n = engines.dof();
  engines.set(dynamics::randomConfiguration(engines.model(), random), test_robots::uniformVector(random, n, 2));
  errors.beginState();
  errors.check("mass matrix", engines.massMatrixError());
  errors.check("bias", engines.biasError());
  errors.check("gravity torque", engines.gravityError());
  errors.check("inverse dynamics", engines.inverseDynamicsError(test_robots::uniformVector(random, n, 5)));
  errors.check("positions there and back", engines.stateError());
  if (!engines.model().coupled()) {
    const Eigen::VectorXd torque = test_robots::uniformVector(random, n, 10);
    errors.check("forward dynamics", engines.forwardDynamicsError(torque));
    errors.check("the same, recursive", engines.recursiveForwardDynamicsError(torque), recursion_tolerance);
    errors.check("rates of positions", engines.positionRatesError());
  }
  for (int link = 0; link < static_cast<int>(engines.model().frames().size()); ++link) {
    SCOPED_TRACE("link '" + engines.model().frames()[link].name + "'");
    const Eigen::Vector3d point_W = test_robots::uniformVector3(random, 1);
    errors.check("pose", engines.poseError(link));
    errors.check("frame Jacobian", engines.frameJacobianError(link));
    errors.check("point Jacobian", engines.pointJacobianError(link, point_W));
    errors.check("frame acceleration bias", engines.frameAccelerationBiasError(link));
    errors.check("point acceleration bias", engines.pointAccelerationBiasError(link, point_W));
  }
}

/// Compares `states` random states of one robot.
void compareStates(const description::Robot& robot, const Eigen::Vector3d& gravity_W, int states, Random& random,
                   WorstErrors& errors) {
  BothEngines engines(robot, gravity_W);
  for (int trial = 0; trial < states && !::testing::Test::HasFailure(); ++trial) {
    SCOPED_TRACE("state " + std::to_string(trial));
    compare(engines, random, errors);
  }
}

description::Robot lwrAllegro() {
  std::vector<dsl::Diagnostic> warnings;
  return dsl::readRobot(std::string(TACTUS_SOURCE_DIR) + "/models/lwr_allegro.urdf", warnings);
}

TEST(DynamicsAgainstSimbody, ArmWithHandIn1000States) {
  Random random(1);
  WorstErrors errors("arm with hand", tolerance);
  ASSERT_EQ(dynamics::Model(lwrAllegro()).dof(), 23);
  compareStates(lwrAllegro(), {0, 0, -9.81}, 1000, random, errors);
}

TEST(DynamicsAgainstSimbody, HumanoidIn1000States) {
  Random random(2);
  WorstErrors errors("humanoid of 36 degrees of freedom", tolerance);
  ASSERT_EQ(dynamics::Model(test_robots::humanoid()).dof(), 36);
  compareStates(test_robots::humanoid(), {0, 0, -9.81}, 1000, random, errors);
}

TEST(DynamicsAgainstSimbody, RandomTreesOf1To100DegreesOfFreedomIn2000States) {
  Random random(3);
  WorstErrors errors("random trees of 1 to 100 degrees of freedom", tolerance);
  for (int dof = 1; dof <= 100 && !HasFailure(); ++dof) {
    SCOPED_TRACE("degrees of freedom " + std::to_string(dof));
    const description::Robot robot = test_robots::randomTreeOf(random, dof);
    compareStates(robot, test_robots::uniformVector3(random, 10), 20, random, errors);
  }
}

TEST(DynamicsAgainstSimbody, CoupledTreesIn1000States) {
  Random random(4);
  WorstErrors errors("random trees of 2 to 100 degrees of freedom before a third of the joints are driven", tolerance);
  for (int dof = 2, coupled = 0; coupled < 100 && !HasFailure(); dof = dof % 100 + 1) {
    SCOPED_TRACE("degrees of freedom " + std::to_string(dof));
    description::Robot robot = test_robots::randomTreeOf(random, dof);
    test_robots::coupleJoints(random, robot);
    if (!dynamics::Model(robot).coupled()) continue;
    ++coupled;
    compareStates(robot, test_robots::uniformVector3(random, 10), 10, random, errors);
  }
}

TEST(DynamicsAgainstSimbody, AChangedRotorInOneEngineIsSeen) {
  description::Robot changed = lwrAllegro();
  changed.joints[changed.movingJoints().back()].rotor_inertia *= 1.01;
  BothEngines engines(changed, lwrAllegro(), {0, 0, -9.81});
  engines.set(Eigen::VectorXd::Constant(23, 0.3), Eigen::VectorXd::Constant(23, 0.1));
  EXPECT_GT(engines.massMatrixError(), tolerance);
  EXPECT_GT(engines.forwardDynamicsError(Eigen::VectorXd::Constant(23, 0.1)), 1e3 * tolerance);
}

TEST(DynamicsAgainstSimbody, AChangedRatioInOneEngineIsSeen) {
  description::Robot robot = lwrAllegro();
  const std::vector<int> moving = robot.movingJoints();
  robot.joints[moving[22]].mimic = description::Mimic{.driver = moving[21], .multiplier = 0.5};
  description::Robot changed = robot;
  changed.joints[moving[22]].mimic->multiplier *= 1 + 1e-6;
  for (const bool same : {true, false}) {
    BothEngines engines(same ? robot : changed, robot, {0, 0, -9.81});
    ASSERT_EQ(engines.dof(), 22);
    engines.set(Eigen::VectorXd::Constant(22, 0.3), Eigen::VectorXd::Constant(22, 0.1));
    const double worst = std::max({engines.massMatrixError(), engines.gravityError(),
                                   engines.frameJacobianError(robot.joints[moving[22]].child)});
    EXPECT_EQ(worst < tolerance, same) << worst;
  }
}

}  // namespace
}  // namespace tactus
