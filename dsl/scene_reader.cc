#include "dsl/scene_reader.h"

#include <cmath>
#include <limits>
#include <map>

#include "dsl/nearest_name.h"
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
