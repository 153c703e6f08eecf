#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "framework/control/sensed.h"
#include "framework/description/robot.h"
#include "sim/contact_force.h"

namespace tactus::sim {

/// How a body frame accelerates, world axes.
struct BodyAcceleration {
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();             ///< α, rad/s²
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();              ///< a, m/s², of the frame's origin
};

/// What pushes a link besides objects.
struct LinkPush {
  int link = -1;                                                   ///< index into description::Robot::links
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();               ///< m
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();               ///< N, on the link, at that point
  Eigen::Vector3d moment_W = Eigen::Vector3d::Zero();              ///< N m, besides the force's
};

/// The wrench through the joint above a link, fixed joints too: what the rest of the robot does to the link and all
/// that hangs on it.  With S the links and rotors of that subtree, c_k their centres of mass, o the link's origin and
/// f_c what the subtree does to objects at the points p_c (Newton and Euler, body by body):
///
///   f = Σ_S m_k (c̈_k − g) + Σ f_c,
///   n = Σ_S [I_k α_k + ω_k × I_k ω_k + (c_k − o) × m_k (c̈_k − g)] + Σ (p_c − o) × f_c.
///
/// Whatever else pushes a link, a shove, is the negative of such an f_c.
///
/// The rotor is part of the joint's child, as in the plant: about the joint's axis n is the joint's whole torque.
/// Nothing of Simbody's own reaction forces is used, which know no fixed joints.
class LinkWrenches {
 public:
  /// Where links are carried: body and pose in its frame, by link.
  struct Carrier {
    int body = 0;
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  };

  /// Of these links, indices into `robot.links`.
  LinkWrenches(const description::Robot& robot, const std::vector<Carrier>& carriers, const std::vector<int>& links,
               const Eigen::Vector3d& gravity_W);

  bool empty() const { return subtrees_.empty(); }
  /// Motions, accelerations and external wrenches by body (contacts and pushes), all of one instant; `contacts` and
  /// `pushes` are those of that instant: where a fixed joint parts a body, what acts on the links beyond it is taken
  /// from there.
  void evaluate(const std::vector<BodyMotion>& motions, const std::vector<BodyAcceleration>& accelerations,
                const std::vector<BodyWrench>& external, const std::vector<control::ContactRecord>& contacts,
                std::vector<control::LinkWrench>& wrenches, const std::vector<LinkPush>& pushes = {}) const;

 private:
  struct Part {                                                    // a link, or a rotor without mass
    int body;
    double mass;
    Eigen::Vector3d centre_B;
    Eigen::Matrix3d inertia_B;                                     // about the centre of mass
  };
  struct Subtree {
    int link;
    Carrier carrier;
    std::vector<Part> parts;
    std::vector<int> bodies;                                       // that hang on it as a whole
    std::vector<bool> parted;                                      // by link: of a body that does not
  };

  std::vector<Subtree> subtrees_;
  Eigen::Vector3d gravity_W_;
};

}  // namespace tactus::sim
