#pragma once

#include "framework/description/robot.h"
#include "framework/geometry/compound.h"

namespace tactus::description {

/// The solid that a link's shape is, posed in the link frame.
geometry::PosedShape solidOf(const LinkShape& shape);

/// The middle of the link's shapes in the link frame ("the geometrical center of the links", thesis 4.3.2); of a link
/// without any its centre of mass.
Eigen::Vector3d middleOf(const Link& link);

}  // namespace tactus::description
