#pragma once

#include <Eigen/Core>

#include "framework/description/scene.h"

/// Signed distance from a point to the surface of a primitive, in the primitive's own frame: exact (Euclidean)
/// outside and inside, negative inside.  The gradient is the outward unit normal at the nearest surface point,
/// p − distance · gradient.  All primitives are convex, so every distance is a convex function of p.  On the
/// medial set, where several surface points are equally near (a box's inner diagonal planes, a sphere's centre,
/// a cylinder's axis), one of them is taken, always the same.
namespace tactus::sim {

struct SignedDistance {
  double distance = 0;                                             ///< m
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitZ();             ///< unit
};

SignedDistance signedDistance(const description::PlanePrimitive& plane, const Eigen::Vector3d& p);
SignedDistance signedDistance(const description::BoxPrimitive& box, const Eigen::Vector3d& p);
SignedDistance signedDistance(const description::SpherePrimitive& sphere, const Eigen::Vector3d& p);
SignedDistance signedDistance(const description::CylinderPrimitive& cylinder, const Eigen::Vector3d& p);
SignedDistance signedDistance(const description::CapsulePrimitive& capsule, const Eigen::Vector3d& p);
SignedDistance signedDistance(const description::PrimitiveShape& shape, const Eigen::Vector3d& p);

/// Radius of the smallest sphere about the primitive's origin that holds it; infinite for a plane.
double boundingRadius(const description::PrimitiveShape& shape);

}  // namespace tactus::sim
