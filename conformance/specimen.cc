#include "conformance/specimen.h"

#include <algorithm>
#include <cmath>

#include "dsl/read_robot.h"
#include "framework/geometry/primitives.h"
#include "framework/runtime/program_path.h"

namespace tactus::conformance {
namespace {

using control::AttributeRow;
using control::ElementKind;
using control::ElementRow;
using control::ValueType;

constexpr const char* kModel = "lwr_allegro";
constexpr double kStart[] = {-0.227, -0.535, 0.027, 1.783, 0.120, -0.485, -0.302,  // the palm faces a table
                             0, 0.15, 0.15, 0.15, 0, 0.15, 0.15, 0.15, 0, 0.15, 0.15, 0.15, 0.29, 1.12, -0.14, -0.12};

/// The value cannot be guessed; says of which attribute.
struct NoGuess {
  std::string reason;
};

/// A number of the range, not its end: 0.5 in an unbounded one.
double numberWithin(const AttributeRow& row) {
  const bool below = std::isfinite(row.lower), above = std::isfinite(row.upper);
  if (below && above) return 0.5 * (row.lower + row.upper);
  if (below) return row.lower + 0.5;
  return above ? row.upper - 0.5 : 0.5;
}

std::string numbers(const AttributeRow& row) {
  if (row.type == ValueType::integer) return control::formatNumber(std::ceil(numberWithin(row)));
  if (row.in_world == control::InWorld::positions) return "0.6 0.1 0.3";
  if (row.in_world == control::InWorld::directions) return "0.6 0 -0.8";
  const int count = row.type == ValueType::real ? 1 : std::max(1, row.count);
  std::string text;
  for (int i = 0; i < count; ++i) text += (i ? " " : "") + control::formatNumber(numberWithin(row));
  return text;
}

std::string guess(const ElementRow& row, const AttributeRow& attribute) {
  switch (attribute.type) {
    case ValueType::flag: return "true";
    case ValueType::integer:
    case ValueType::real:
    case ValueType::reals:
    case ValueType::points: return numbers(attribute);
    case ValueType::choice: return attribute.choices.front();
    case ValueType::link: return "palm";
    case ValueType::links: return "fingers";
    case ValueType::joints: return "arm";
    case ValueType::identifier: return "something";
    default: break;
  }
  throw NoGuess{"<" + row.name + "> requires '" + attribute.name + "', and nothing tells what may stand there"};
}

class Maker {
 public:
  explicit Maker(const control::Registry& registry) : registry_(registry) {
    stack_.name = "specimen";
    stack_.robot_model = kModel;
    stack_.robot_file = runtime::shippedModelFolder() + "/" + kModel + ".urdf";
    std::vector<dsl::Diagnostic> warnings;
    stack_.robot = dsl::readRobot(stack_.robot_file, warnings);
    stack_.start_q = Eigen::Map<const Eigen::VectorXd>(kStart, std::size(kStart));
  }

  dsl::Stack make(const ElementRow& row) {
    if (row.kind == ElementKind::signal) addSignal(row);
    if (row.kind == ElementKind::sensor) stack_.sensors.push_back(instanceOf(row, "specimen"));
    if (row.kind == ElementKind::measure) stack_.run.measures.push_back(instanceOf(row, "specimen"));
    if (row.kind == ElementKind::recorder) stack_.run.recorders.push_back(instanceOf(row, "specimen"));
    if (row.kind == ElementKind::shape) addObject(row);
    dsl::LevelDescription level;
    level.element.values = control::makeValues(*registry_.elements().find("level"), {{"priority", "1"}});
    if (row.kind == ElementKind::task) level.tasks.push_back(instanceOf(row, "specimen"));
    if (row.kind == ElementKind::controller) level.controller = instanceOf(row, "specimen");
    if (level.tasks.empty() && !level.controller) {
      level.tasks.push_back(named("impedance", {{"frame", "palm"}, {"position", "0.6 0.1 0.3"}}));
      level.tasks.push_back(named("posture", {{"joints", "arm hand"}, {"q", "0.1"}}));
    }
    stack_.levels.push_back(std::move(level));
    const bool back_end = row.kind == ElementKind::back_end;
    stack_.back_end = control::makeValues(back_end ? row : *registry_.elements().findBackEnd(anyBackEnd()));
    stack_.controller.values =
        control::makeValues(*registry_.elements().find("controller"), {{"backend", stack_.back_end.row().name}});
    stack_.controller.name = "controller";
    return std::move(stack_);
  }

 private:
  std::string anyBackEnd() const {
    const auto names = registry_.names(ElementKind::back_end);
    if (names.empty()) throw NoGuess{"there is no back end"};
    return std::find(names.begin(), names.end(), "null-space") != names.end() ? "null-space" : names.front();
  }

