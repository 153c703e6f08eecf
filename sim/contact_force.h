#pragma once

#include <Eigen/Geometry>
#include <cmath>
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
///
/// Of a shape that is not convex a round feature (r > 0) touches every piece (see geometry::Piece) in this way: both
/// sides of a hollow, the near and the far side of a ring.  A piece that is not convex itself has several maxima along
/// the axis, across the rim of a cup for one: up to three, the greatest of those among 65 samples.  Its energy is the
/// sum over maxima less that over the minima between them, so that a maximum comes and goes without a jump.
///
/// What is taken off, at minima and where pieces have something in common, is a *pass* between two points.  It is
/// elastic contact like any other with its sign turned: −∇E is the normal force.  A pass bears no friction; its normal
/// force N is taken off what presses its two neighbours' bristles, in proportion to how little each stands out above it:
/// N (E_j − E)/(E_i + E_j − 2E) off i.  So a point that is about to vanish in a pass bears none, and no bristle jumps.
///
/// **Normal** (Hunt and Crossley, 1975).  N = w β k δ |∇d| (1 + c δ̇), clamped to [0, force_limit]; δ̇ is that of both
/// bodies, and |∇d| = 1 but where distances are interpolated (SignedDistance::steepness).
///
/// **Friction** (elastic-plastic bristle; Dupont et al., IEEE TAC 2002).  Each point bends a tangential bristle z by
/// its slip, ż = v_t, |σ₀ z| ≤ μN, and feels −(σ₀ z + σ₁ v_t), again at most μN.  A loaded bristle keeps its bend, so
/// a held body does not creep; it turns with the body of the shape.  Where its stiffness grows (σ₀ is in proportion to β w),
/// what is new is not bent: the force stays, and the energy does not grow.  The bends are the force's own state: `evaluate`
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
  /// J, of the last evaluation: in springs, Σ ± ½ β k w δ², and bristles, Σ ½ σ₀ z² + Σ ½ κ φ².
  double elasticEnergy() const { return elastic_energy_; }
  /// One record per pair of a link and something else that touched in the last evaluation; `records` is overwritten.
  void read(std::vector<control::ContactRecord>& records) const;
  /// The most records that there can be.
  int capacity() const { return static_cast<int>(pairs_.size()); }

 private:
  static constexpr int most_interior = 3;                          // maxima along the axis
  static constexpr int slots = 2 + most_interior;                  // of bristles, a piece: from, to, interior ones

  struct Touch {
    int pair;
    double depth = 0;                                              // of the deepest point
    double weight_N = 0;                                           // Σ N, weighs the points
    Eigen::Vector3d weighted_point_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d deepest_point_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d deepest_normal_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal_force_W = Eigen::Vector3d::Zero();      // Σ, of the feature on the collider
    Eigen::Vector3d friction_force_W = Eigen::Vector3d::Zero();    // Σ, of the feature on the collider
  };
  struct Bristle {
    Eigen::Vector3d bend_W = Eigen::Vector3d::Zero();              // m
    Eigen::Vector3d twist_W = Eigen::Vector3d::Zero();             // rad
    double stiffness = 0;                                          // N/m
    double t = std::nan("");                                       // of an interior point; NaN: none stands there
    void archive(control::Archive& archive) {
      archive.finite("bend", bend_W);
      archive.finite("twist", twist_W);
      archive("stiffness", stiffness);
      archive("t", t);
    }
  };
  /// Where a collider is and how it moves, in this evaluation.
  struct Posed {
    Eigen::Matrix3d R_WP;
    Eigen::Vector3d p_WP;
  };
  /// A piece of a collider; `shape` is the collider's own where that is one piece.
  using Pieces = std::vector<geometry::Piece>;
  /// One contact point of the pair at hand.
  struct Point {
    int piece;
    int slot;                                                      // −1 of a pass
    double sign;
    double weight;
    double t;
    double depth;
    Eigen::Vector3d p_P;                                           // on the feature's axis, in the shape's frame
    geometry::SignedDistance nearest;
    int between[2] = {-1, -1};                                     // of a pass: two points, −1 where one is not there
    // What follows from the motion:
    Eigen::Vector3d surface_W = Eigen::Vector3d::Zero(), normal_W = surface_W, velocity_W = surface_W;
    double stiffness = 0, normal_N = 0;
    double relief_N = 0;                                           // that passes take off
    double height() const { return weight * depth * depth; }
  };
  /// A feature's axis in the shape's frame.
  struct Axis {
    Eigen::Vector3d a, b;
    double radius;
    bool ends;
  };

  void clear();
  void pose(const std::vector<BodyMotion>& bodies);
  const Pieces& piecesFor(const SurfacePair& pair) const;
  void touchPair(int pair, const BodyMotion& of_feature, const BodyMotion& of_collider, double h);
  void findPoints(int pair, int piece, const Axis& axis);
  void findInterior(const geometry::Piece& piece, int number, const Axis& axis, double depth_a, double depth_b);
  void assignSlots(int pair, int piece, int first_point);
  void findNeighbours(int pair);
  void measure(Point& point, int pair, const BodyMotion& of_feature, const BodyMotion& of_collider) const;
  void relieve();
  void press(const Point& point, int pair, const BodyMotion& of_feature, const BodyMotion& of_collider, double h,
             Touch& touch);
  Eigen::Vector3d bent(double stiffness, const Eigen::Vector3d& rate, double limit, Eigen::Vector3d& bend) const;
  double exposure(int collider, const Eigen::Vector3d& surface_point_W) const;
  const BodyMotion& motionOf(int body, const std::vector<BodyMotion>& bodies) const;

  ContactOptions options_;
  std::vector<Feature> features_;
  std::vector<Collider> colliders_;
  std::vector<SurfacePair> pairs_;
  std::vector<std::vector<int>> burying_;                          // by collider: those of its body that may lie over it
  std::vector<Posed> posed_;                                       // by collider
  std::vector<Pieces> wholes_, pieces_;                            // by collider: itself alone; what it consists of
  std::vector<int> first_bristle_;                                 // by pair, and one more: the end
  std::vector<Bristle> bristles_, next_bristles_;                  // committed; of the last evaluation where it touched
  std::vector<int> bent_;                                          // pairs whose committed bristles are not straight
  std::vector<Point> points_;                                      // of the pair at hand
  std::vector<Touch> touches_;                                     // of the last evaluation
  double elastic_energy_ = 0;
  std::vector<BodyWrench> wrenches_;                               // by body
};

}  // namespace tactus::sim
