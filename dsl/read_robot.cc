#include "dsl/read_robot.h"

#include "dsl/findings.h"
#include "dsl/robot_file.h"
#include "dsl/urdf_tree.h"
#include "framework/dynamics/check_robot.h"

namespace tactus::dsl {
namespace {

using description::Robot;

const Code& codeOf(dynamics::Fault fault) {
  switch (fault) {
    case dynamics::Fault::no_inertial: return code::no_inertia;
    case dynamics::Fault::no_mass: return code::bad_mass;
    case dynamics::Fault::inertia: return code::bad_inertia;
    case dynamics::Fault::centre_of_mass: return code::forgotten_centre;
    case dynamics::Fault::mimic: return code::bad_mimic;
    case dynamics::Fault::structure:
    case dynamics::Fault::number: break;
  }
  return code::impossible_robot;
}

const XmlElement& elementAt(const description::Place& place, const RobotFile& file) {
  for (const auto* list : {&file.links, &file.joints})
    for (const XmlElement* element : *list)
      if (element->place().line == place.line && element->place().column == place.column) return *element;
  return *file.root;
}

/// What no reader of XML can see.  Faults of masses hinder dynamics alone, and are warnings here.
void addValidation(const Robot& robot, const RobotFile& file, Findings& findings) {
  for (const auto& found : dynamics::validate(robot, dynamics::MassPolicy::kinematics_only)) {
    const XmlElement& part = elementAt(found.place, file);
    const XmlElement* mimic = found.fault == dynamics::Fault::mimic ? part.child("mimic") : nullptr;
    const XmlElement& element = mimic ? *mimic : part;
    if (found.severity == dynamics::RobotFinding::Severity::error) {
      findings.error(codeOf(found.fault), element, found.message);
    } else {
      findings.warning(codeOf(found.fault), element, found.message);
    }
  }
}

Robot read(const std::string& file, Findings& findings) {
  const RobotFile checked = checkRobotFile(file, findings);
  findings.throwErrors();
  Robot robot = buildUrdfTree(checked, findings);
  findings.throwErrors();
  addTactusElements(checked, robot, findings);
  findings.throwErrors();
  addValidation(robot, checked, findings);
  findings.throwErrors();
  return robot;
}

}  // namespace

Robot readRobot(const std::string& file, std::vector<Diagnostic>& warnings) {
  Findings findings;
  const auto giveWarnings = [&] {
    warnings.insert(warnings.end(), findings.warnings().begin(), findings.warnings().end());
  };
  try {
    Robot robot = read(file, findings);
    giveWarnings();
    return robot;
  } catch (const InvalidStack&) {
    giveWarnings();
    throw;
  }
}

}  // namespace tactus::dsl