  dsl::ElementInstance named(const std::string& element, std::map<std::string, std::string> given) {
    given["name"] = element;
    return {control::makeValues(*registry_.elements().find(element), given), element, {}, "<" + element + ">"};
  }

  dsl::ElementInstance instanceOf(const ElementRow& row, const std::string& name) {
    std::map<std::string, std::string> given;
    if (row.attribute("name")) given["name"] = name;
    for (const AttributeRow& attribute : row.attributes) {
      if (attribute.name == "name") continue;
      if (attribute.type == ValueType::port) {
        if (attribute.required) given[attribute.name] = port(attribute);
        else if (attribute.default_text) addSignalNamed(*attribute.default_text, attribute.port_type);
      } else if (attribute.required) {
        given[attribute.name] = attribute.type == ValueType::object ? ball() : guess(row, attribute);
      }
    }
    dsl::ElementInstance instance{control::makeValues(row, given), name, {}, "<" + row.name + ">"};
    addChildren(row, instance.values);
    return instance;
  }

  /// As few elements inside as the row lets there be.
  void addChildren(const ElementRow& row, control::ElementValues& into) {
    for (const control::ChildRow& child : row.children) {
      const ElementRow* inner = registry_.elements().find(child.element);
      if (child.min > 0 && !inner) throw NoGuess{"<" + row.name + "> needs elements inside, and nothing tells which"};
      for (int i = 0; i < child.min; ++i) {
        std::map<std::string, std::string> given;
        for (const AttributeRow& attribute : inner->attributes) {
          if (!attribute.required) continue;
          given[attribute.name] = attribute.type == ValueType::port ? port(attribute) : guess(*inner, attribute);
          if (attribute.type == ValueType::identifier) given[attribute.name] += "-" + std::to_string(i + 1);
        }
        into.children.push_back(control::makeValues(*inner, given));
        addChildren(*inner, into.children.back());
      }
    }
  }

  void addObject(const ElementRow& row) {
    dsl::ObjectDescription object;
    object.object.name = "specimen";
    object.shapes.push_back(instanceOf(row, "").values);
    object.object.primitives.push_back({registry_.makeShape(object.shapes.back()), Eigen::Isometry3d::Identity()});
    stack_.objects.push_back(std::move(object));
  }

  /// The name of an object of the scene, which is added.
  std::string ball() {
    dsl::ObjectDescription object;
    object.object.name = "ball";
    object.object.primitives.push_back({std::make_shared<geometry::Sphere>(0.05), Eigen::Isometry3d::Identity()});
    object.object.pose.translation() << 0.7, 0, 0.1;
    stack_.objects.push_back(std::move(object));
    return "ball";
  }

  /// "name.port" of a signal with a port of the attribute's type, which is added.
  std::string port(const AttributeRow& attribute) {
    for (const ElementRow& row : registry_.elements().rows()) {
      for (const control::PortRow& port : row.ports) {
        if (port.type != attribute.port_type || needsChildren(row)) continue;
        const std::string name = "signal-" + std::to_string(stack_.signals.size());
        addSignal(row, name);
        return name + "." + port.name;
      }
    }
    throw NoGuess{"no signal has a port of the type " + attribute.port_type + " that '" + attribute.name +
                  "' requires"};
  }

  /// For a default such as "touch.all": a signal of that name with such a port.
  void addSignalNamed(const std::string& reference, const std::string& port_type) {
    const size_t dot = reference.find('.');
    if (dot == std::string::npos) return;
    const std::string name = reference.substr(0, dot), port = reference.substr(dot + 1);
    for (const dsl::ElementInstance& signal : stack_.signals)
      if (signal.name == name) return;
    for (const ElementRow& row : registry_.elements().rows())
      for (const control::PortRow& candidate : row.ports)
        if (candidate.type == port_type && candidate.name == port && !needsChildren(row)) return addSignal(row, name);
  }

  static bool needsChildren(const ElementRow& row) {
    return std::any_of(row.children.begin(), row.children.end(), [](const control::ChildRow& child) { return child.min > 0; });
  }

  void addSignal(const ElementRow& row, const std::string& name = "specimen") {
    if (++depth_ > 8) throw NoGuess{"its signals need each other"};
    dsl::ElementInstance signal = instanceOf(row, name);
    stack_.signals.push_back(std::move(signal));
    --depth_;
  }

  const control::Registry& registry_;
  dsl::Stack stack_;
  int depth_ = 0;
};

}  // namespace

std::optional<dsl::Stack> specimenOf(const ElementRow& row, const control::Registry& registry, std::string& why_not) {
  try {
    return Maker(registry).make(row);
  } catch (const NoGuess& none) {
    why_not = none.reason;
  } catch (const std::exception& error) {
    why_not = error.what();
  }
  return std::nullopt;
}

}  // namespace tactus::conformance
