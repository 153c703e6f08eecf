#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "framework/description/robot.h"

/// What all engines of the comparison are asked: one robot, states of it, points on it.
namespace tactus::bench {

inline constexpr int point_count = 12;
/// Cycled, so that no branch and no cache line is learnt by heart.
inline constexpr int state_count = 64;

/// A joint that moves and the links that it carries, merged: what every engine can be told.
struct Body {
  std::string name;
  int parent = -1;                                                 ///< index into Problem::bodies; -1: the world
  description::JointType type = description::JointType::revolute;  ///< revolute about z, or floating
  int position = 0;                                                ///< index into q
  int coordinate = 0;                                              ///< index into q̇
  Eigen::Isometry3d origin = Eigen::Isometry3d::Identity();        ///< in the parent's frame at q = 0
  double mass = 0;                                                 ///< kg, rotor inertia included in `inertia`
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();        ///< m, body frame
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();               ///< kg m², about the centre of mass, body axes
};

/// In the coordinates of description::JointType.
struct State {
  Eigen::VectorXd q, qd, qdd, tau;
};

/// A point in world axes (a place of contact, say) that moves with the body.
struct Point {
  std::string link;
  int body = 0;                                                    ///< index into Problem::bodies
  Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
};

struct Problem {
  std::string name;
  description::Robot robot;
  std::vector<Body> bodies;                                        ///< depth-first
  int dof = 0;
  Eigen::Vector3d gravity_W{0, 0, -9.81};
  std::vector<State> states;
  std::array<Point, point_count> points;

  /// Throws std::invalid_argument for a robot with joints that not every engine has.
  Problem(std::string name, description::Robot robot);
};

}  // namespace tactus::bench
