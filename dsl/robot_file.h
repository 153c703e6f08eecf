#pragma once

#include <memory>
#include <string>
#include <string_view>
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

/// Planar, spherical or floating.
bool hasSeveralFreedoms(std::string_view joint_type);

/// Is that part of a joint's description, e.g. "limit", without use for a joint of that type?
bool isMeaningless(std::string_view joint_type, std::string_view part);

/// Warns of attributes that nothing reads and of elements whose names look like slips, from <robot> down; no element
/// stands more often than it is read.
void checkParts(const XmlElement& robot, Findings& findings);

/// Every mimic names another joint that moves, both have one degree of freedom, and none follows itself.
void checkMimics(const RobotFile& file, Findings& findings);

/// Adds what liburdfdom does not know: shapes that touch, rotor inertia, skin and groups.
void addTactusElements(const RobotFile& file, description::Robot& robot, Findings& findings);

}  // namespace tactus::dsl
