// The own dynamics against Simbody, which builds the same descriptions on its own: 1000 random states of the arm with
// the hand, as the program reads it, and 1000 of random trees.  Every quantity to 1e-9 of its greatest entry.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "dsl/read_robot.h"
#include "framework/dynamics/aba.h"
#include "framework/dynamics/dynamics_cache.h"
#include "sim/simbody_robot.h"
#include "tests/dynamics/robots.h"

namespace tactus {
namespace {

using test_robots::Random;

constexpr double tolerance = 1e-9;

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

/// Greatest difference over greatest entry, or over `floor` where that is greater.
double relativeError(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, double floor) {
  if (a.size() == 0) return 0;
  return (a - b).cwiseAbs().maxCoeff() / std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), floor});
}

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
        state_(simbody_.defaultState()) {}

  int dof() const { return model_.dof(); }
  const dynamics::Model& model() const { return model_; }

  void set(const Eigen::VectorXd& q, const Eigen::VectorXd& qd) {
    cache_.update(q, qd);
    sim::toEigen(state_.updQ()) = q;
    sim::toEigen(state_.updU()) = qd;
    simbody_.system().realize(state_, SimTK::Stage::Dynamics);
    simbody_.gravityForces(state_, weights_);
  }

  double massMatrixError() const {
    SimTK::Matrix M;
    simbody_.matter().calcM(state_, M);
    return relativeError(cache_.massMatrix(), toEigen(M), 0);
  }
  double biasError() const {
    SimTK::Vector bias;
    simbody_.matter().calcResidualForceIgnoringConstraints(state_, SimTK::Vector(), weights_, SimTK::Vector(), bias);
    return relativeError(cache_.bias(), sim::toEigen(std::as_const(bias)), 0);
  }
  double gravityError() const {
    SimTK::Vector pull;
    simbody_.matter().multiplyBySystemJacobianTranspose(state_, weights_, pull);
    return relativeError(-cache_.gravityTorque(), sim::toEigen(std::as_const(pull)), 1e-3);
  }
  double forwardDynamicsError(const Eigen::VectorXd& torque) {
    Eigen::VectorXd qdd(dof());
    dynamics::aba(model_, cache_.q(), cache_.qd(), torque, gravity_W_, workspace_, qdd);
    SimTK::Vector forces(dof(), 0.0), udot;
    SimTK::Vector_<SimTK::SpatialVec> accelerations;
    sim::toEigen(forces) = torque;
    simbody_.matter().calcAccelerationIgnoringConstraints(state_, forces, weights_, udot, accelerations);
    return relativeError(qdd, sim::toEigen(std::as_const(udot)), 0);
  }
  double poseError(int link) const {
    const SimTK::Transform X_WL = carrier(link).getBodyTransform(state_) * sim::toSimTK(simbody_.poseInCarrier(link));
    const Eigen::Isometry3d own = cache_.framePose(link);
    return std::max(relativeError(own.linear(), sim::toEigen(X_WL.R()), 1),
                    relativeError(own.translation(), sim::toEigen(X_WL.p()), 1));
  }
  double frameJacobianError(int link) const {
    SimTK::Matrix J;
    simbody_.matter().calcFrameJacobian(state_, carrier(link).getMobilizedBodyIndex(), origin(link), J);
    Eigen::MatrixXd own(6, dof());
    cache_.frameJacobian(link, own);
    return relativeError(own, linearFirst(toEigen(J)), 1);
  }
  double pointJacobianError(int link, const Eigen::Vector3d& point_W) const {
    SimTK::Matrix J;
    simbody_.matter().calcStationJacobian(state_, carrier(link).getMobilizedBodyIndex(), station(link, point_W), J);
    Eigen::MatrixXd own(3, dof());
    cache_.pointJacobian(link, point_W, own);
    return relativeError(own, toEigen(J), 1);
  }
  double frameAccelerationBiasError(int link) const {
    const SimTK::SpatialVec bias = simbody_.matter().calcBiasForFrameJacobian(
        state_, carrier(link).getMobilizedBodyIndex(), origin(link));
    Eigen::Matrix<double, 6, 1> linear_first;
    linear_first << sim::toEigen(bias[1]), sim::toEigen(bias[0]);
    return relativeError(cache_.frameAccelerationBias(link), linear_first, 1);
  }
  double pointAccelerationBiasError(int link, const Eigen::Vector3d& point_W) const {
    const SimTK::Vec3 bias = simbody_.matter().calcBiasForStationJacobian(
        state_, carrier(link).getMobilizedBodyIndex(), station(link, point_W));
    return relativeError(cache_.pointAccelerationBias(link, point_W), sim::toEigen(bias), 1);
  }

 private:
  const SimTK::MobilizedBody& carrier(int link) const { return simbody_.carrier(link); }
  SimTK::Vec3 origin(int link) const {
    return sim::toSimTK(Eigen::Vector3d(simbody_.poseInCarrier(link).translation()));
  }
  SimTK::Vec3 station(int link, const Eigen::Vector3d& point_W) const {
    return carrier(link).findStationAtGroundPoint(state_, sim::toSimTK(point_W));
  }

  Eigen::Vector3d gravity_W_;
  dynamics::Model model_;
  dynamics::DynamicsCache cache_;
  dynamics::Workspace workspace_;
  sim::SimbodyRobot simbody_;
  SimTK::State state_;
  SimTK::Vector_<SimTK::SpatialVec> weights_;
};

