#include "dsl/fault_reader.h"

#include <algorithm>
#include <cmath>

#include "dsl/typed_attributes.h"

namespace tactus::dsl {
namespace {

using control::formatNumber;
using description::BodyReference;
using description::TorqueFault;
using description::TorqueFaultKind;

constexpr double shortest = 1e-6;                                  // s, that a fault lasts

class FaultReader {
 public:
  FaultReader(Stack& stack, Findings& findings) : stack_(stack), findings_(findings) {}

  void read(const CheckedElement& element) {
    if (!element.complete) return;
    const std::string& kind = element.row->name;
    if (kind == "torque-loss") readTorque(element, TorqueFaultKind::loss);
    if (kind == "torque-stuck") readTorque(element, TorqueFaultKind::stuck);
    if (kind == "torque-delay") readTorque(element, TorqueFaultKind::delay);
    if (kind == "wrong-mass") readMass(element);
    if (kind == "joint-friction") readFriction(element);
    if (kind == "shove") readShove(element);
  }

 private:
  void say(const Code& code, const CheckedElement& element, const std::string& attribute, const std::string& message) {
    if (const XmlAttribute* written = element.xml->attribute(attribute))
      return findings_.errorAtValue(code, *element.xml, *written, message);
    findings_.error(code, *element.xml, message);
  }

  description::Window windowOf(const CheckedElement& element) {
    description::Window window;
    window.from = element.values.real("from");
    if (!element.values.has("until")) return window;
    window.until = element.values.real("until");
    if (window.until > window.from && window.until - window.from < shortest)
      say(code::bad_value, element, "until",
          "attribute 'until': a fault lasts at least " + formatNumber(shortest) + " s");
    if (!(window.until > window.from))
      say(code::bad_value, element, "until",
          "attribute 'until': " + formatNumber(window.until) + " s is not after " + formatNumber(window.from) +
              " s, where it begins");
    return window;
  }

  void readTorque(const CheckedElement& element, TorqueFaultKind kind) {
    TorqueFault fault{.name = element.values.text("name"), .kind = kind, .window = windowOf(element),
                      .joints = jointsOf(element.values.text("joints"))};
    if (kind == TorqueFaultKind::loss) fault.factor = element.values.real("factor");
    if (kind == TorqueFaultKind::delay) {
      fault.delay = element.values.real("delay");
      checkDelay(element, fault.delay);
    }
    stack_.faults.torques.push_back(std::move(fault));
  }

  void checkDelay(const CheckedElement& element, double delay) {
    if (!stack_.controller.values.has("rate")) return;
    const double ticks = delay * stack_.controller.values.real("rate");
    if (ticks > 0.5 && std::abs(ticks - std::round(ticks)) <= 1e-6) return;
    say(code::bad_value, element, "delay",
        "attribute 'delay': " + formatNumber(delay) + " s is not a whole number of ticks of " +
            formatNumber(1 / stack_.controller.values.real("rate")) + " s");
  }

  /// Indices into q̇ of joints and groups of joints.
  std::vector<int> jointsOf(const std::string& text) const {
    const std::vector<int> moving = stack_.robot.movingJoints();
    std::vector<bool> named(moving.size(), text == "all");
    const auto add = [&](const std::string& name) {
      for (std::size_t i = 0; i < moving.size(); ++i)
        if (stack_.robot.joints[static_cast<std::size_t>(moving[i])].name == name) named[i] = true;
    };
    for (const std::string& word : splitWords(text)) {
      add(word);
      for (const description::Group& group : stack_.robot.joint_groups)
        if (group.name == word) std::for_each(group.members.begin(), group.members.end(), add);
    }
    std::vector<int> joints;
    for (std::size_t i = 0; i < named.size(); ++i)
      if (named[i]) joints.push_back(static_cast<int>(i));
    return joints;
  }

  /// What `link` or `object` names, and its centre of mass; nothing where that is not there or cannot move.
  struct Body {
    BodyReference reference;
    Eigen::Vector3d centre;
  };
  std::optional<Body> bodyOf(const CheckedElement& element) {
    if (element.values.has("object")) {
      const std::string& name = element.values.text("object");
      for (std::size_t i = 0; i < stack_.objects.size(); ++i) {
        const description::Object& object = stack_.objects[i].object;
        if (object.name != name) continue;
        if (object.mobility == description::Mobility::free || object.mobility == description::Mobility::held)
          return Body{{.object = static_cast<int>(i)}, object.mass.centre};
        say(code::immovable_body, element, "object",
            "object '" + name + "' is " +
                (object.mobility == description::Mobility::fixed ? "fixed" : "moved by its path") +
                ": forces and masses change nothing for it. Give it mobility=\"free\" or \"held\"");
      }
      return std::nullopt;
    }
    const std::string& name = element.values.text("link");
    const int link = stack_.robot.linkIndex(name);
    if (link < 0) return std::nullopt;
    if (canMove(link)) return Body{{.link = link}, stack_.robot.links[static_cast<std::size_t>(link)].centre_of_mass};
    say(code::immovable_body, element, "link",
        "link '" + name + "' is fixed to the world: forces and masses change nothing for it");
    return std::nullopt;
  }

