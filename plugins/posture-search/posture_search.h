#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "framework/description/robot.h"
#include "framework/dynamics/kinematics.h"
#include "framework/geometry/shape.h"

namespace tactus::plugins {

/// The side of a link that feels: where the outward normal is within `arc` of `facing`, as of the sensor `<skin>`.
struct FeelingSide {
  std::optional<Eigen::Vector3d> facing;                           ///< unit, link axes; none: all around
  double arc = 0;                                                  ///< rad
  bool has(const Eigen::Vector3d& normal_L) const;
};

struct PostureSearchOptions {
  std::vector<int> joints;                                         ///< indices into q, each one moving all that the next does
  std::vector<int> links;                                          ///< indices into Robot::links: those that should touch
  FeelingSide side;                                                ///< with which they should
  double step = 0.03;                                              ///< rad (m) from posture to posture
  double give = 5e-4;                                              ///< m: how deep a link may be
};

struct PostureFound {
  int touching = 0;
  Eigen::VectorXd q;                                               ///< where so many touch; without any posture, empty
};

/// How many links of a chain of joints can touch a world at once: a search through all postures.
///
/// A link touches where its surface is no farther out of the world than 0 and no deeper in it than `give`, what things
/// give way under a light touch, with the side that feels; a set of links can touch where that is so for each and no
/// other link that these joints move reaches deeper.  Sets are tried from the largest on.  The gap of the link that the
/// k-th joint moves, and no later one, depends on the first k joints alone; so joint by joint, from the base: where
/// its link has to touch, all places between postures `step` apart where the depth passes 0, give/2 or give, found by
/// bisection; else all postures.  What begins and ends between two postures is missed; whether the chain can
/// get there without going through things is not asked.
class PostureSearch {
 public:
  /// Robot and model outlive it.  Throws std::invalid_argument when no joint moves a link, a link has no shape, or the
  /// joints are no chain.
  PostureSearch(const description::Robot& robot, const dynamics::Model& model, PostureSearchOptions options);

  /// `world` in world coordinates; joints of `q` (dof) that are not searched stay.
  PostureFound operator()(const geometry::Shape& world, const Eigen::VectorXd& q);

 private:
  /// What a joint moves and no later one of the chain.
  struct Stage {
    int joint = -1;
    std::vector<int> moved;                                        ///< links with shapes
  };
  struct Touch {
    double gap;                                                    ///< m, below 0 inside
    Eigen::Vector3d normal_L;                                      ///< unit, out of the link
  };

  /// `wanted`: a bit for each of options_.links.
  bool visit(std::size_t stage, unsigned wanted);
  /// Looks where `link` of stage `index` begins to be `depth` deep between two positions of its joint.
  bool touchesBetween(std::size_t index, int link, unsigned wanted, double low, double high, double depth);
  /// In the posture of q_: nothing that the stage moves is deeper than `give`, and what is wanted of it touches.
  bool isAllowed(const Stage& stage, unsigned wanted);
  bool isWanted(int link, unsigned wanted) const;
  /// Of a link in the posture of q_.
  Touch touchOf(int link);

  const description::Robot& robot_;
  const dynamics::Model& model_;
  dynamics::Workspace workspace_;
  PostureSearchOptions options_;
  std::vector<Stage> stages_;
  const geometry::Shape* world_ = nullptr;
  Eigen::VectorXd q_;
};

}  // namespace tactus::plugins
