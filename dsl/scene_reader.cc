#include "dsl/scene_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "dsl/nearest_name.h"
#include "dsl/typed_attributes.h"
#include "framework/geometry/uniform_body.h"

namespace tactus::dsl {
namespace {

using control::ElementValues;

Eigen::Isometry3d poseFrom(const std::vector<double>& numbers) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  if (numbers.size() == 6)
    pose.linear() = (Eigen::AngleAxisd(numbers[5], Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(numbers[4], Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(numbers[3], Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
  return pose;
}

/// The pose that an attribute of an element gives, or an error there.
std::optional<Eigen::Isometry3d> readPose(const CheckedElement& element, Findings& findings,
                                          const std::string& attribute = "pose") {
  const auto& numbers = element.values.numbers(attribute);
  if (numbers.size() == 3 || numbers.size() == 6) return poseFrom(numbers);
  const std::string message = "attribute '" + attribute + "': expected 3 numbers (x y z) or 6 (x y z roll pitch yaw), found " +
                              std::to_string(numbers.size());
  if (const XmlAttribute* written = element.xml->attribute(attribute))
    findings.errorAtValue(code::bad_value, *element.xml, *written, message);
  else
    findings.error(code::bad_value, *element.xml, message);
  return std::nullopt;
}

class SceneReader {
 public:
  SceneReader(const CheckedElement& scene, const control::Registry& registry, Stack& stack, Findings& findings)
      : scene_(scene), registry_(registry), stack_(stack), findings_(findings) {}

  void run() {
    if (scene_.values.has("gravity")) stack_.gravity = scene_.values.vector3("gravity");
    for (const CheckedElement* element : scene_.all("object")) addObject(*element);
    for (std::size_t i = 0; i < stack_.objects.size(); ++i) place(i);
    for (const CheckedElement* element : scene_.all("pair")) addPair(*element);
  }

 private:
  void addObject(const CheckedElement& element) {
    if (!element.values.has("name")) return;
    ObjectDescription object;
    object.values = element.values;
    for (const CheckedElement* waypoint : element.all("at")) object.values.children.push_back(waypoint->values);
    object.object.name = element.values.text("name");
    object.object.place = element.xml->place();
    if (index_.count(object.object.name))
      return findings_.errorAtValue(code::duplicate_name, *element.xml, *element.xml->attribute("name"),
                                    "the scene has an object '" + object.object.name + "' already");
    if (element.complete) {
      if (const auto pose = readPose(element, findings_)) object.object.pose = *pose;
      object.jitter = element.values.vector3("jitter");
      object.object.material = {element.values.real("stiffness"), element.values.real("dissipation"),
                                element.values.real("friction"), element.values.real("rolling")};
      if (element.values.has("on")) object.on = element.values.text("on");
    }
    for (const CheckedElement& child : element.children) addShape(child, object);
    if (element.complete) readMobility(element, object);
    index_[object.object.name] = stack_.objects.size();
    stack_.objects.push_back(std::move(object));
    elements_.push_back(&element);
  }

  void readMobility(const CheckedElement& element, ObjectDescription& object) {
    static const std::map<std::string, description::Mobility> mobilities{
        {"fixed", description::Mobility::fixed},
        {"free", description::Mobility::free},
        {"held", description::Mobility::held},
        {"moved", description::Mobility::moved}};
    const std::string& text = element.values.text("mobility");
    object.object.mobility = mobilities.at(text);
    object.object.holder = {element.values.real("hold-stiffness"), element.values.real("hold-damping"),
                            element.values.real("hold-rotation-stiffness"), element.values.real("hold-rotation-damping")};
    if (element.values.has("hold-until")) {
      object.object.holder.until = element.values.real("hold-until");
      if (text != "held")
        sayAt(element, "hold-until", code::attributes_clash,
              "attribute 'hold-until': a " + text + " object is held by nothing");
    }
    const bool endless = std::any_of(object.object.primitives.begin(), object.object.primitives.end(), [](const auto& primitive) {
      return std::isinf(primitive.shape->boundingRadius());
    });
    if (text != "fixed" && endless)
      sayAt(element, "mobility", code::attributes_clash,
            "attribute 'mobility': the object has a shape without end, which cannot move");
    const bool by_forces = text == "free" || text == "held", on_path = text == "held" || text == "moved";
    if (by_forces && !element.values.has("mass"))
      findings_.error(code::missing_attribute, *element.xml, "a " + text + " object needs the attribute 'mass'");
    if (by_forces && element.values.has("mass")) readMass(element, object.object);
    const std::vector<const CheckedElement*> waypoints = element.all("at");
    if (!on_path && !waypoints.empty())
      findings_.error(code::misplaced_element, *waypoints.front()->xml, "a " + text + " object follows no path");
    if (on_path) readPath(waypoints, object.object);
  }

  void readMass(const CheckedElement& element, description::Object& object) {
    object.mass.mass = element.values.real("mass");
    if (element.values.has("inertia") && element.values.has("centre")) {
      object.mass.centre = element.values.vector3("centre");
      const Eigen::Vector3d inertia = element.values.vector3("inertia");
      object.mass.inertia = inertia.asDiagonal();
      if (2 * inertia.maxCoeff() > inertia.sum() * (1 + 1e-9))
        findings_.errorAtValue(code::bad_value, *element.xml, *element.xml->attribute("inertia"),
                               "attribute 'inertia': no body has one that is larger than the other two together");
      return;
    }
    double reach = 0;
    for (const description::Primitive& primitive : object.primitives)
      reach = std::max(reach, primitive.pose.translation().norm() + primitive.shape->boundingRadius());
    if (object.primitives.empty() || !std::isfinite(reach)) return;  // told elsewhere
    const geometry::UniformBody body = geometry::uniformBody(
        [&](const Eigen::Vector3d& p) {
          double nearest = std::numeric_limits<double>::infinity();
          for (const description::Primitive& primitive : object.primitives)
            nearest = std::min(nearest, primitive.shape->distance(primitive.pose.inverse() * p).distance);
          return nearest;
        },
        Eigen::Vector3d::Zero(), reach);
    if (body.volume <= 0) return findings_.error(code::bad_value, *element.xml, "the object is too thin to weigh: give centre and inertia");
    object.mass.centre = body.centre;
    object.mass.inertia = object.mass.mass / body.volume * body.inertia;
  }

  /// As far as from time 0 on; `place` puts it where the object is.
  void readPath(const std::vector<const CheckedElement*>& waypoints, description::Object& object) {
    object.path = {{}};
    for (const CheckedElement* waypoint : waypoints) {
      if (!waypoint->complete) continue;
      const auto by = readPose(*waypoint, findings_, "by");
      const double time = waypoint->values.real("time");
      if (time <= object.path.back().time)
        findings_.errorAtValue(code::bad_value, *waypoint->xml, *waypoint->xml->attribute("time"),
                               "attribute 'time': the times of a path rise, and this one is not after " +
                                   control::formatNumber(object.path.back().time) + " s");
      if (by) object.path.push_back({time, *by});
    }
  }

  void addShape(const CheckedElement& element, ObjectDescription& object) {
    if (element.row->kind != control::ElementKind::shape || !element.complete) return;
    const auto pose = readPose(element, findings_);
    const auto shape = makeShape(element);
    if (!pose || !shape) return;
    object.object.primitives.push_back({shape, *pose});
    object.shapes.push_back(valuesWithin(element));
  }

  /// Null, and the reason told, when the factory refuses.
  std::shared_ptr<const geometry::Shape> makeShape(const CheckedElement& element) {
    try {
      return registry_.makeShape(valuesWithin(element));
    } catch (const control::ElementError& error) {
      if (const XmlAttribute* written = element.xml->attribute(error.attribute))
        findings_.errorAtValue(code::refused_by_factory, *element.xml, *written, error.what(),
                               nearestName(written->value, error.candidates));
      else
        findings_.error(code::refused_by_factory, *element.xml, error.what());
    } catch (const std::exception& error) {
      findings_.error(code::refused_by_factory, *element.xml, error.what());
    }
    return nullptr;
  }

  /// Turns a pose on a carrier's top into the world, the carrier's first.
  void place(std::size_t i) {
    if (placed_[i]) return;
    ObjectDescription& object = stack_.objects[i];
    if (!object.on.empty() && carry(i)) {
      const ObjectDescription& carrier = stack_.objects[index_.at(object.on)];
      const description::Primitive& first = carrier.object.primitives.front();
      Eigen::Isometry3d top = carrier.object.pose * first.pose;
      const auto highest = first.shape->support(Eigen::Vector3d::UnitZ());  // none of a plane, which ends at its origin
      if (highest) top.translation().z() += highest->z();
      object.object.pose = top * object.object.pose;
    }
    for (description::Waypoint& waypoint : object.object.path) {
      Eigen::Isometry3d pose = object.object.pose;
      pose.translation() += waypoint.pose.translation();
      pose.linear() = waypoint.pose.linear() * pose.linear();
      waypoint.pose = pose;
    }
    placed_[i] = true;
  }

  /// Is there a carrier to stand on?  Says why not.
  bool carry(std::size_t i) {
    const ObjectDescription& object = stack_.objects[i];
    const XmlElement& element = *elements_[i]->xml;
    const XmlAttribute* on = element.attribute("on");
    const auto say = [&](const Code& code, const std::string& message, const std::string& suggestion = "") {
      on ? findings_.errorAtValue(code, element, *on, message, suggestion)
         : findings_.error(code, element, message, suggestion);
      return false;
    };
    const auto found = index_.find(object.on);
    if (found == index_.end()) {
      std::vector<std::string> names;
      for (const auto& [name, index] : index_)
        if (index != i) names.push_back(name);
      return say(code::unknown_object, "the scene has no object '" + object.on + "'", nearestName(object.on, names));
    }
    waiting_.push_back(i);
    const bool circle = std::find(waiting_.begin(), waiting_.end(), found->second) != waiting_.end();
    if (circle)
      say(code::reference_cycle, "object '" + object.object.name + "' stands on itself, directly or through others");
    else
      place(found->second);
    waiting_.pop_back();
    if (circle) return false;
    const ObjectDescription& carrier = stack_.objects[found->second];
    if (carrier.object.primitives.empty()) return false;  // its own errors are told
    const Eigen::Isometry3d frame = carrier.object.pose * carrier.object.primitives.front().pose;
    constexpr double level = 1e-9;  // 1 − cos of the tilt: rounding of a half turn is let through
    if (std::abs(frame.linear()(2, 2) - 1) > level)
      return say(code::carrier_not_upright, "'" + object.on + "' is tilted: an object stands only on a level top");
    return true;
  }

  /// What a name in a pair stands for.
  struct Named {
    std::vector<description::Party> parties;                       // none: unknown
    int closeness = 2;
  };

  Named partiesOf(const std::string& name) const {
    if (const auto object = index_.find(name); object != index_.end())
      return {{{.object = static_cast<int>(object->second)}}};
    if (name == "robot") return {{{}}, 0};
    if (const int link = stack_.robot.linkIndex(name); link >= 0) return {{{.link = link}}};
    Named group{{}, 1};
    for (const description::Group& links : stack_.robot.link_groups)
      if (links.name == name)
        for (const std::string& link : links.members) group.parties.push_back({.link = stack_.robot.linkIndex(link)});
    return group;
  }

  std::string nameOf(const description::Party& party) const {
    if (party.object >= 0) return "'" + stack_.objects[static_cast<std::size_t>(party.object)].object.name + "'";
    if (party.link >= 0) return "'" + stack_.robot.links[static_cast<std::size_t>(party.link)].name + "'";
    return "the robot";
  }

  void addPair(const CheckedElement& element) {
    if (!element.complete) return;
    const XmlAttribute& written = *element.xml->attribute("between");
    const std::vector<std::string> words = splitWords(element.values.text("between"));
    if (words.size() != 2)
      return findings_.errorAtValue(code::bad_value, *element.xml, written,
                                    "attribute 'between': expected two names, found " + std::to_string(words.size()));
    const bool robot_known = !stack_.robot.links.empty();
    Named ends[2];
    for (std::size_t i = 0; i < 2; ++i) {
      ends[i] = partiesOf(words[i]);
      if (!ends[i].parties.empty()) continue;
      if (robot_known) sayUnknown(element, written, words[i], i);
      return;
    }
    PairDescription pair;
    pair.closeness = ends[0].closeness + ends[1].closeness;
    pair.values = element.values;
    const auto number = [&](const char* name) {
      return element.values.has(name) ? std::optional(element.values.real(name)) : std::nullopt;
    };
    std::string why_never;
    bool touch = false;
    for (const description::Party& one : ends[0].parties)
      for (const description::Party& other : ends[1].parties) {
        pair.pairs.push_back(
            {one, other, number("stiffness"), number("dissipation"), number("friction"), number("rolling")});
        const std::string why = whyNever(one, other);
        touch = touch || why.empty();
        if (why_never.empty()) why_never = why;
        if (const PairDescription* taken = findPair(pair.closeness, one, other))
          return findings_.errorAtValue(
              code::duplicate_pair, *element.xml, written,
              "the material of " + nameOf(one) + " and " + nameOf(other) + " is given in line " +
                  std::to_string(taken->values.value("between").origin.place.line) + " already");
      }
    if (!touch)
      return findings_.errorAtValue(code::pair_never_touches, *element.xml, written,
                                    "'" + words[0] + "' and '" + words[1] + "' never touch: " + why_never);
    stack_.pairs.push_back(std::move(pair));
  }

  void sayUnknown(const CheckedElement& element, const XmlAttribute& written, const std::string& name,
                  std::size_t word) {
    std::vector<std::string> names{"robot"};
    for (const auto& [object, index] : index_) names.push_back(object);
    for (const description::Link& link : stack_.robot.links) names.push_back(link.name);
    for (const description::Group& group : stack_.robot.link_groups) names.push_back(group.name);
    findings_.errorAtWord(code::unknown_object, *element.xml, written, word,
                          "neither the scene has an object nor the robot a link or group '" + name + "'",
                          nearestName(name, names));
  }

  const PairDescription* findPair(int closeness, const description::Party& one, const description::Party& other) const {
    for (const PairDescription& pair : stack_.pairs)
      for (const description::ContactPair& each : pair.pairs)
        if (pair.closeness == closeness &&
            ((each.one == one && each.other == other) || (each.one == other && each.other == one)))
          return &pair;
    return nullptr;
  }

  bool isForceMoved(const description::Party& party) const {
    const description::Mobility mobility = stack_.objects[static_cast<std::size_t>(party.object)].object.mobility;
    return mobility == description::Mobility::free || mobility == description::Mobility::held;
  }

  /// "" where the two can touch.
  std::string whyNever(const description::Party& one, const description::Party& other) const {
    if (one.object >= 0 && one == other) return "an object does not touch itself";
    if (one.object >= 0 && other.object >= 0)
      return isForceMoved(one) || isForceMoved(other) ? "" : "no force moves either of them";
    if (one.object >= 0 || other.object >= 0) return whyNoObject(one.object >= 0 ? other : one);
    const auto has = [](const description::Party& party, int link) { return party.link < 0 || party.link == link; };
    const auto& touching = stack_.self_contacts.touching;
    const bool meet = std::any_of(touching.begin(), touching.end(), [&](const description::LinkPair& pair) {
      return (has(one, pair.one) && has(other, pair.other)) || (has(one, pair.other) && has(other, pair.one));
    });
    return meet ? ""
                : "these links pass through each other (self-contact of <robot>; tactus explain says which do not)";
  }

  /// "" where a link, or the robot, can touch objects.
  std::string whyNoObject(const description::Party& links) const {
    if (links.link < 0) return "";
    if (stack_.robot.links[static_cast<std::size_t>(links.link)].shapes.empty())
      return "link " + nameOf(links) + " has no shape";
    for (int link = links.link; link >= 0;) {
      const auto above = std::find_if(stack_.robot.joints.begin(), stack_.robot.joints.end(),
                                      [link](const description::Joint& joint) { return joint.child == link; });
      if (above == stack_.robot.joints.end()) break;
      if (above->type != description::JointType::fixed) return "";
      link = above->parent;
    }
    return "link " + nameOf(links) + " is fixed to the world";
  }

  /// At an attribute where it is written, else at the element.
  void sayAt(const CheckedElement& element, const std::string& attribute, const Code& code,
             const std::string& message) {
    if (const XmlAttribute* written = element.xml->attribute(attribute))
      findings_.errorAtValue(code, *element.xml, *written, message);
    else
      findings_.error(code, *element.xml, message);
  }

  const CheckedElement& scene_;
  const control::Registry& registry_;
  Stack& stack_;
  Findings& findings_;
  std::map<std::string, std::size_t> index_;
  std::vector<const CheckedElement*> elements_;
  std::map<std::size_t, bool> placed_;
  std::vector<std::size_t> waiting_;
};

}  // namespace

void readScene(const CheckedElement& scene, const control::Registry& registry, Stack& stack, Findings& findings) {
  SceneReader(scene, registry, stack, findings).run();
}

}  // namespace tactus::dsl
