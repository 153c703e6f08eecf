#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "framework/description/robot.h"
#include "framework/description/scene.h"
#include "sim/simbody_coordinates.h"
#include "sim/simtk_eigen.h"

namespace tactus::sim {

/// A body that nothing but forces moves.  Its frame is the object's.
struct FreeBody {
  std::string name;
  description::MassProperties mass;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();          ///< at the start
};

/// A description::Robot as a Simbody tree: one mobilized body per moving joint (Pin, Slider, Planar, Ball or Free),
/// fixed links merged into the body that carries them, rotor inertia added as the thin disk that robot.h defines.
/// Every joint moves on its own: couplings (mimic) are not kept, a driven joint has coordinates like any other.  Joints
/// are numbered depth-first as description::Robot says; q and u of revolute and prismatic joints are ours, for the
/// others see SimbodyCoordinates.  There is no force subsystem, whose bookkeeping would cost every step: gravity is a
/// set of body forces that one asks for.  Joint damping, friction and stops are not part of this class.
/// Only the sources of `sim` and tests include this header: it brings Simbody with it.
class SimbodyRobot {
 public:
  /// Throws runtime::PlantError, naming the link, for a moving body without mass or one that Simbody refuses.
  SimbodyRobot(const description::Robot& robot, const Eigen::Vector3d& gravity_W,
               const std::vector<FreeBody>& free_bodies = {});
  SimbodyRobot(const SimbodyRobot&) = delete;
  SimbodyRobot& operator=(const SimbodyRobot&) = delete;

  int dof() const { return coordinates_.dof(); }
  /// Indices into description::Robot::joints of those that move, driven ones too, in the order of q.
  const std::vector<int>& joints() const { return joints_; }
  const SimbodyCoordinates& coordinates() const { return coordinates_; }
  const SimTK::MultibodySystem& system() const { return system_; }
  const SimTK::SimbodyMatterSubsystem& matter() const { return matter_; }
  /// A state at q = 0 (unit quaternions), u = 0, realized to Model.
  SimTK::State defaultState() const { return system_.getDefaultState(); }

  /// The mobilized body of a free one, by its index; its coordinates come after the robot's: q a quaternion (w x y z)
  /// and the origin's place, u the angular velocity and the origin's, all in the world.
  SimTK::MobilizedBodyIndex freeBody(int index) const { return free_bodies_[static_cast<size_t>(index)]; }

  /// The mobilized body that carries a link (index into description::Robot::links), Ground for a fixed one.
  const SimTK::MobilizedBody& carrier(int link) const { return matter_.getMobilizedBody(carriers_[link].body); }
  /// The link frame in its carrier's frame.  A body frame has Simbody's joint axis where the joint's is.
  const Eigen::Isometry3d& poseInCarrier(int link) const { return carriers_[link].pose; }

  /// Sets `forces` to the weight of every body; the state is realized to Position.
  void gravityForces(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& forces) const;

 private:
  struct Carrier {
    SimTK::MobilizedBodyIndex body;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  };
  struct Weight {
    SimTK::Vec3 centre_of_mass_B;
    SimTK::Vec3 force_W;
  };
  void build(const description::Robot& robot, const Eigen::Vector3d& gravity_W);
  void addFreeBody(const FreeBody& body, const Eigen::Vector3d& gravity_W);

  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_;
  std::vector<int> joints_;
  SimbodyCoordinates coordinates_;
  std::vector<SimTK::MobilizedBodyIndex> bodies_;                  // by joint in joints_, then free ones
  std::vector<Weight> weights_;                                    // alike
  std::vector<Carrier> carriers_;                                  // by link
  std::vector<SimTK::MobilizedBodyIndex> free_bodies_;
};

}  // namespace tactus::sim
