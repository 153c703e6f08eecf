#pragma once

#include <vector>

#include "framework/description/robot.h"
#include "framework/dynamics/spatial.h"

/// What a description must keep to become a Model.  Each check throws ModelError at the place of the fault.
namespace tactus::dynamics {

/// One tree that hangs at robot.root, unique names.  Returns all joints, fixed ones too, parents first, the moving
/// ones in the order of q.
std::vector<int> checkStructure(const description::Robot& robot);

/// How a joint's position follows from a coordinate: ratio · q + offset.
struct Drive {
  int driver = -1;                                                 ///< index into Robot::joints: the joint itself when free
  double ratio = 1;
  double offset = 0;
};

/// Of every joint, chains of mimics followed to their end.  After checkStructure.
std::vector<Drive> resolveMimics(const description::Robot& robot);

/// Finite masses, inertias, poses; unit axes; limits that leave room; nothing negative that cannot be.
void checkNumbers(const description::Robot& robot);

/// Mass, and principal moments about the centre of mass that a real body can have: positive, and none greater
/// than the sum of the two others.  `carrier` is the link that moves the body.
void checkBodyInertia(const RigidBodyInertia& inertia, const description::Link& carrier);

}  // namespace tactus::dynamics