/// Compares everything in one random state; one random point of every link.
void compare(BothEngines& engines, Random& random) {
  const int n = engines.dof();
  engines.set(test_robots::uniformVector(random, n, 3), test_robots::uniformVector(random, n, 2));
  EXPECT_LT(engines.massMatrixError(), tolerance);
  EXPECT_LT(engines.biasError(), tolerance);
  EXPECT_LT(engines.gravityError(), tolerance);
  EXPECT_LT(engines.forwardDynamicsError(test_robots::uniformVector(random, n, 10)), tolerance);
  for (int link = 0; link < static_cast<int>(engines.model().frames().size()); ++link) {
    SCOPED_TRACE("link '" + engines.model().frames()[link].name + "'");
    const Eigen::Vector3d point_W = test_robots::uniformVector3(random, 1);
    EXPECT_LT(engines.poseError(link), tolerance);
    EXPECT_LT(engines.frameJacobianError(link), tolerance);
    EXPECT_LT(engines.pointJacobianError(link, point_W), tolerance);
    EXPECT_LT(engines.frameAccelerationBiasError(link), tolerance);
    EXPECT_LT(engines.pointAccelerationBiasError(link, point_W), tolerance);
  }
}

description::Robot lwrAllegro() {
  std::vector<dsl::Diagnostic> warnings;
  return dsl::readRobot(std::string(TACTUS_SOURCE_DIR) + "/models/lwr_allegro.urdf", warnings);
}

TEST(DynamicsAgainstSimbody, ArmWithHandIn1000States) {
  Random random(1);
  BothEngines engines(lwrAllegro(), {0, 0, -9.81});
  ASSERT_EQ(engines.dof(), 23);
  for (int trial = 0; trial < 1000 && !::testing::Test::HasFailure(); ++trial) {
    SCOPED_TRACE("state " + std::to_string(trial));
    compare(engines, random);
  }
}

TEST(DynamicsAgainstSimbody, RandomTreesIn1000States) {
  Random random(2);
  for (int tree = 0; tree < 100 && !::testing::Test::HasFailure(); ++tree) {
    SCOPED_TRACE("tree " + std::to_string(tree));
    const description::Robot robot = test_robots::randomTree(random, 1 + tree % 30);
    BothEngines engines(robot, test_robots::uniformVector3(random, 10));
    for (int trial = 0; trial < 10; ++trial) compare(engines, random);
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

}  // namespace
}  // namespace tactus
