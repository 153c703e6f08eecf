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

struct Drive;

/// How a body moves against the one before it.
enum class Motion {
  rotation,                                                        ///< about z of its frame
  translation,                                                     ///< along z of its frame
  ball_x, ball_y, ball_z                                           ///< a spherical joint, about x, y, z of its frame
};

/// A tree of rigid bodies (Featherstone, Rigid Body Dynamics Algorithms, 2008, ch. 4), one body for each degree of
/// freedom of its joints, numbered depth-first as description::Robot says; -1 is the base.  Links on fixed joints are
/// merged into the body that carries them and remain as frames.
///
/// A joint of several degrees of freedom is a chain of bodies of which the last one has the mass: planar and floating
/// joints slide along each axis and then turn.  A spherical joint is three bodies in one place, turning about the axes
/// of the child, all three carried by the velocity of the body before them.
///
/// q has the positions of all joints that no other joint drives, q̇ their rates (description::JointType): q has one
/// number more than q̇ for each quaternion.  A driven joint (mimic) has bodies but no coordinates: its body turns with
/// its driver's coordinate, ratio · q + offset.  Then there are more bodies than coordinates, and what bodies hand to
/// coordinates is summed: these coordinates are reduced ones, and the algorithms exact.
///
/// A body frame is the frame of its joint, turned so that the axis of motion is its z axis (a ball's is not turned).
/// Links keep their own axes: see Frame::pose.
class Model {
 public:
  struct Body {
    int parent = -1;                                               ///< body index, -1 is the base
    int carrier = -1;                                              ///< the body whose velocity carries the axis: the
                                                                   ///< parent, or a ball's parent for all three
    Motion motion = Motion::rotation;
    int position = 0;                                              ///< index into q; of a ball, of its quaternion
    int coordinate = 0;                                            ///< index into q̇
    double ratio = 1;                                              ///< of a driven body's rate to its coordinate's
    double offset = 0;                                             ///< rad or m
    Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();      ///< in the parent body's frame at q = 0
    bool unturned = true;                                          ///< the origin's rotation is the identity
    bool massless = false;                                         ///< all but the last body of a joint
    RigidBodyInertia inertia;                                      ///< merged links and rotor, body frame
    Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();      ///< the same inertia about the centre of mass:
    Eigen::Matrix3d central_inertia = Eigen::Matrix3d::Zero();     ///< kg m², body axes
  };
  /// A joint that moves, in depth-first order, driven ones too.
  struct Joint {
    std::string name;
    description::JointType type = description::JointType::revolute;
    int driver = -1;                                               ///< index into joints(), of a driven joint
    int first_body = 0, body_count = 1;
    int position = 0, position_count = 1;                          ///< into q; a driven joint's are its driver's
    int coordinate = 0, coordinate_count = 1;                      ///< into q̇
  };
  /// A link of the description, wherever it is carried.
  struct Frame {
    std::string name;
    int body = -1;                                                 ///< -1: fixed to the base
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();        ///< link frame in the body frame
  };

  /// Throws ModelError, also for what no policy can use: loops, several roots, numbers that are not finite, ...
  explicit Model(const description::Robot& robot, MassPolicy policy = MassPolicy::required);

  int dof() const { return static_cast<int>(coordinate_names_.size()); }      ///< size of q̇, q̈ and τ
  int positionCount() const { return static_cast<int>(position_names_.size()); }  ///< size of q
  int bodyCount() const { return static_cast<int>(bodies_.size()); }
  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Joint>& joints() const { return joints_; }
  /// Some joint drives another one: there are more bodies than coordinates.
  bool coupled() const { return bodyCount() > dof(); }
  bool hasQuaternions() const { return positionCount() > dof(); }
  /// Frame i is link i of the description.
  const std::vector<Frame>& frames() const { return frames_; }
  int frameIndex(std::string_view link) const;                     ///< -1 when there is none
  /// Of coordinates: the joint's name; for joints of several degrees of freedom with what moves, "base.x", "base.wz".
  const std::vector<std::string>& jointNames() const { return coordinate_names_; }
  const std::vector<std::string>& positionNames() const { return position_names_; }  ///< likewise, "base.qw"
  int jointIndex(std::string_view coordinate) const;               ///< index into q̇, or -1
  /// q = 0 with unit quaternions.
  Eigen::VectorXd neutral() const;
  bool supports(int coordinate, int frame) const;                  ///< does it (index into q̇) move the frame?
  int parent(int body) const { return parents_[body]; }            ///< body index, -1 is the base
  /// One past the last body of the subtree of `body`; depth-first numbers make it [body, subtreeEnd(body)).
  int subtreeEnd(int body) const { return subtree_ends_[body]; }

  // Of coordinates, dof each.  A driver has to keep the limits of all that it drives.
  const Eigen::VectorXd& lower() const { return lower_; }          ///< rad or m
  const Eigen::VectorXd& upper() const { return upper_; }
  const Eigen::VectorXd& effort() const { return effort_; }        ///< N m or N, may be infinite
  const Eigen::VectorXd& velocityLimit() const { return velocity_; }
  const Eigen::VectorXd& damping() const { return damping_; }      ///< N m s/rad or N s/m
  const Eigen::VectorXd& friction() const { return friction_; }    ///< N m or N, Coulomb

 private:
  void addCoordinates(const description::Joint& joint);
  void addDriven(const description::Joint& joint, int coordinate, const Drive& drive);
  void addBodies(const description::Joint& joint, const Drive& drive, const Joint& added, Frame& child);
  void finishBodies();

  std::vector<Body> bodies_;
  std::vector<Joint> joints_;
  std::vector<Frame> frames_;
  std::vector<std::string> coordinate_names_, position_names_;
  std::vector<int> parents_, subtree_ends_;
  Eigen::VectorXd lower_, upper_, effort_, velocity_, damping_, friction_;
};

}  // namespace tactus::dynamics
