#pragma once

#include <Eigen/Geometry>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "framework/description/robot.h"
#include "framework/dynamics/spatial.h"

namespace tactus::dynamics {

/// A robot that cannot be simulated, e.g. a moving link without mass; says where it was written.
class ModelError : public std::runtime_error {
 public:
  ModelError(const std::string& message, description::Place place)
      : std::runtime_error(message), place(std::move(place)) {}
  description::Place place;
};

enum class MassPolicy {
  required,                                                        ///< dynamics will be asked for
  kinematics_only                                                  ///< poses and Jacobians alone
};

/// A fixed-base tree of rigid bodies (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 4).  One body per
/// moving joint, numbered depth-first as description::Robot says; links on fixed joints are merged into the body
/// that carries them and remain as frames.  Body i is moved by joint i, i.e. by q[i]; -1 is the base.
///
/// A body frame is the frame of its joint, turned so that the joint axis is its z axis: then every joint
/// rotates about, or slides along, z.  Links keep their own axes: see Frame::pose.
class Model {
 public:
  struct Body {
    int parent = -1;                                               ///< body index, -1 is the base
    description::JointType type = description::JointType::revolute;
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();      ///< in the parent body's frame at q = 0
    RigidBodyInertia inertia;                                      ///< merged links and rotor, body frame
    Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();      ///< the same inertia about the centre of mass:
    Eigen::Matrix3d central_inertia = Eigen::Matrix3d::Zero();     ///< kg m², body axes
  };
  /// A link of the description, wherever it is carried.
  struct Frame {
    std::string name;
    int body = -1;                                                 ///< -1: fixed to the base
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();        ///< link frame in the body frame
  };

  /// Throws ModelError, also for what no policy can use: loops, several roots, numbers that are not finite, ...
  explicit Model(const description::Robot& robot, MassPolicy policy = MassPolicy::required);

  int dof() const { return static_cast<int>(bodies_.size()); }
  const std::vector<Body>& bodies() const { return bodies_; }
  /// Frame i is link i of the description.
  const std::vector<Frame>& frames() const { return frames_; }
  int frameIndex(std::string_view link) const;                     ///< -1 when there is none
  const std::vector<std::string>& jointNames() const { return joint_names_; }
  int jointIndex(std::string_view joint) const;                    ///< index into q, or -1
  bool supports(int joint, int frame) const;                       ///< does joint (index into q) move the frame?
  int parent(int body) const { return parents_[body]; }            ///< body index, -1 is the base
  /// One past the last body of the subtree of `body`; depth-first numbers make it [body, subtreeEnd(body)).
  int subtreeEnd(int body) const { return subtree_ends_[body]; }

  const Eigen::VectorXd& lower() const { return lower_; }          ///< rad or m, dof
  const Eigen::VectorXd& upper() const { return upper_; }
  const Eigen::VectorXd& effort() const { return effort_; }        ///< N m or N, dof, may be infinite
  const Eigen::VectorXd& velocityLimit() const { return velocity_; }

 private:
  std::vector<Body> bodies_;
  std::vector<Frame> frames_;
  std::vector<std::string> joint_names_;
  std::vector<int> parents_, subtree_ends_;
  Eigen::VectorXd lower_, upper_, effort_, velocity_;
};

}  // namespace tactus::dynamics
