#pragma once

#include <vector>

#include "framework/geometry/shape.h"

/// What every shape keeps, whatever it looks like, at random points in and around its bounding sphere (about the origin
/// for one without end), R below; seeds are fixed.
///
///   finite       distance and gradient are numbers, the gradient of unit length to 1e-9: at random points, on its
///                axes, at its origin, on its surface, and at 1000 R.
///   gradient     it is the direction of the distance's differences, to 1e-5, away from ridges, where it turns; and
///                these are of unit length, to 1e-5, where the shape is exact.
///   lipschitz    no two distances differ by more than the points are apart, and twice the error; and nowhere does the
///                distance jump: points 1e-7 R apart differ by at most four times as much.
///   foot         p − distance · gradient lies on the surface for p outside, and not outside it for p inside: to 1e-9 R
///                where the shape is exact, else to 4 errors and 0.3 of the distance, away from ridges.
///   bounding     no point outside the bounding sphere is nearer to the shape than to the sphere.
///   support      there is one in every direction if the bounding radius is finite; it lies on the surface, and no foot
///                lies farther out.
///   convex       where it is claimed: half way between two points the distance is at most the mean of theirs.
///   determinism  the same point has the same distance and gradient to the byte, whatever was asked between.
///   allocation   a distance takes no memory.
namespace tactus::conformance {

struct ShapeLaw {
  const char* name;
  void (*check)(const geometry::Shape& shape);                     ///< throws Broken, NotAsked
};

const std::vector<ShapeLaw>& shapeLaws();

}  // namespace tactus::conformance
