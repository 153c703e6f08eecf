#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/control/archive.h"
#include "framework/description/robot.h"

namespace tactus::sim {

/// Passive torques of the moving joints: viscous damping, Coulomb friction and the stops at the ends of the range.
///
/// Stops and friction are springs with dampers whose numbers follow from the joint's effective inertia
/// I = 1/(M⁻¹)_ii at the start and the plant's step h, so that they are as stiff as the fixed step bears:
///   k = 0.05 I/h²  (natural frequency 0.22/h, about 900 rad/s at h = 0.25 ms),   d = 0.22 I/h  (ratio ζ = 0.5).
/// - **Stop**: torque −k x − d q̇ with x the way past the limit, acting only inwards.
/// - **Coulomb friction**: a bristle z bends with q̇, |k z| ≤ friction; torque −(k z + d q̇), at most `friction`.
///   Its state advances with `commit`, once per accepted step.  A fault may add to what the joint itself has.
class JointResistance {
 public:
  /// `inertia` holds I of every moving joint, in the order of q.
  JointResistance(const description::Robot& robot, const Eigen::VectorXd& inertia, double step);

  /// Coulomb friction of each joint besides its own from now on, N m or N.
  void setAddedFriction(const Eigen::VectorXd& friction);
  /// Adds the torques at (q, q̇) to `torque`.
  void add(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, Eigen::VectorXd& torque);
  /// Keeps the bristles of the last `add`.
  void commit();
  void archive(control::Archive& archive);

 private:
  struct Axis {
    double lower, upper;
    double damping, own_friction;
    double stiffness, stop_damping;
    double friction = own_friction;                                // with what is added
    double bend = 0, next_bend = 0;                                // rad or m
  };
  std::vector<Axis> axes_;
  double step_;
};

}  // namespace tactus::sim
