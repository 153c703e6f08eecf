#include "dsl/read_robot.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "dsl/findings.h"
#include "dsl/robot_file.h"
#include "dsl/urdf_tree.h"

namespace tactus::dsl {
namespace {

using description::Robot;

/// Mass of the body that a link is part of: its own and that of everything fixed to it.
double mergedMass(const Robot& robot, int link) {
  double mass = robot.links[static_cast<std::size_t>(link)].mass;
  for (const auto& joint : robot.joints)
    if (joint.parent == link && joint.type == description::JointType::fixed) mass += mergedMass(robot, joint.child);
  return mass;
}

/// Principal moments of a rigid body are positive and none is greater than the sum of the others.
bool isRigidBodyTensor(const Eigen::Matrix3d& inertia) {
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
  const double rounding = 1e-9 * moments.cwiseAbs().maxCoeff();
  return moments[0] > 0 && moments[2] <= moments[0] + moments[1] + rounding;
}

/// What makes the robot unfit for dynamics, but not for kinematics.
void warnOfMasses(const Robot& robot, const RobotFile& file, Findings& findings) {
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const auto& link = robot.links[i];
    const XmlElement& element = *file.links[i];
    const auto mover = std::find_if(robot.joints.begin(), robot.joints.end(),
                                    [&](const auto& joint) { return joint.child == static_cast<int>(i); });
    const bool moving = mover != robot.joints.end() && mover->type != description::JointType::fixed;
    if (!link.has_inertial) {
      if (moving && !(mergedMass(robot, static_cast<int>(i)) > 0))
        findings.warning(code::no_inertia, element,
                         "link '" + link.name + "' moves but has no <inertial>: the robot serves for kinematics only");
    } else if (!(link.mass > 0)) {
      if (moving || link.mass < 0)
        findings.warning(code::bad_mass, element,
                         "link '" + link.name + "' has a mass that is not positive: the robot cannot be simulated");
    } else if (!isRigidBodyTensor(link.inertia)) {
      findings.warning(code::bad_inertia, element,
                       "link '" + link.name + "' has an inertia tensor that no rigid body has: its principal moments "
                       "must be positive, and each at most the sum of the two others");
    }
  }
}

}  // namespace

Robot readRobot(const std::string& file, std::vector<Diagnostic>& warnings) {
  Findings findings;
  const RobotFile checked = checkRobotFile(file, findings);
  findings.throwErrors();
  Robot robot = buildUrdfTree(checked, findings);
  findings.throwErrors();
  addTactusElements(checked, robot, findings);
  findings.throwErrors();
  warnOfMasses(robot, checked, findings);
  warnings.insert(warnings.end(), findings.warnings().begin(), findings.warnings().end());
  return robot;
}

}  // namespace tactus::dsl
