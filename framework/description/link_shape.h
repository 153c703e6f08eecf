#pragma once

#include "framework/description/robot.h"
#include "framework/geometry/compound.h"

namespace tactus::description {

/// The solid that a link's shape is, posed in the link frame.
geometry::PosedShape solidOf(const LinkShape& shape);

}  // namespace tactus::description
