#include "framework/description/robot.h"

#include <algorithm>

namespace tactus::description {

int positionCount(JointType type) {
  switch (type) {
    case JointType::fixed: return 0;
    case JointType::revolute:
    case JointType::prismatic: return 1;
    case JointType::planar: return 3;
    case JointType::spherical: return 4;
    case JointType::floating: return 7;
  }
  return 0;
}

int velocityCount(JointType type) {
  const bool has_quaternion = type == JointType::spherical || type == JointType::floating;
  return positionCount(type) - (has_quaternion ? 1 : 0);
}

Eigen::Matrix3d planeFrame(const Eigen::Vector3d& axis) {
  if (axis == Eigen::Vector3d::UnitZ()) return Eigen::Matrix3d::Identity();  // without rounding
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d along = Eigen::Vector3d::Unit(least);
  Eigen::Matrix3d frame;
  frame.col(0) = (along - axis * axis.dot(along)).normalized();
  frame.col(1) = axis.cross(frame.col(0));
  frame.col(2) = axis;
  return frame;
}

std::vector<int> Robot::movingJoints() const {
  const int link_count = static_cast<int>(links.size());
  std::vector<std::vector<int>> joints_below(links.size());
  for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
    if (joints[j].parent >= 0 && joints[j].parent < link_count) joints_below[joints[j].parent].push_back(j);
  }

  std::vector<int> moving;
  std::vector<bool> visited(links.size(), false);  // a description may still hold a loop: Model refuses it later
  std::vector<int> pending;                        // joints still to visit, the next one last
  const auto descend = [&](int link) {
    if (link < 0 || link >= link_count || visited[link]) return;
    visited[link] = true;
    pending.insert(pending.end(), joints_below[link].rbegin(), joints_below[link].rend());
  };
  descend(root);
  while (!pending.empty()) {
    const int j = pending.back();
    pending.pop_back();
    if (joints[j].type != JointType::fixed && !joints[j].mimic) moving.push_back(j);
    descend(joints[j].child);
  }
  return moving;
}

int Robot::linkIndex(const std::string& link) const {
  const auto found = std::ranges::find(links, link, &Link::name);
  return found == links.end() ? -1 : static_cast<int>(found - links.begin());
}

int Robot::jointIndex(const std::string& joint) const {
  const auto found = std::ranges::find(joints, joint, &Joint::name);
  return found == joints.end() ? -1 : static_cast<int>(found - joints.begin());
}

}  // namespace tactus::description
