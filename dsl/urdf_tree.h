#pragma once

#include "dsl/robot_file.h"

namespace tactus::dsl {

/// Tree and numbers as liburdfdom reads them from the checked text, in the file's order, with places.
description::Robot buildUrdfTree(const RobotFile& file, Findings& findings);

}  // namespace tactus::dsl
