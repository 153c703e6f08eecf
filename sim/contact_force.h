#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <vector>

#include "framework/control/archive.h"
#include "framework/control/sensed.h"
#include "framework/description/scene.h"
#include "sim/contact_surfaces.h"

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

/// Compliant contact between the surfaces of bodies (see contact_surfaces.h).
///
/// **Where.**  A feature of axis a–b touches a convex shape at up to three points: its two end spheres, and one
/// between them at p(t) = a + t (b − a).  Depth δ = r − d(p) with d the signed distance.  The interior point has the
/// weight w = 4t(1−t), so that it fades into the ends, and stands where its elastic energy ½ k w δ² is greatest:
/// this t is unique (w δ² is log-concave, as d is convex) and continuous in the pose, and by the envelope theorem
/// the normal force k w δ at fixed t is the gradient of that energy, so that elastic contact conserves energy.
/// Of a shape that is not convex the energy has several maxima, across the rim of a cup for one: up to three are found
/// among 17 samples, the greatest first, and each but the greatest counts as far as it stands out: by the smoothstep of
/// (E − E_saddle)/0.2 E, so that it comes and goes without a jump.
///
/// **Normal** (Hunt and Crossley, 1975).  N = w β k δ (1 + c δ̇), clamped to [0, force_limit]; δ̇ is that of both bodies.
///
/// **Friction** (elastic-plastic bristle; Dupont et al., IEEE TAC 2002).  Each point bends a tangential bristle z by
/// its slip, ż = v_t, |σ₀ z| ≤ μN, and feels −(σ₀ z + σ₁ v_t), again at most μN.  A loaded bristle keeps its bend, so
/// a held body does not creep; it turns with the body of the shape.  The bends are the force's own state: `evaluate`
/// proposes them, `commit` keeps them.
///
/// **Rolling** and spinning of a round feature (radius r > 0) twist a bristle by the angle that the bodies turn against
/// each other, φ̇ = ω, |κ φ| ≤ ρN with κ = σ₀ r², and feel the torque −κ (φ + relaxation · ω), at most ρN.
///
/// **Unions.**  A point whose place on the surface lies inside another shape of the same body is buried: nothing can be
/// felt there.  β falls smoothly (smoothstep) from 1 at the other's surface to 0 at `burial_fade` below it.  All that is
/// fixed in the world is one body.
///
/// Pairs are visited in their order and yield one record each in that order, as far as the robot is part of them.
/// Bounding spheres sort out far pairs.  Nothing is allocated after construction.
class ContactForce {
 public:
  /// Bodies are numbered from 0 to `bodies` − 1.
  ContactForce(std::vector<Feature> features, std::vector<Collider> colliders, std::vector<SurfacePair> pairs, int bodies,
               const ContactOptions& options = {});
  /// Every feature against every shape of a scene that stays where it is.
  ContactForce(const std::vector<Feature>& features, const description::Scene& scene, int bodies,
               const ContactOptions& options = {});

  /// Finds all touches of the bodies in this motion and their forces; bristles slip for h seconds.
  void evaluate(const std::vector<BodyMotion>& bodies, double h);
  /// Keeps the bristles of the last evaluation: call once per accepted step.
  void commit();

  /// What is committed.  Throws StateError where the state has other pairs.
  void archive(control::Archive& archive);

  /// By body, of the last evaluation; zero for a body that touches nothing.
  const std::vector<BodyWrench>& wrenches() const { return wrenches_; }
  /// One record per pair of a link and something else that touched in the last evaluation; `records` is overwritten.
  void read(std::vector<control::ContactRecord>& records) const;
  /// The most records that there can be.
  int capacity() const { return static_cast<int>(pairs_.size()); }

 private:
  static constexpr int most_interior = 3;
  static constexpr int points_per_pair = 2 + most_interior;        // from, to, interior ones
  using Bristles = Eigen::Matrix<double, 3, points_per_pair>;      // bends (m), world axes, one column a point

  struct Touch {
    int pair;
    double depth = 0;                                              // of the deepest point
    double weight_N = 0;                                           // Σ N, weighs the points
    Eigen::Vector3d weighted_point_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d deepest_point_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d deepest_normal_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal_force_W = Eigen::Vector3d::Zero();      // Σ, of the feature on the collider
    Eigen::Vector3d friction_force_W = Eigen::Vector3d::Zero();    // Σ, of the feature on the collider
    Bristles bristles = Bristles::Zero();
    Bristles twists = Bristles::Zero();                            // rad
    /// t of interior points; NaN where there is none
    Eigen::Matrix<double, most_interior, 1> places = Eigen::Matrix<double, most_interior, 1>::Constant(std::nan(""));
  };
  /// What is committed of a pair, for the archive.
  struct Bent {
    int pair = 0;
    Bristles bristles, twists;
    Eigen::Matrix<double, most_interior, 1> places;
    void archive(control::Archive& archive) {
      archive("pair", pair);
      archive("bristles", bristles);
      archive("twists", twists);
      archive("places", places);
    }
  };
  /// Where a collider is and how it moves, in this evaluation.
  struct Posed {
    Eigen::Matrix3d R_WP;
    Eigen::Vector3d p_WP;
  };
  /// One contact point of a pair, in the shape's frame.
  struct Point;

  void clear();
  void pose(const std::vector<BodyMotion>& bodies);
  void touchPair(int pair, const BodyMotion& of_feature, const BodyMotion& of_collider, double h);
  int findInterior(const geometry::Shape& shape, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                   double depth_a, double depth_b, Point* points) const;
  void assignSlots(int pair, int count, const Point* points, int* slots) const;
  void press(const Point& point, int pair, const BodyMotion& of_feature, const BodyMotion& of_collider, double h, int slot,
             Touch& touch);
  double exposure(int collider, const Eigen::Vector3d& surface_point_W) const;
  const BodyMotion& motionOf(int body, const std::vector<BodyMotion>& bodies) const;

  ContactOptions options_;
  std::vector<Feature> features_;
  std::vector<Collider> colliders_;
  std::vector<SurfacePair> pairs_;
  std::vector<std::vector<int>> burying_;                          // by collider: those of its body that may lie over it
  std::vector<Posed> posed_;                                       // by collider
  std::vector<Bristles> bristles_, twists_;                        // committed, by pair
  std::vector<Eigen::Matrix<double, most_interior, 1>> places_;    // committed, by pair
  std::vector<int> bent_;                                          // pairs whose committed bristles are not zero
  std::vector<Touch> touches_;                                     // of the last evaluation
  std::vector<BodyWrench> wrenches_;                               // by body
};

}  // namespace tactus::sim
