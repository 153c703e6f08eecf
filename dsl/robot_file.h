#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dsl/findings.h"
#include "dsl/xml_file.h"
#include "framework/description/robot.h"

namespace tactus::dsl {

/// A URDF text that passed Tactus's own checks: names, references, types, limits and every number that is used.
struct RobotFile {
  std::unique_ptr<XmlElement> root;
  std::vector<const XmlElement*> links;                            ///< in file order
  std::vector<const XmlElement*> joints;
};

/// Reads and checks; what is wrong goes to `findings`.
RobotFile checkRobotFile(const std::string& file, Findings& findings);

/// Adds what liburdfdom does not know: shapes that touch, rotor inertia, skin and groups.
void addTactusElements(const RobotFile& file, description::Robot& robot, Findings& findings);

}  // namespace tactus::dsl
