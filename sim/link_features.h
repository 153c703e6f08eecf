#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/description/robot.h"

namespace tactus::sim {

/// What of a link can touch: a capsule; `from == to` is a sphere.
struct LinkFeature {
  int link = -1;                                                   ///< index into description::Robot::links
  int body = -1;                                                   ///< the body that carries it, an engine's index
  Eigen::Vector3d from = Eigen::Vector3d::Zero();                  ///< m, body frame
  Eigen::Vector3d to = Eigen::Vector3d::Zero();
  double radius = 0;                                               ///< m
};

/// The features of all links, in the order of links and of their shapes; each link is still its own body.
///
/// A box becomes a row of equal capsules inside it: the radius is half of the shortest edge, the capsules lie
/// along the longest edge and stand side by side along the middle one, at most one radius apart, the outer ones
/// against the faces.  Every outer face is thus touched from within.  Rounding: edges and corners become round
/// with that radius r, and between two neighbours s ≤ r apart the wide faces sink by r − √(r² − s²/4) ≤ 0.134 r,
/// which a flat object does not reach.
std::vector<LinkFeature> linkFeatures(const description::Robot& robot);

}  // namespace tactus::sim
