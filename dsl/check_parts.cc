#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "dsl/nearest_name.h"
#include "dsl/robot_file.h"

namespace tactus::dsl {
namespace {

/// What an element of a robot file may hold, as far as anything reads it.  Elements that check their own attributes,
/// e.g. <mimic>, have no row.
struct Grammar {
  std::string element;
  std::vector<std::string> attributes;
  std::vector<std::string> single;                                 ///< children that stand once at most
  std::vector<std::string> many;                                   ///< children that may stand several times
};

const std::vector<Grammar>& grammars() {
  static const std::vector<Grammar> rows{
      {"robot", {"name", "version", "xmlns"}, {}, {"link", "joint", "material", "transmission", "gazebo", "tactus"}},
      {"link", {"name", "type"}, {"inertial"}, {"visual", "collision"}},
      {"inertial", {}, {"origin", "mass", "inertia"}, {}},
      {"collision", {"name"}, {"origin", "geometry", "capsule"}, {}},
      {"joint",
       {"name", "type"},
       {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "rotor", "safety_controller", "calibration"},
       {}},
      {"origin", {"xyz", "rpy"}, {}, {}},
      {"mass", {"value"}, {}, {}},
      {"inertia", {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, {}, {}},
      {"parent", {"link"}, {}, {}},
      {"child", {"link"}, {}, {}},
      {"axis", {"xyz"}, {}, {}},
      {"limit", {"lower", "upper", "effort", "velocity"}, {}, {}},
      {"dynamics", {"damping", "friction"}, {}, {}}};
  return rows;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Of another program: "drake:acceleration", "xmlns:xacro".
bool isForeign(const std::string& name) { return name.find(':') != std::string::npos; }

std::string described(const XmlElement& element) {
  const XmlAttribute* name = element.attribute("name");
  return "<" + element.name + (name ? " name=\"" + name->value + "\"" : "") + ">";
}

void checkAttributes(const XmlElement& element, const Grammar& grammar, Findings& findings) {
  for (const XmlAttribute& attribute : element.attributes) {
    if (isForeign(attribute.name) || contains(grammar.attributes, attribute.name)) continue;
    findings.warningAtName(code::unread_part, element, attribute,
                           "nothing reads the attribute '" + attribute.name + "' of <" + element.name + ">",
                           nearestName(attribute.name, grammar.attributes));
  }
}

/// Many programs put elements of their own into robot files: only what looks like a slip is told.
void checkChildren(const XmlElement& element, const Grammar& grammar, Findings& findings) {
  std::vector<std::string> known = grammar.single;
  known.insert(known.end(), grammar.many.begin(), grammar.many.end());
  std::set<std::string> seen;
  for (const auto& child : element.children) {
    if (contains(grammar.single, child->name) && !seen.insert(child->name).second)
      findings.error(code::too_many_elements, *child,
                     described(element) + " has a second <" + child->name + ">: it may have one, remove the other");
    if (isForeign(child->name) || contains(known, child->name)) continue;
    const std::string nearest = nearestName(child->name, known);
    if (!nearest.empty())
      findings.warning(code::unread_part, *child,
                       "nothing reads the <" + child->name + "> of " + described(element), nearest);
  }
}

}  // namespace

void checkParts(const XmlElement& element, Findings& findings) {
  const auto grammar = std::ranges::find(grammars(), element.name, &Grammar::element);
  if (grammar == grammars().end()) return;
  checkAttributes(element, *grammar, findings);
  checkChildren(element, *grammar, findings);
  for (const auto& child : element.children)
    if (contains(grammar->single, child->name) || contains(grammar->many, child->name)) checkParts(*child, findings);
}

}  // namespace tactus::dsl
