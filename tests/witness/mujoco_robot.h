#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/description/robot.h"
#include "tests/witness/mujoco/load.h"

namespace tactus::witness {

/// A robot in MuJoCo, asked and answering in the coordinates of description::JointType.  Joints that drive others are
/// not supported.  The world has no mass: the root link's does not count.
class MujocoRobot {
 public:
  /// Throws std::runtime_error with MuJoCo's message when it refuses the robot.
  MujocoRobot(const description::Robot& robot, const Eigen::Vector3d& gravity_W);

  int dof() const { return model_->nv; }

  /// Runs mj_forward at (q, q̇) with the torque τ; all answers are for this state.
  void set(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, const Eigen::VectorXd& torque);

  Eigen::MatrixXd massMatrix() const;                              ///< mj_fullM
  Eigen::VectorXd bias() const;                                    ///< qfrc_bias: velocities and gravity
  Eigen::VectorXd acceleration() const;                            ///< qacc
  Eigen::VectorXd inverseDynamics(const Eigen::VectorXd& qdd);     ///< mj_inverse
  double kineticEnergy() const { return data_->energy[1]; }
  double potentialEnergy() const { return data_->energy[0]; }
  /// Of a link, by its index in the description.
  Eigen::Isometry3d pose(int link) const;
  Eigen::MatrixXd frameJacobian(int link) const;                   ///< linear rows first, world axes
  Eigen::MatrixXd pointJacobian(int link, const Eigen::Vector3d& point_W) const;

 private:
  /// Consecutive numbers of one of MuJoCo's joints.
  struct Part {
    int from_q, to_q, count_q;                                     // ours, MuJoCo's
    int from_v, to_v, count_v;
  };
  struct FreeJoint {
    int from_q, to_q, to_v;
    Eigen::Isometry3d origin;                                      // MuJoCo's q is the pose in the world
  };
  void addParts(const description::Robot& robot, const description::Joint& joint, int from_q, int from_v);
  void addPart(const std::string& mujoco_joint, int& from_q, int& from_v);
  Eigen::MatrixXd inOurRates(const std::vector<double>& jacobian, int rows) const;

  MujocoModel model_;
  MujocoData data_;
  std::vector<Part> parts_;
  std::vector<FreeJoint> free_joints_;
  std::vector<int> bodies_;                                        // by link
  Eigen::MatrixXd T_;                                              // q̇_MuJoCo = T q̇; constant and orthogonal
};

}  // namespace tactus::witness
