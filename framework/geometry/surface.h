#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/geometry/compound.h"
#include "framework/geometry/triangle_mesh.h"

/// Surfaces of shapes as triangles, for pictures: what Shape::surface() is made by.
namespace tactus::geometry {

inline constexpr int steps_a_turn = 48;                            ///< of what is round

/// What a profile sweeps in a whole turn about z.  Points (ρ, z), m, one after another, what is inside to the left; the
/// profile is closed, or begins and ends on the axis.
TriangleMesh lathe(const std::vector<Eigen::Vector2d>& profile);
/// Points of a circle's arc about `centre` from angle `from` to `to` (rad, from +ρ towards +z), both ends included.
std::vector<Eigen::Vector2d> arc(const Eigen::Vector2d& centre, double radius, double from, double to);

/// Of any shape that has ends, from its distance alone (naive surface nets, Gibson 1998): one vertex in each cell that
/// the surface passes through, moved onto the surface; `cells` along the longest side.  Edges are cut off by up to a
/// cell, and what is thinner than a cell may be missing.
TriangleMesh surfaceNets(const Shape& shape, int cells = 48);

/// The surfaces of all parts in the frame of the whole, those inside of others too.
TriangleMesh surfaceOf(const std::vector<PosedShape>& parts);

}  // namespace tactus::geometry
