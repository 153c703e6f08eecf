#pragma once

#include <string>
#include <vector>

#include "framework/description/robot.h"
#include "framework/dynamics/model.h"
#include "framework/dynamics/spatial.h"

/// What a description must keep to become a Model.
namespace tactus::dynamics {

/// What a finding is about.
enum class Fault {
  structure,                                                       ///< no tree: names given twice, loops, several roots
  number,                                                          ///< not finite, or out of its quantity's range
  mimic,                                                           ///< a joint follows what it cannot
  no_inertial,                                                     ///< a moving body of links that give no mass
  no_mass,                                                         ///< a moving body whose mass is given, and is 0
  inertia,                                                         ///< principal moments that no rigid body has
  centre_of_mass                                                   ///< was probably forgotten
};

struct RobotFinding {
  enum class Severity { error, warning };
  Severity severity = Severity::error;
  Fault fault = Fault::structure;
  std::string message;
  description::Place place;                                        ///< of the link or joint at fault
};

/// All that can be found wrong at once; bodies that depend on numbers that are wrong themselves are not judged.
/// Without errors Model takes the robot under the same policy; with errors it throws the first one.  Masses that only
/// dynamics need are warnings under MassPolicy::kinematics_only.  Always a warning: the tensor of a single link that no
/// body has, though the body of which it is a part may be sound, and a centre of mass that was probably forgotten.
///
/// A forgotten centre of mass stands exactly at the origin of a link that has mass and that a revolute or spherical
/// joint carries, while the middle of one of its shapes, or the origin of a joint on it that moves, lies more than 1 mm
/// beside the axis (of a ball: from its centre).  A link that reaches along its axis only, e.g. a flange, may well turn
/// about its centre of mass.
std::vector<RobotFinding> validate(const description::Robot& robot, MassPolicy policy = MassPolicy::required);

/// Names of a joint's numbers in q̇ ("base.wz") and in q ("base.qw"): the joint's own name when it has one number.
std::vector<std::string> coordinateNames(const description::Joint& joint);
std::vector<std::string> positionNames(const description::Joint& joint);

// The steps by which Model is built.  Each throws its first error as ModelError at the place of the fault.

/// One tree that hangs at robot.root, unique names, of coordinates too.  Returns all joints, fixed ones too, parents
/// first, the moving ones in the order of q.
std::vector<int> checkStructure(const description::Robot& robot);

/// How a joint's position follows from a coordinate: ratio · q + offset.
struct Drive {
  int driver = -1;                                                 ///< index into Robot::joints: the joint itself when free
  double ratio = 1;
  double offset = 0;
};

/// Of every joint, chains of mimics followed to their end; every driver can keep the limits of all that follow it.
/// After checkStructure.
std::vector<Drive> resolveMimics(const description::Robot& robot);

/// Finite masses, inertias, poses; unit axes; limits that leave room; nothing negative that cannot be.
void checkNumbers(const description::Robot& robot);

/// Mass, and principal moments about the centre of mass that a real body can have: positive, and none greater
/// than the sum of the two others.  `carrier` is the link that moves the body.
void checkBodyInertia(const RigidBodyInertia& inertia, const description::Link& carrier);

}  // namespace tactus::dynamics
