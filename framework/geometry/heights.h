#pragma once

#include <Eigen/Core>

#include "framework/geometry/triangle_mesh.h"

namespace tactus::geometry {

/// A field of heights as a closed mesh, for Mesh: heights(row, column) above z = 0 in m, columns along +x and rows
/// along +y, `spacing` (x, y) apart in m, the middle of the field at the origin.  Each square of four neighbours is cut
/// from its first corner to the opposite one; walls go down to z = `base`.  Throws std::invalid_argument unless there
/// are two rows and columns or more, numbers are finite, the spacing is above 0 and every height above the base.
TriangleMesh heightMesh(const Eigen::MatrixXd& heights, const Eigen::Vector2d& spacing, double base);

}  // namespace tactus::geometry
