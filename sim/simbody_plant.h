#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "framework/description/faults.h"
#include "framework/description/robot.h"
#include "framework/description/scene.h"
#include "framework/runtime/plant.h"
#include "sim/contact_force.h"

namespace tactus::sim {

struct PlantOptions {
  double step = 0.25e-3;                                           ///< s, semi-explicit Euler
  double velocity_limit = 100;                ///< rad/s or m/s, of joints and places; beyond it the state is a runaway
  double overspeed = 5;                       ///< times a joint's own velocity limit, where it has one; a runaway, too
  ContactOptions contact;
  /// Links, each once, whose wrenches `sense` tells (see link_wrenches.h): as they were when the last step began, none
  /// before the first.
  std::vector<int> wrench_links;
  /// Of links and of objects that forces move; whoever controls the robot does not know.  Velocities stay as they are
  /// when a mass changes.
  std::vector<description::WrongMass> wrong_masses;
  std::vector<description::JointFriction> frictions;
  /// On links and on objects that forces move, each held over a step; a step that it covers in part feels that part of
  /// it, so that the impulse is right.
  std::vector<description::Shove> shoves;
};

/// The robot in its scene, simulated by Simbody (tree, free bodies, gravity, forward dynamics) with Tactus's own contact
/// force (see contact_force.h) and joint damping, friction and stops (see joint_resistance.h).  Links touch all objects
/// and, as far as Robot::self_contact says, each other, with ContactMaterial's defaults; objects that move touch all
/// others.  What Scene::pairs say goes before.  Semi-explicit Euler at a fixed
/// step h: q̇ ← q̇ + h q̈(q, q̇, τ), q ← q + h q̇; time is a step count times h.  The same inputs give the same bits.
/// Built from the description alone: nothing of framework/dynamics is used.
class SimbodyPlant final : public runtime::Plant {
 public:
  /// Throws runtime::PlantError when the robot has joints of several degrees of freedom or driven by others, or moving
  /// links without mass, when Simbody refuses it, or the start has the wrong size, is not finite or lies outside the
  /// joint limits; when an object that forces move has no mass, or one without end does not stay where it is.
  SimbodyPlant(const description::Robot& robot, const description::Scene& scene, const Eigen::VectorXd& start_q,
               const PlantOptions& options = {});
  ~SimbodyPlant() override;

  const control::Sensed& sense() const override;
  /// `duration` is a whole number of steps.  A step whose result is not finite or beyond the velocity limit is not
  /// taken: PlantError says joint, value and time, and `sense` shows the last good step.
  void advance(const Eigen::VectorXd& torque, double duration) override;
  std::span<const control::ObjectMotion> objects() const override;
  void archive(control::Archive& archive) override;
  /// Wrong masses, then frictions, then shoves.
  void faults(std::vector<const control::FaultRecord*>& records) const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace tactus::sim
