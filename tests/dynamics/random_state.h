#pragma once

#include <gtest/gtest.h>

#include <string>

#include "framework/dynamics/configuration.h"
#include "framework/dynamics/kinematics.h"
#include "tests/dynamics/robots.h"

/// Random robots in random states, the same ones in every test: what the laws of the dynamics are tried on.
namespace tactus::dynamics {

inline Eigen::VectorXd randomConfiguration(const Model& model, test_robots::Random& random) {
  Eigen::VectorXd q(model.positionCount());
  integrate(model, model.neutral(), test_robots::uniformVector(random, model.dof(), 3), q);
  return q;
}

/// q moved on for the time t with the rates v, in a copy.
inline Eigen::VectorXd moved(const Model& model, const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t = 1) {
  Eigen::VectorXd to(q.size());
  integrate(model, q, t * v, to);
  return to;
}

/// One coordinate moved on by `step`.
inline Eigen::VectorXd nudged(const Model& model, const Eigen::VectorXd& q, int coordinate, double step) {
  return moved(model, q, Eigen::VectorXd::Unit(model.dof(), coordinate), step);
}

struct RandomState {
  explicit RandomState(const description::Robot& description, test_robots::Random& random)
      : robot(description),
        model(robot),
        workspace(model),
        q(randomConfiguration(model, random)),
        qd(test_robots::uniformVector(random, model.dof(), 2)),
        qdd(test_robots::uniformVector(random, model.dof(), 5)),
        gravity_W(test_robots::uniformVector3(random, 10)) {}

  description::Robot robot;
  Model model;
  Workspace workspace;
  Eigen::VectorXd q, qd, qdd;
  Eigen::Vector3d gravity_W;
};

/// Runs `law` on 80 random trees of 1 to 30 joints of every kind, a third of them with joints that others drive, and
/// on the arm with hand.
template <class Law>
void onRandomStates(std::uint64_t seed, Law law) {
  test_robots::Random random(seed);
  for (int trial = 0; trial < 80; ++trial) {
    const int joints = 1 + trial % 30;
    description::Robot robot = test_robots::randomTree(random, joints, trial % 4 != 0);
    if (trial % 3 == 0) test_robots::coupleJoints(random, robot);
    RandomState state(robot, random);
    SCOPED_TRACE("trial " + std::to_string(trial) + ", joints " + std::to_string(joints));
    law(state, random);
    if (::testing::Test::HasFatalFailure()) return;
  }
  SCOPED_TRACE("arm and hand");
  RandomState state(test_robots::lwrAllegro(), random);
  law(state, random);
}

/// ‖a − b‖ ≤ tolerance · max(‖a‖, ‖b‖, floor), in the greatest entry.
template <class A, class B>
::testing::AssertionResult near(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b, double tolerance,
                                double floor = 0) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return ::testing::AssertionFailure() << "sizes differ";
  if (a.size() == 0) return ::testing::AssertionSuccess();
  const double scale = std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), floor});
  const double error = (a - b).cwiseAbs().maxCoeff();
  if (error <= tolerance * scale) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "differ by " << error << " at a scale of " << scale << "\n"
                                       << a << "\n\n"
                                       << b;
}

}  // namespace tactus::dynamics
