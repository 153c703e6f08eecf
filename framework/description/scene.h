#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "framework/description/place.h"
#include "framework/geometry/compound.h"

/// The world around the robot as plain data.  SI units, world frame W, z up.
namespace tactus::description {

/// Posed in the object frame; geometry::Compound makes one shape of all.
using Primitive = geometry::PosedShape;

/// How a surface pushes back.  Normal force: Hunt–Crossley, k δ (1 + c δ̇) with δ the depth; friction: bristles, which
/// slip bends and rolling twists.
struct ContactMaterial {
  double stiffness = 2000;                                         ///< N/m
  double dissipation = 2;                                          ///< s/m
  double friction = 0.2;                                           ///< Coulomb coefficient μ
  double rolling = 0;                                              ///< m, ρ: a torque of up to ρN resists rolling and spinning
};

/// What decides where an object is.
enum class Mobility {
  fixed,                                                           ///< it stays at its pose
  free,                                                            ///< the forces on it
  held,                                                            ///< these, and a spring and damper to its path
  moved                                                            ///< its path alone, whatever touches it
};

/// Where an object, or what holds it, is to be at a time.
struct Waypoint {
  double time = 0;                                                 ///< s
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();          ///< object frame in W
};

/// Of what holds an object; each about all axes alike.
struct Holder {
  double stiffness = 500;                                          ///< N/m
  double damping = 15;                                             ///< N s/m
  double rotation_stiffness = 2;                                   ///< N m/rad
  double rotation_damping = 0.02;                                  ///< N m s/rad
  double until = std::numeric_limits<double>::infinity();          ///< s: then it lets go
};

/// Of an object that forces move, in its own frame.
struct MassProperties {
  double mass = 0;                                                 ///< kg
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();                ///< m
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();               ///< kg m², about the centre
};

/// The union of its primitives.
struct Object {
  std::string name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();          ///< object frame in W at time 0, jitter already drawn
  std::vector<Primitive> primitives;
  ContactMaterial material;
  Place place;
  Mobility mobility = Mobility::fixed;
  MassProperties mass;                                             ///< of free and held ones
  Holder holder;                                                   ///< of held ones
  std::vector<Waypoint> path;                                      ///< of held and moved ones, times rising; empty: its pose
};

/// Who takes part in a contact: an object, a link or, with neither, every link of the robot.
struct Party {
  int object = -1;                                                 ///< index into Scene::objects
  int link = -1;                                                   ///< index into Robot::links
  bool operator==(const Party&) const = default;
};

/// What holds between two parties instead of the usual rule, as far as it is said.
struct ContactPair {
  Party one, other;
  std::optional<double> stiffness, dissipation, friction, rolling;  ///< as in ContactMaterial
};

struct Scene {
  std::vector<Object> objects;
  std::vector<ContactPair> pairs;                                  ///< a later one wins over those before it
  Eigen::Vector3d gravity = Eigen::Vector3d(0, 0, -9.81);          ///< m/s²
};

/// Of two parties, each an object or a link, between which `usual` holds where no pair says otherwise.
ContactMaterial materialOf(const Scene& scene, const Party& one, const Party& other, ContactMaterial usual);

}  // namespace tactus::description
