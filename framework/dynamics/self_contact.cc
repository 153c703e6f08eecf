#include "framework/dynamics/self_contact.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "framework/description/link_shape.h"
#include "framework/dynamics/kinematics.h"

namespace tactus::dynamics {
namespace {

using description::LinkPair;
using description::Robot;
using Eigen::Vector3d;

struct Segment {
  Vector3d from, to;
  double radius;
};

/// What of a shape is deepest in another convex one: the axis of a capsule, an edge of a box.
std::vector<Segment> spineOf(const description::CapsuleShape& capsule) {
  return {{capsule.from, capsule.to, capsule.radius}};
}

std::vector<Segment> spineOf(const description::BoxShape& box) {
  std::vector<Segment> edges;
  for (int axis = 0; axis < 3; ++axis)
    for (const double u : {-0.5, 0.5})
      for (const double v : {-0.5, 0.5}) {
        Vector3d middle = Vector3d::Zero();
        middle[(axis + 1) % 3] = u * box.size[(axis + 1) % 3];
        middle[(axis + 2) % 3] = v * box.size[(axis + 2) % 3];
        const Vector3d half = 0.5 * box.size[axis] * Vector3d::Unit(axis);
        edges.push_back({box.pose * Vector3d(middle - half), box.pose * Vector3d(middle + half), 0});
      }
  return edges;
}

/// The least distance along a segment from a convex shape: signed distances of convex shapes are convex (golden
/// section).
double leastDistance(const geometry::Shape& shape, const Vector3d& from, const Vector3d& to) {
  constexpr double golden = 0.6180339887498949;
  const auto at = [&](double t) { return shape.distance(from + t * (to - from)).distance; };
  double low = 0, high = 1;
  double a = high - golden * (high - low), b = low + golden * (high - low);
  double at_a = at(a), at_b = at(b);
  for (int i = 0; i < 50; ++i) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - golden * (high - low);
      at_a = at(a);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + golden * (high - low);
      at_b = at(b);
    }
  }
  return std::min({at(0), at(1), at_a, at_b});
}

double gapFrom(const description::LinkShape& one, const Eigen::Isometry3d& X_WOne, const description::LinkShape& other,
               const Eigen::Isometry3d& X_WOther) {
  const geometry::PosedShape solid = description::solidOf(other);
  const Eigen::Isometry3d X = (X_WOther * solid.pose).inverse() * X_WOne;
  double gap = description::infinity;
  for (const Segment& segment : std::visit([](const auto& shape) { return spineOf(shape); }, one))
    gap = std::min(gap, leastDistance(*solid.shape, X * segment.from, X * segment.to) - segment.radius);
  return gap;
}

/// The link at the top of each one's body, and the joint that moves it; −1 for the root's.
struct Bodies {
  std::vector<int> top, joint;
};

Bodies bodiesOf(const Robot& robot) {
  std::vector<int> joint_above(robot.links.size(), -1);
  for (int j = 0; j < static_cast<int>(robot.joints.size()); ++j) joint_above[robot.joints[j].child] = j;
  Bodies bodies;
  for (int link = 0; link < static_cast<int>(robot.links.size()); ++link) {
    int top = link;
    while (joint_above[top] >= 0 && robot.joints[joint_above[top]].type == description::JointType::fixed)
      top = robot.joints[joint_above[top]].parent;
    bodies.top.push_back(top);
    bodies.joint.push_back(joint_above[top]);
  }
  return bodies;
}

/// "" where the two are no neighbours.
std::string neighbours(const Robot& robot, const Bodies& bodies, int one, int other) {
  if (bodies.top[one] == bodies.top[other]) return "they are one body";
  const auto hangsOn = [&](int link, int parent) {
    const int joint = bodies.joint[link];
    return joint >= 0 && bodies.top[robot.joints[joint].parent] == bodies.top[parent];
  };
  for (const auto& [link, parent] : {std::pair(one, other), std::pair(other, one)})
    if (hangsOn(link, parent)) return "joint '" + robot.joints[bodies.joint[link]].name + "' joins them";
  return "";
}

std::string millimetres(double metres) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f mm", 1e3 * metres);
  return text;
}

}  // namespace

double gapBetween(const description::Link& one, const Eigen::Isometry3d& X_WOne, const description::Link& other,
                  const Eigen::Isometry3d& X_WOther) {
  double gap = description::infinity;
  for (const description::LinkShape& a : one.shapes)
    for (const description::LinkShape& b : other.shapes)
      gap = std::min({gap, gapFrom(a, X_WOne, b, X_WOther), gapFrom(b, X_WOther, a, X_WOne)});
  return gap;
}

SelfContact findSelfContact(const Robot& robot, const Eigen::VectorXd& q, const std::vector<int>& links) {
  std::vector<int> rising;
  for (const int link : links)
    if (!robot.links[static_cast<std::size_t>(link)].shapes.empty()) rising.push_back(link);
  std::sort(rising.begin(), rising.end());
  rising.erase(std::unique(rising.begin(), rising.end()), rising.end());

  const Model model(robot, MassPolicy::kinematics_only);
  Workspace workspace(model);
  forwardKinematics(model, q, workspace);
  const Bodies bodies = bodiesOf(robot);
  SelfContact found;
  for (std::size_t i = 0; i < rising.size(); ++i)
    for (std::size_t k = i + 1; k < rising.size(); ++k) {
      const LinkPair pair{rising[i], rising[k]};
      std::string why = neighbours(robot, bodies, pair.one, pair.other);
      if (why.empty()) {
        const double gap =
            gapBetween(robot.links[static_cast<std::size_t>(pair.one)], framePose(model, workspace, pair.one),
                       robot.links[static_cast<std::size_t>(pair.other)], framePose(model, workspace, pair.other));
        if (gap < 0) why = "they overlap at the start, by " + millimetres(-gap);
      }
      if (why.empty())
        found.touching.push_back(pair);
      else
        found.left_out.push_back({pair, std::move(why)});
    }
  return found;
}

}  // namespace tactus::dynamics
