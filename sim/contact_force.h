#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "framework/control/sensed.h"
#include "framework/description/scene.h"
#include "sim/link_features.h"

namespace tactus::sim {

/// Numbers of the contact law that do not belong to a material.
struct ContactOptions {
  /// N: the normal force of one contact point saturates here, so that a deep start cannot blow the state up.
  double force_limit = 500;
  /// Bristle stiffness σ₀ over normal stiffness k.  Mindlin's value for equal elastic bodies is 0.7 to 1.
  double bristle_stiffness_ratio = 1;
  /// s: bristle damping σ₁ = relaxation · σ₀.
  double bristle_relaxation = 2e-3;
  /// m: a contact point buried deeper than this in another primitive carries no force (see below).
  double burial_fade = 1e-3;
};

/// Motion of a body frame in the world.
struct BodyMotion {
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_W = Eigen::Vector3d::Zero();             ///< rad/s
  Eigen::Vector3d linear_W = Eigen::Vector3d::Zero();              ///< m/s, of the frame's origin
};

/// What the world does to a body, at the origin of its frame.
struct BodyWrench {
  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_W = Eigen::Vector3d::Zero();
};

/// Compliant contact of link capsules with the primitives of a fixed scene.
///
/// **Where.**  A capsule of axis a–b touches a convex primitive at up to three points: its two end spheres, and one
/// between them at p(t) = a + t (b − a).  Depth δ = r − d(p) with d the signed distance.  The interior point has the
/// weight w = 4t(1−t), so that it fades into the ends, and stands where its elastic energy ½ k w δ² is greatest:
/// this t is unique (w δ² is log-concave, as d is convex) and continuous in the pose, and by the envelope theorem
/// the normal force k w δ at fixed t is the gradient of that energy, so that elastic contact conserves energy.
///
/// **Normal** (Hunt and Crossley, 1975).  N = w β k δ (1 + c δ̇), clamped to [0, force_limit].
///
/// **Friction** (elastic-plastic bristle; Dupont et al., IEEE TAC 2002).  Each point bends a tangential bristle z by
/// its slip, ż = v_t, |σ₀ z| ≤ μN, and feels −(σ₀ z + σ₁ v_t), again at most μN.  A loaded bristle keeps its bend, so
/// a held body does not creep.  The bends are the force's own state: `evaluate` proposes them, `commit` keeps them.
///
/// **Unions.**  A point whose place on the surface lies inside another primitive, of any object, is buried: nothing
/// can be felt there.  β falls smoothly (smoothstep) from 1 at the other's surface to 0 at `burial_fade` below it.
///
/// Pairs are visited in the order (link, feature, object, primitive) and yield one record each in that order.
/// Bounding spheres sort out far pairs.  Nothing is allocated after construction.
class ContactForce {
 public:
  /// The features' bodies are numbered from 0 to `bodies` − 1.
  ContactForce(const std::vector<LinkFeature>& features, const description::Scene& scene, int bodies,
               const ContactOptions& options = {});

  /// Finds all touches of the bodies in this motion and their forces; bristles slip for h seconds.
  void evaluate(const std::vector<BodyMotion>& bodies, double h);
  /// Keeps the bristles of the last evaluation: call once per accepted step.
  void commit();

  /// By body, of the last evaluation; zero for a body that touches nothing.
  const std::vector<BodyWrench>& wrenches() const { return wrenches_; }
  /// One record per touching pair of the last evaluation; `records` is overwritten.
  void read(std::vector<control::ContactRecord>& records) const;
  /// The most records that there can be.
  int capacity() const { return static_cast<int>(features_.size() * primitives_.size()); }

 private:
  static constexpr int points_per_pair = 3;                        // from, to, interior
  using Bristles = Eigen::Matrix<double, 3, points_per_pair>;      // bends (m), world axes, one column a point

  struct ScenePrimitive {
    int object;
    std::shared_ptr<const geometry::Shape> shape;
    Eigen::Matrix3d R_WP;
    Eigen::Vector3d p_WP;
    double bounding_radius;
    description::ContactMaterial material;
    std::vector<int> overlapping;                                  // other primitives that can bury its surface
  };
  struct Touch {
    int feature;
    int primitive;
    double depth = 0;                                              // of the deepest point
    double weight_N = 0;                                           // Σ N, weighs the points
    Eigen::Vector3d weighted_point_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d deepest_point_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d deepest_normal_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal_force_W = Eigen::Vector3d::Zero();      // Σ, on the object
    Eigen::Vector3d friction_force_W = Eigen::Vector3d::Zero();    // Σ, on the object
    Bristles bristles = Bristles::Zero();
  };
  /// One contact point of a pair, in the primitive's frame.
  struct Point;

  void touchPair(int feature, int primitive, const BodyMotion& body, double h);
  void press(const Point& point, const ScenePrimitive& primitive, const BodyMotion& body, double h, int slot,
             Touch& touch);
  double exposure(const ScenePrimitive& primitive, const Eigen::Vector3d& surface_point_W) const;
  int pairIndex(const Touch& touch) const {
    return touch.feature * static_cast<int>(primitives_.size()) + touch.primitive;
  }

  ContactOptions options_;
  std::vector<LinkFeature> features_;
  std::vector<ScenePrimitive> primitives_;
  std::vector<Bristles> bristles_;                                 // committed, by pair
  std::vector<int> bent_;                                          // pairs whose committed bristles are not zero
  std::vector<Touch> touches_;                                     // of the last evaluation
  std::vector<BodyWrench> wrenches_;                               // by body
};

}  // namespace tactus::sim
