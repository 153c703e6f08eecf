// The own dynamics against MuJoCo, which reads the same descriptions as MJCF text (mjcf.h).
//
// Strategy: random states of the arm with the hand, of a humanoid and of random trees of 1 to 100 degrees of freedom
// with joints of every kind.  Every quantity relative to its greatest entry; the worst ones are printed.  J̇ q̇ and
// couplings are left to Simbody (tests/sim/dynamics_against_simbody_test.cc).

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "dsl/read_robot.h"
#include "framework/dynamics/aba.h"
#include "framework/dynamics/dynamics_cache.h"
#include "framework/dynamics/rnea.h"
#include "tests/dynamics/energy.h"
#include "tests/dynamics/random_state.h"
#include "tests/dynamics/worst_errors.h"
#include "tests/witness/mujoco_robot.h"

namespace tactus::witness {
namespace {

using dynamics::relativeError;
using dynamics::WorstErrors;
using test_robots::Random;

constexpr double tolerance = 1e-8;

/// The world of MJCF has no mass.
description::Robot withMasslessRoot(description::Robot robot) {
  robot.links[robot.root].has_inertial = false;
  return robot;
}

/// The same robot in both engines; `own` and `mujoco` differ only in negative controls.
class BothEngines {
 public:
  BothEngines(const description::Robot& own, const description::Robot& mujoco, const Eigen::Vector3d& gravity_W)
      : robot_(withMasslessRoot(own)),
        gravity_W_(gravity_W),
        model_(robot_),
        cache_(model_, gravity_W),
        workspace_(model_),
        mujoco_(mujoco, gravity_W) {}

  /// Compares everything in one random state; one random point of every link.
  void compare(Random& random, WorstErrors& errors) {
    const int n = model_.dof();
    ASSERT_EQ(mujoco_.dof(), n);
    const Eigen::VectorXd q = dynamics::randomConfiguration(model_, random);
    const Eigen::VectorXd qd = test_robots::uniformVector(random, n, 2);
    const Eigen::VectorXd qdd = test_robots::uniformVector(random, n, 5);
    const Eigen::VectorXd torque = test_robots::uniformVector(random, n, 10);
    errors.beginState();
    cache_.update(q, qd);
    mujoco_.set(q, qd, torque);
    errors.check("mass matrix", relativeError(cache_.massMatrix(), mujoco_.massMatrix()));
    errors.check("bias", relativeError(cache_.bias(), mujoco_.bias()));
    Eigen::VectorXd result(n);
    dynamics::aba(model_, q, qd, torque, gravity_W_, workspace_, result);
    errors.check("forward dynamics", relativeError(result, mujoco_.acceleration()));
    dynamics::rnea(model_, q, qd, qdd, gravity_W_, workspace_, result);
    errors.check("inverse dynamics", relativeError(result, mujoco_.inverseDynamics(qdd)));
    compareEnergies(q, qd, errors);
    for (int link = 0; link < static_cast<int>(model_.frames().size()); ++link) {
      SCOPED_TRACE("link '" + model_.frames()[link].name + "'");
      compareLink(link, test_robots::uniformVector3(random, 1), errors);
    }
  }

 private:
  void compareEnergies(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, WorstErrors& errors) {
    const double kinetic = 0.5 * qd.dot(cache_.massMatrix() * qd);
    errors.check("kinetic energy", std::abs(kinetic - mujoco_.kineticEnergy()) / kinetic);
    dynamics::forwardKinematics(model_, q, workspace_);
    const double potential = dynamics::potentialEnergy(robot_, model_, workspace_, gravity_W_);
    // Its zero is a convention: measured against what the weight of all links at 1 m would have.
    double weight = 0;
    for (const description::Link& link : robot_.links) weight += link.mass * gravity_W_.norm();
    errors.check("potential energy", std::abs(potential - mujoco_.potentialEnergy()) / weight);
  }

  void compareLink(int link, const Eigen::Vector3d& point_W, WorstErrors& errors) {
    const int n = model_.dof();
    const Eigen::Isometry3d own = cache_.framePose(link), other = mujoco_.pose(link);
    errors.check("pose", relativeError(own.matrix(), other.matrix()));
    Eigen::MatrixXd J(6, n), J_point(3, n);
    cache_.frameJacobian(link, J);
    errors.check("frame Jacobian", relativeError(J, mujoco_.frameJacobian(link), 1));
    cache_.pointJacobian(link, point_W, J_point);
    errors.check("point Jacobian", relativeError(J_point, mujoco_.pointJacobian(link, point_W), 1));
  }

