#include "dsl/scene_reader.h"

#include <cmath>
#include <map>

#include "dsl/nearest_name.h"

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

/// The pose of an element whose `pose` is right, or an error there.
std::optional<Eigen::Isometry3d> readPose(const CheckedElement& element, Findings& findings) {
  const auto& numbers = element.values.numbers("pose");
  if (numbers.size() == 3 || numbers.size() == 6) return poseFrom(numbers);
  const std::string message = "attribute 'pose': expected 3 numbers (x y z) or 6 (x y z roll pitch yaw), found " +
                              std::to_string(numbers.size());
  if (const XmlAttribute* written = element.xml->attribute("pose"))
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
    object.object.name = element.values.text("name");
    object.object.place = element.xml->place();
    if (index_.count(object.object.name))
      return findings_.errorAtValue(code::duplicate_name, *element.xml, *element.xml->attribute("name"),
                                    "the scene has an object '" + object.object.name + "' already");
    if (element.complete) {
      if (const auto pose = readPose(element, findings_)) object.object.pose = *pose;
      object.jitter = element.values.vector3("jitter");
      object.object.material = {element.values.real("stiffness"), element.values.real("dissipation"),
                                element.values.real("friction")};
      if (element.values.has("on")) object.on = element.values.text("on");
    }
    for (const CheckedElement& child : element.children) addShape(child, object);
    index_[object.object.name] = stack_.objects.size();
    stack_.objects.push_back(std::move(object));
    elements_.push_back(&element);
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
