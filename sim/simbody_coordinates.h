#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/description/robot.h"
#include "sim/simtk_eigen.h"

namespace tactus::sim {

/// The way between the coordinates of description::JointType and Simbody's.  They differ in joints of several degrees
/// of freedom, where Simbody has rotations before translations, and angular velocities in the axes of the joint
/// frame instead of the child's:
///   planar     q, u = angle, x, y;
///   spherical  q = quaternion w x y z, u = ω in the joint frame;
///   floating   q = quaternion, x y z; u = ω in the joint frame, velocity in the joint frame.
class SimbodyCoordinates {
 public:
  /// Joints are added in the order of q.
  void add(SimTK::MobilizedBodyIndex body, description::JointType type);

  int positionCount() const { return position_count_; }
  int dof() const { return dof_; }

  /// Writes Simbody's q and u for (q, q̇).  The state is realized to Model.
  void setState(const SimTK::SimbodyMatterSubsystem& matter, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                SimTK::State& state) const;
  /// In the order of description::JointType: Simbody's q, or another vector like it, such as its derivative.
  Eigen::VectorXd positions(const SimTK::SimbodyMatterSubsystem& matter, const SimTK::State& state,
                            const SimTK::Vector& simbody_q) const;
  /// T, dof × dof and orthogonal, with u = T q̇, and so τ = Tᵀ f for Simbody's generalized forces f.  Also u̇ = T q̈:
  /// of Ṫ q̇ nothing is left but R (ω × ω).  Depends on the quaternions in `state`.
  Eigen::MatrixXd speedMatrix(const SimTK::SimbodyMatterSubsystem& matter, const SimTK::State& state) const;

 private:
  struct Joint {
    SimTK::MobilizedBodyIndex body;
    description::JointType type;
    int position, coordinate;                                      // into q and q̇
  };
  std::vector<Joint> joints_;
  int position_count_ = 0, dof_ = 0;
};

}  // namespace tactus::sim