  description::Robot robot_;
  Eigen::Vector3d gravity_W_;
  dynamics::Model model_;
  dynamics::DynamicsCache cache_;
  dynamics::Workspace workspace_;
  MujocoRobot mujoco_;
};

/// Compares `states` random states of one robot.
void compareStates(const description::Robot& robot, const Eigen::Vector3d& gravity_W, int states, Random& random,
                   WorstErrors& errors) {
  BothEngines engines(robot, robot, gravity_W);
  for (int trial = 0; trial < states && !::testing::Test::HasFailure(); ++trial) {
    SCOPED_TRACE("state " + std::to_string(trial));
    engines.compare(random, errors);
  }
}

description::Robot lwrAllegro() {
  std::vector<dsl::Diagnostic> warnings;
  return dsl::readRobot(std::string(TACTUS_SOURCE_DIR) + "/models/lwr_allegro.urdf", warnings);
}

TEST(DynamicsAgainstMujoco, ArmWithHandIn1000States) {
  Random random(1);
  WorstErrors errors("arm with hand", tolerance);
  compareStates(lwrAllegro(), {0, 0, -9.81}, 1000, random, errors);
}

TEST(DynamicsAgainstMujoco, HumanoidIn1000States) {
  Random random(2);
  WorstErrors errors("humanoid of 36 degrees of freedom", tolerance);
  ASSERT_EQ(dynamics::Model(test_robots::humanoid()).dof(), 36);
  compareStates(test_robots::humanoid(), {0, 0, -9.81}, 1000, random, errors);
}

TEST(DynamicsAgainstMujoco, RandomTreesOf1To100DegreesOfFreedomIn2000States) {
  Random random(3);
  WorstErrors errors("random trees of 1 to 100 degrees of freedom", tolerance);
  for (int dof = 1; dof <= 100 && !HasFailure(); ++dof) {
    SCOPED_TRACE("degrees of freedom " + std::to_string(dof));
    const description::Robot robot = test_robots::randomTreeOf(random, dof);
    compareStates(robot, test_robots::uniformVector3(random, 10), 20, random, errors);
  }
}

TEST(DynamicsAgainstMujoco, AFloatingBaseThatIsNotAtTheOriginAndOneOnAnotherLink) {
  Random random(4);
  WorstErrors errors("floating joints", tolerance);
  for (int trial = 0; trial < 20; ++trial) {
    description::Robot robot = test_robots::humanoid();
    description::Joint& base = robot.joints[robot.jointIndex("floating_base")];
    base.origin = test_robots::pose(test_robots::uniformVector3(random, 1), test_robots::uniformVector3(random, 3));
    robot.joints[robot.jointIndex("neck")].type = description::JointType::floating;
    robot.joints[robot.jointIndex("neck")].rotor_inertia = 0;
    compareStates(robot, test_robots::uniformVector3(random, 10), 10, random, errors);
  }
}

TEST(DynamicsAgainstMujoco, AChangedRotorInOneEngineIsSeen) {
  description::Robot changed = lwrAllegro();
  changed.joints[changed.movingJoints().back()].rotor_inertia *= 1.01;
  const dynamics::Model model(changed);
  dynamics::DynamicsCache cache(model);
  MujocoRobot mujoco(lwrAllegro(), {0, 0, -9.81});
  const Eigen::VectorXd q = Eigen::VectorXd::Constant(23, 0.3), zero = Eigen::VectorXd::Zero(23);
  cache.update(q, zero);
  mujoco.set(q, zero, zero);
  EXPECT_GT(relativeError(cache.massMatrix().bottomRightCorner(1, 1), mujoco.massMatrix().bottomRightCorner(1, 1)),
            1e-3);
  EXPECT_LT(relativeError(cache.massMatrix().topLeftCorner(7, 7), mujoco.massMatrix().topLeftCorner(7, 7)), 1e-3);
}

TEST(Mujoco, SaysWhyItRefusesARobot) {
  description::Robot robot = test_robots::chain(2);
  robot.links.back().has_inertial = false;
  try {
    MujocoRobot(robot, {0, 0, -9.81});
    FAIL() << "a moving link without mass was taken";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("MuJoCo refuses '" + robot.name + "': "), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("mass and inertia"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tactus::witness
