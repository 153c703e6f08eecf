#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <vector>

/// How well a set of contacts holds an object: the grasp wrench space and its two classical figures.
namespace tactus::plugins {

/// A hard contact of a finger on an object.
struct GraspContact {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();              ///< m
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();                ///< into the object; any length but 0
};

struct GraspWrenchOptions {
  double friction = 0.5;                                           ///< μ ≥ 0, Coulomb
  int edges = 8;                                                   ///< of the linearised cone, ≥ 3
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();                ///< m, about which torques are taken
  double scale = 1;                                                ///< m, ρ > 0: torques over it are as forces
};

struct GraspWrenchSpace {
  double epsilon = 0;                                              ///< radius of the largest ball about 0 inside; 0: none
  double volume = 0;
  int rank = 0;                                                    ///< of the wrenches; below 6 the hull is flat
};

/// The hull of these contacts could not be found.
class HullError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The primitive wrenches, columns (f, (p − c) × f / ρ) for each edge of each contact's cone: f = n + μ (cos θ t₁ +
/// sin θ t₂), θ = 2πk/edges, with n of length 1, t₁ = n × x̂ normalised (n × ŷ where |n_x| ≥ 0.9), t₂ = n × t₁.
/// Throws std::invalid_argument for what is not finite, a normal of no length, and options out of their bounds.
Eigen::Matrix<double, 6, Eigen::Dynamic> primitiveWrenches(const std::vector<GraspContact>& contacts,
                                                           const GraspWrenchOptions& options);

/// The convex hull of all primitive wrenches and 0 (the L1 grasp wrench space): what the contacts can resist when their
/// normal forces sum to at most 1 N.  ε is the distance from 0 to the nearest facet (Ferrari and Canny, "Planning
/// optimal grasps", ICRA 1992).  The hull is Qhull's (option Qt, no joggling: it repeats to the bit).
/// Throws as above, and HullError.
GraspWrenchSpace graspWrenchSpace(const std::vector<GraspContact>& contacts, const GraspWrenchOptions& options);

}  // namespace tactus::plugins
