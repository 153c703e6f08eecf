#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "framework/description/place.h"

/// A robot as plain data: what a URDF file and Tactus's own elements in it say, nothing computed.
/// Two engines are built from it independently: `framework/dynamics` and the plant in `sim`.
/// SI units.  A link frame coincides with the frame of the joint that carries it.
namespace tactus::description {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// What a joint lets its child do, and its coordinates q with their rates q̇:
///   revolute, prismatic   an angle about, or a distance along, `axis`;
///   planar                x, y in the plane across `axis`, then the angle about it: axes of planeFrame(axis);
///   spherical             a unit quaternion w x y z, child in parent; q̇ is the angular velocity in the child's axes;
///   floating              x y z of the child's origin in the joint frame, then a quaternion as above; q̇ is the
///                         velocity of that origin in the joint frame's axes, then the angular velocity as above.
enum class JointType { fixed, revolute, prismatic, planar, spherical, floating };

/// Numbers in q, and in q̇, of a joint that no other one drives.
int positionCount(JointType type);
int velocityCount(JointType type);

/// Columns x, y, z = axis.  x is the coordinate axis least along `axis`, projected; the identity for axis = z.
Eigen::Matrix3d planeFrame(const Eigen::Vector3d& axis);

/// Couples a joint to another one: q = multiplier · q_driver + offset.  Both have one coordinate.
struct Mimic {
  int driver = -1;                                                 ///< index into Robot::joints
  double multiplier = 1;
  double offset = 0;
};

/// All points within `radius` (m) of the segment `from`–`to`, in the link frame.  `from == to` is a sphere.
struct CapsuleShape {
  Eigen::Vector3d from = Eigen::Vector3d::Zero();
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// A box of full edge lengths `size` (m), centred at `pose` in the link frame.
struct BoxShape {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  Eigen::Vector3d size = Eigen::Vector3d::Zero();
};

using LinkShape = std::variant<CapsuleShape, BoxShape>;

struct Link {
  std::string name;
  bool has_inertial = false;                                       ///< false: the file gave no mass at all
  double mass = 0;                                                 ///< kg
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();        ///< m, link frame
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();               ///< kg m², about the centre of mass, link axes
  std::vector<LinkShape> shapes;                                   ///< what can touch
  Place place;
};

struct Joint {
  std::string name;
  JointType type = JointType::fixed;
  int parent = -1;                                                 ///< index into Robot::links
  int child = -1;                                                  ///< index into Robot::links
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();        ///< joint frame in the parent link frame, at q = 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();                 ///< unit vector, joint frame
  double lower = -infinity;                                        ///< rad or m
  double upper = infinity;
  double effort = infinity;                                        ///< N m or N
  double velocity = infinity;                                      ///< rad/s or m/s
  double damping = 0;                                              ///< N m s/rad or N s/m
  double friction = 0;                                             ///< N m or N, Coulomb
  std::optional<Mimic> mimic;                                      ///< driven by another joint
  double rotor_inertia = 0;                                        ///< kg m², of the motor's rotor, before the gear
  double gear_ratio = 1;                                           ///< turns of the rotor for one of the joint
  Place place;

  /// What the joint feels of its rotor, J = ratio² · rotor inertia: a thin disk fixed to the child link, J about the
  /// joint axis and J/2 about the two others, added to the child's tensor about its centre of mass.  Both engines do
  /// the same.
  double reflectedInertia() const { return gear_ratio * gear_ratio * rotor_inertia; }
};

/// A named set of links or of joints, e.g. "fingers".
struct Group {
  std::string name;
  std::vector<std::string> members;
  Place place;
};

/// Two links, indices into Robot::links, one < other.
struct LinkPair {
  int one = -1;
  int other = -1;
  bool operator==(const LinkPair&) const = default;
};

/// Links in file order, the root first found by having no parent.  Joints with coordinates of their own, neither
/// fixed nor driven by others, are numbered depth-first from the root, children in the order of their joints in the
/// file: that is the order of q everywhere.
struct Robot {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;                                       ///< fixed ones too
  int root = 0;                                                    ///< index into links
  std::vector<std::string> skin;                                   ///< links that feel
  std::vector<LinkPair> self_contact;                              ///< links that touch each other, rising; no others
  std::vector<Group> link_groups;
  std::vector<Group> joint_groups;
  Place place;

  /// Indices into `joints` of those with coordinates of their own, in the order of q.
  std::vector<int> movingJoints() const;
  /// Index into `links`, or -1.
  int linkIndex(const std::string& name) const;
  /// Index into `joints`, or -1.
  int jointIndex(const std::string& name) const;
};

}  // namespace tactus::description
