#include "sim/object_path.h"

#include <algorithm>

namespace tactus::sim {

BodyMotion motionOn(const std::vector<description::Waypoint>& path, double time) {
  const auto at = [](const Eigen::Isometry3d& pose) {
    BodyMotion motion;
    motion.R_WB = pose.linear();
    motion.p_WB = pose.translation();
    return motion;
  };
  if (time <= path.front().time) return at(path.front().pose);
  if (time >= path.back().time) return at(path.back().pose);
  const auto next = std::upper_bound(path.begin(), path.end(), time,
                                     [](double t, const description::Waypoint& waypoint) { return t < waypoint.time; });
  const description::Waypoint &from = *(next - 1), &to = *next;
  const double span = to.time - from.time, u = (time - from.time) / span;
  const double s = u * u * u * (10 - 15 * u + 6 * u * u), rate = 30 * u * u * (1 - u) * (1 - u) / span;
  const Eigen::Vector3d way = to.pose.translation() - from.pose.translation();
  const Eigen::AngleAxisd turn(to.pose.linear() * from.pose.linear().transpose());
  BodyMotion motion;
  motion.p_WB = from.pose.translation() + s * way;
  motion.R_WB = Eigen::AngleAxisd(s * turn.angle(), turn.axis()) * from.pose.linear();
  motion.linear_W = rate * way;
  motion.angular_W = rate * turn.angle() * turn.axis();
  return motion;
}

}  // namespace tactus::sim
