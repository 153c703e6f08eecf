#pragma once

#include <string>
#include <vector>

#include "framework/description/robot.h"

/// Robots made of robots.
namespace tactus::description {

struct Member {
  std::string name;
  Robot robot;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();          ///< of its root link in the common root
};

/// One robot of several, e.g. of two arms: a common root link "world" carries each member's root by a fixed joint
/// "NAME/mount".  All names of a member, groups included, are put behind "NAME/".
/// Throws std::invalid_argument when two members have the same name.
Robot combine(const std::string& name, const std::vector<Member>& members);

/// The robot on a floating base: a new root link "world" carries the old one by a floating joint of that name.
Robot withFloatingBase(Robot robot, const std::string& joint = "floating_base");

}  // namespace tactus::description
