#pragma once

#include <Eigen/Core>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "framework/control/archive.h"
#include "framework/control/sensed.h"

namespace tactus::runtime {

/// The plant left the region where its answers mean anything (non-finite or runaway state).
class PlantError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A simulated (or real) robot in its world.
class Plant {
 public:
  virtual ~Plant() = default;

  /// Positions, velocities and contacts now.  The reference stays valid; the content changes with `advance`.
  virtual const control::Sensed& sense() const = 0;
  /// What there is, where sensors stand between it and `sense`.
  virtual const control::Sensed& truth() const { return sense(); }
  /// Now, of every object of the scene, in its order; none where the plant knows of none.
  virtual std::span<const control::ObjectMotion> objects() const { return {}; }
  /// Appends a record of everything that was asked to go wrong; they stay where they are for the plant's life.
  virtual void faults(std::vector<const control::FaultRecord*>&) const {}
  /// Holds the joint torques for `duration` seconds.  Throws PlantError, with the state of the last good step kept.
  virtual void advance(const Eigen::VectorXd& torque, double duration) = 0;
  /// All that the next steps depend on; `sense` then tells what it told when the state was saved.  Throws StateError,
  /// as a plant that cannot be saved does.
  virtual void archive(control::Archive&) { throw control::StateError("this plant cannot be saved or restored"); }
};

}  // namespace tactus::runtime
