#pragma once

#include <string>
#include <vector>

#include "dsl/diagnostic.h"
#include "framework/description/robot.h"

namespace tactus::dsl {

/// Reads a URDF file.  The tree and its numbers come from liburdfdom; capsules, rotors, skin, groups, spherical
/// joints and every place come from Tactus's own scan of the same text.  Throws InvalidStack for what cannot be a
/// robot; what makes it unfit for dynamics only (no mass, a tensor that breaks the triangle inequality, …) is a warning
/// here, located at the link, and ModelError when dynamics are asked for.  See dynamics::validate.  Warnings are
/// added to `warnings` when it throws, too.
description::Robot readRobot(const std::string& file, std::vector<Diagnostic>& warnings);

}  // namespace tactus::dsl