  /// Does a joint that moves carry it?
  bool canMove(int link) const {
    for (std::size_t step = 0; step < stack_.robot.joints.size(); ++step) {
      const auto above = std::find_if(stack_.robot.joints.begin(), stack_.robot.joints.end(),
                                      [&](const description::Joint& joint) { return joint.child == link; });
      if (above == stack_.robot.joints.end()) return false;
      if (above->type != description::JointType::fixed) return true;
      link = above->parent;
    }
    return false;
  }

  Eigen::Vector3d pointOf(const CheckedElement& element, const Body& body) const {
    return element.values.has("point") ? element.values.vector3("point") : body.centre;
  }

  void readMass(const CheckedElement& element) {
    description::WrongMass fault{.name = element.values.text("name"), .window = windowOf(element), .bodies = {},
                                 .factor = element.values.real("factor"), .added = element.values.real("added")};
    if (element.values.has("links")) {
      fault.bodies = movableLinks(element);
      if (fault.bodies.empty()) return;
    } else {
      const std::optional<Body> body = bodyOf(element);
      if (!body) return;
      fault.bodies = {body->reference};
      fault.point = pointOf(element, *body);
    }
    stack_.faults.masses.push_back(std::move(fault));
  }

  /// Those of `links` that a joint moves.
  std::vector<BodyReference> movableLinks(const CheckedElement& element) {
    std::vector<bool> named(stack_.robot.links.size(), element.values.text("links") == "all");
    const auto add = [&](const std::string& name) {
      if (const int link = stack_.robot.linkIndex(name); link >= 0) named[static_cast<std::size_t>(link)] = true;
    };
    for (const std::string& word : splitWords(element.values.text("links"))) {
      add(word);
      for (const description::Group& group : stack_.robot.link_groups)
        if (group.name == word) std::for_each(group.members.begin(), group.members.end(), add);
    }
    std::vector<BodyReference> bodies;
    for (std::size_t link = 0; link < named.size(); ++link)
      if (named[link] && canMove(static_cast<int>(link))) bodies.push_back({.link = static_cast<int>(link)});
    if (bodies.empty())
      say(code::immovable_body, element, "links",
          "none of these links can move: forces and masses change nothing for them");
    return bodies;
  }

  void readFriction(const CheckedElement& element) {
    description::JointFriction fault{.name = element.values.text("name"), .window = windowOf(element),
                                     .joints = jointsOf(element.values.text("joints")), .torque = {}};
    const std::vector<int> moving = stack_.robot.movingJoints();
    for (const int index : fault.joints) {
      const int moved = moving[static_cast<std::size_t>(index)];
      const description::Joint& joint = stack_.robot.joints[static_cast<std::size_t>(moved)];
      if (element.values.has("torque")) {
        fault.torque.push_back(element.values.real("torque"));
        continue;
      }
      if (!std::isfinite(joint.effort))
        return say(code::bad_value, element, "of-effort",
                   "attribute 'of-effort': joint '" + joint.name + "' has no effort limit; give the torque");
      fault.torque.push_back(element.values.real("of-effort") * joint.effort);
    }
    stack_.faults.frictions.push_back(std::move(fault));
  }

  void readShove(const CheckedElement& element) {
    const description::Window window = windowOf(element);
    const std::optional<Body> body = bodyOf(element);
    if (!body) return;
    const auto given = [&](const char* attribute) -> Eigen::Vector3d {
      return element.values.has(attribute) ? element.values.vector3(attribute) : Eigen::Vector3d::Zero();
    };
    description::Shove shove{element.values.text("name"), window, body->reference, given("force"), given("moment"),
                             pointOf(element, *body)};
    if (element.values.has("impulse")) shove.force_W = given("impulse") / (window.until - window.from);
    stack_.faults.shoves.push_back(std::move(shove));
  }

  Stack& stack_;
  Findings& findings_;
};

}  // namespace

void readFaults(const CheckedElement& faults, Stack& stack, Findings& findings) {
  FaultReader reader(stack, findings);
  for (const CheckedElement& fault : faults.children) reader.read(fault);
}

}  // namespace tactus::dsl
