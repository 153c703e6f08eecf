#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "framework/description/robot.h"
#include "framework/description/scene.h"
#include "framework/geometry/shape.h"

/// What can touch what: surfaces of bodies, told twice.  A *feature* is a capsule, a sphere or a point of a body that
/// feels for the others; a *collider* is a shape that it feels.  Every contact is one feature against one collider.
namespace tactus::sim {

/// Fixed in the world.
inline constexpr int world_body = -1;

/// Whose surface it is: a link's or an object's.
struct Owner {
  int link = -1;                                                   ///< index into description::Robot::links
  int object = -1;                                                 ///< index into description::Scene::objects
  bool operator==(const Owner&) const = default;
};

inline description::Party partyOf(const Owner& owner) { return {.object = owner.object, .link = owner.link}; }

/// A feeler of a body.
struct Feature {
  Owner owner;
  int body = world_body;                                           ///< the body that carries it, an engine's index
  geometry::Feeler feeler;                                         ///< body frame
};

struct Collider {
  Owner owner;
  int body = world_body;
  std::shared_ptr<const geometry::Shape> shape;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();          ///< shape frame in the body's
};

/// A feature and a collider that may touch.
struct SurfacePair {
  int feature = 0;
  int collider = 0;
  description::ContactMaterial material;
};

/// The features of all links, in the order of links and of their shapes; each link is its own body.
///
/// A box becomes a row of equal capsules inside it: the radius is half of the shortest edge, the capsules lie
/// along the longest edge and stand side by side along the middle one, at most one radius apart, the outer ones
/// against the faces.  Every outer face is thus touched from within.  Rounding: edges and corners become round
/// with that radius r, and between two neighbours s ≤ r apart the wide faces sink by r − √(r² − s²/4) ≤ 0.134 r,
/// which a flat object does not reach.
std::vector<Feature> linkFeatures(const description::Robot& robot);

/// The colliders of all links, in the order of links and of their shapes; each link is its own body.
std::vector<Collider> linkColliders(const description::Robot& robot);

/// Those of an object that can move, by the feelers of its shapes, in its own frame.
std::vector<Feature> objectFeatures(const description::Object& object, int index);

/// All colliders of an object, in its own frame.
std::vector<Collider> objectColliders(const description::Object& object, int index);

}  // namespace tactus::sim
