#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "framework/description/place.h"
#include "framework/geometry/compound.h"

/// The world around the robot as plain data.  SI units, world frame W, z up.
namespace tactus::description {

/// Posed in the object frame; geometry::Compound makes one shape of all.
using Primitive = geometry::PosedShape;

/// How a surface pushes back.  Normal force: Hunt–Crossley, k δ (1 + c δ̇) with δ the depth; friction: bristles.
struct ContactMaterial {
  double stiffness = 2000;                                         ///< N/m
  double dissipation = 2;                                          ///< s/m
  double friction = 0.2;                                           ///< Coulomb coefficient μ
};

/// A fixed object: the union of its primitives.
struct Object {
  std::string name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();          ///< object frame in W, jitter already drawn
  std::vector<Primitive> primitives;
  ContactMaterial material;
  Place place;
};

struct Scene {
  std::vector<Object> objects;
  Eigen::Vector3d gravity = Eigen::Vector3d(0, 0, -9.81);          ///< m/s²
};

}  // namespace tactus::description
