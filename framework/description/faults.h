#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/description/robot.h"

/// What goes wrong with the robot's drives and bodies while a run goes on, as plain data.  SI units, world frame W.
namespace tactus::description {

/// From one time until another, s: from ≤ t < until.
struct Window {
  double from = 0;
  double until = infinity;

  /// `rounding` (s) is what sums of steps are off by.
  bool holds(double time, double rounding) const { return time >= from - rounding && time < until - rounding; }
};

enum class TorqueFaultKind {
  loss,                                                            ///< `factor` of the torque is left
  stuck,                                                           ///< the torque of the last tick before stays
  delay                                                            ///< the torque is that of `delay` before
};

/// Between the controller and the joints.
struct TorqueFault {
  std::string name;
  TorqueFaultKind kind = TorqueFaultKind::loss;
  Window window;
  std::vector<int> joints;                                         ///< indices into q̇
  double factor = 0;                                               ///< of a loss, 0 to 1
  double delay = 0;                                                ///< s, of a delay: a whole number of ticks
};

/// A link of the robot or an object of the scene: one of the two.
struct BodyReference {
  int link = -1;                                                   ///< index into Robot::links
  int object = -1;                                                 ///< index into Scene::objects
};

/// Bodies weigh other than they are described: `factor` times their mass and inertia, and a point mass `added` at `point`
/// of each.
struct WrongMass {
  std::string name;
  Window window;
  std::vector<BodyReference> bodies;
  double factor = 1;                                               ///< > 0
  double added = 0;                                                ///< kg
  Eigen::Vector3d point = Eigen::Vector3d::Zero();                 ///< m, in the body's frame
};

/// Joints rub: Coulomb friction besides what the robot's description has, which the controller knows nothing of.
struct JointFriction {
  std::string name;
  Window window;
  std::vector<int> joints;                                         ///< indices into q̇
  std::vector<double> torque;                                      ///< N m or N, of each of them
};

/// A force at a point of a body, and a moment on it.
struct Shove {
  std::string name;
  Window window;
  BodyReference body;
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();               ///< N
  Eigen::Vector3d moment_W = Eigen::Vector3d::Zero();              ///< N m
  Eigen::Vector3d point = Eigen::Vector3d::Zero();                 ///< m, in the body's frame
};

struct Faults {
  std::vector<TorqueFault> torques;                                ///< a torque goes through them in this order
  std::vector<WrongMass> masses;
  std::vector<JointFriction> frictions;                            ///< those of one joint add up
  std::vector<Shove> shoves;
};

}  // namespace tactus::description
