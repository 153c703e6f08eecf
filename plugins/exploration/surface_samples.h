#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "framework/description/robot.h"
#include "framework/description/scene.h"
#include "framework/dynamics/model.h"

namespace tactus::exploration {

/// A point of an object's surface.
struct SurfaceSample {
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();               ///< m
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();             ///< unit, out of the object
};

/// `count` points of an object at time 0, drawn evenly by area with a fixed seed; what lies inside of another of its
/// shapes, or of another object, is no surface and is left out.  None for objects without end.
std::vector<SurfaceSample> sampleSurface(const description::Scene& scene, int object, int count);

struct ReachOptions {
  std::vector<int> links;                                          ///< indices into Robot::links: one of them must get there
  std::vector<int> clear;                                          ///< and these must be outside of all objects then
  Eigen::Vector3d pad_axis = Eigen::Vector3d::UnitX();             ///< of these links, towards the surface
  int turns = 8;                                                   ///< of the link about the surface's normal
  double tolerance = 0.005;                                        ///< m, of the point that touches
  double angle_weight = 0.02;                                      ///< m: an error of 1 rad counts as so many metres
};

/// Whether the robot can put the pad of one of the links there: inverse kinematics, over all its joints within their
/// limits, brings the point of the link's shapes that is farthest along `pad_axis` to the sample, with the axis into
/// the surface, turned about the normal in one of `turns` ways, while the links that must be clear touch nothing.  Searches
/// begin at `start_q` and where the last one was found, so "no" means: not found.
class Reach {
 public:
  Reach(const description::Robot& robot, const description::Scene& scene, const dynamics::Model& model,
        const Eigen::VectorXd& start_q, ReachOptions options);
  bool operator()(const SurfaceSample& sample);

 private:
  bool isClear(const Eigen::VectorXd& q) const;
  bool tryFrom(const Eigen::VectorXd& start, const SurfaceSample& sample, int link, double turn);

  const description::Robot& robot_;
  const description::Scene& scene_;
  const dynamics::Model& model_;
  Eigen::VectorXd start_q_, found_q_;
  ReachOptions options_;
  std::vector<Eigen::Vector3d> pads_;                              ///< of options.links, link frame
};

}  // namespace tactus::exploration
