#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <string>
#include <vector>

#include "framework/control/archive.h"

/// What the robot feels at one instant: plain data from the plant to the controller.
namespace tactus::control {

/// One touch of a link feature (a capsule) on one primitive of an object, or of another link.  Of two links that touch
/// there is one record: `link` presses on `other_link`, which feels the opposite.
struct ContactRecord {
  int link = -1;                                                   ///< index into description::Robot::links
  int object = -1;                                                 ///< index into description::Scene::objects, or −1
  int other_link = -1;                                             ///< where the robot touches itself, else −1
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();               ///< m
  Eigen::Vector3d normal_W = Eigen::Vector3d::Zero();              ///< unit, out of the robot into the object
  double depth = 0;                                                ///< m, > 0 while overlapping
  double force_N = 0;                                              ///< along the normal, what the robot does to the object
  Eigen::Vector3d friction_W = Eigen::Vector3d::Zero();            ///< N, tangential, what the robot does to the object

  /// The robot touches itself: no touch of the world, though both links' skin feels it.
  bool isOfSelf() const { return other_link >= 0; }
};

/// How an object of the scene moves: what the plant knows and no robot does.
struct ObjectMotion {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();          ///< object frame in W
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();             ///< rad/s
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();              ///< m/s, of the frame's origin
};

/// What the rest of the robot does to a link, and all that hangs on it, through the joint above it.
struct LinkWrench {
  int link = -1;                                                   ///< index into description::Robot::links
  Eigen::Vector3d force_L = Eigen::Vector3d::Zero();               ///< N, link axes
  Eigen::Vector3d moment_L = Eigen::Vector3d::Zero();              ///< N m, link axes, about the link's origin
};

/// Something that was asked to go wrong, and when it did.
struct FaultRecord {
  std::string name;
  std::string kind;                                                ///< "shove", "torque-loss", "stuck", …
  bool strikes = false;                                            ///< now
  double began = std::numeric_limits<double>::quiet_NaN();         ///< s, the first time; NaN: it never did
  double ended = std::numeric_limits<double>::quiet_NaN();         ///< s, the last time; NaN: it did not

  /// What is so from `time` on.
  void note(double time, bool strikes_now) {
    if (strikes_now == strikes) return;
    if (strikes_now && !(began <= time)) began = time;
    ended = strikes_now ? std::numeric_limits<double>::quiet_NaN() : time;
    strikes = strikes_now;
  }
};

struct Sensed {
  double time = 0;                                                 ///< s
  Eigen::VectorXd q;                                               ///< rad or m, dof
  Eigen::VectorXd qd;                                              ///< dof
  std::vector<ContactRecord> contacts;                             ///< in the plant's fixed order
  std::vector<LinkWrench> wrenches;                                ///< of links that sensors ask for, else none
  Eigen::VectorXd readings;                                        ///< of the sensors' ports (see Readings)
};

void archive(Archive& archive, ContactRecord& record);
void archive(Archive& archive, LinkWrench& wrench);
void archive(Archive& archive, FaultRecord& record);
void archive(Archive& archive, Sensed& sensed);

}  // namespace tactus::control
