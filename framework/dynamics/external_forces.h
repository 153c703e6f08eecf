#pragma once

#include <vector>

#include "framework/dynamics/kinematics.h"

namespace tactus::dynamics {

/// Forces that the world exerts on the robot, summed on each body.  After forwardKinematics.
class ExternalForces {
 public:
  explicit ExternalForces(const Model& model) : model_(&model), forces_(model.bodyCount(), ForceVector::Zero()) {}
  explicit ExternalForces(const Model&&) = delete;                 ///< would outlive it

  void clear() { forces_.assign(forces_.size(), ForceVector::Zero()); }
  /// A force on the point of `frame` now at point_W, N, world axes.
  void addForce(int frame, const Eigen::Vector3d& point_W, const Eigen::Vector3d& force_W) {
    add(frame, ForceVector(force_W, point_W.cross(force_W)));
  }
  /// A pure moment, N m, world axes.
  void addMoment(int frame, const Eigen::Vector3d& moment_W) {
    add(frame, ForceVector(Eigen::Vector3d::Zero(), moment_W));
  }
  /// Of a body, moment about the world origin.
  const ForceVector& of(int body) const { return forces_[body]; }

 private:
  void add(int frame, const ForceVector& force) {
    const int body = model_->frames()[frame].body;
    if (body >= 0) forces_[body] += force;                         // the base bears it
  }

  const Model* model_;
  std::vector<ForceVector> forces_;
};

}  // namespace tactus::dynamics
