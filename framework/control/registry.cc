#include "framework/control/registry.h"

#include <algorithm>
#include <set>

namespace tactus::control {
namespace {

std::vector<std::string_view> words(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::vector<std::string_view> found;
  for (std::size_t at = text.find_first_not_of(blanks); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, at), text.size());
    found.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(blanks, end);
  }
  return found;
}

const description::Group* findGroup(const std::vector<description::Group>& groups, std::string_view name) {
  const auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.name == name; });
  return found == groups.end() ? nullptr : &*found;
}

bool isExtraWord(const ElementValues& values, const std::string& attribute, std::string_view word) {
  const AttributeRow* row = values.row().attribute(attribute);
  return row && std::find(row->choices.begin(), row->choices.end(), word) != row->choices.end();
}

std::vector<std::string> linkNames(const description::Robot& robot) {
  std::vector<std::string> names;
  for (const auto& link : robot.links) names.push_back(link.name);
  return names;
}

template <class Factory>
const Factory& factoryOf(const std::map<std::string, Factory>& factories, const ElementValues& values) {
  const auto found = factories.find(values.row().name);
  if (found == factories.end()) throw std::logic_error("nothing makes <" + values.row().name + ">");
  return found->second;
}

/// What the factory made, when it made something.
template <class Made>
Made made(Made part) {
  if (!part) throw ElementError("", "its factory made nothing");
  return part;
}

/// What everything with a name has besides its own attributes.
void addBaseAttributes(ElementRow& row) {
  if (!row.attribute("class"))
    row.attributes.insert(row.attributes.begin(),
                          {.name = "class",
                           .type = ValueType::element_class,
                           .description = "The <defaults> class whose values this element takes where it gives none."});
  if (!row.attribute("name"))
    row.attributes.insert(row.attributes.begin(),
                          {.name = "name",
                           .type = ValueType::identifier,
                           .required = true,
                           .description = "The name under which references, messages and the log know it."});
}

template <class Factory>
void addNamed(ElementTable& table, ElementKind kind, ElementRow row, std::map<std::string, Factory>& factories,
              Factory make) {
  row.kind = kind;
  addBaseAttributes(row);
  const std::string name = row.name;
  table.add(std::move(row));
  factories[name] = std::move(make);
}

}  // namespace

ElementError::ElementError(const ElementValues& child, std::string wrong, const std::string& message,
                           std::vector<std::string> names)
    : std::runtime_error(message), attribute(std::move(wrong)), candidates(std::move(names)), place(child.place) {
  if (attribute.empty() || !child.has(attribute)) return;
  const Value& value = child.value(attribute);
  text = value.text;
  if (value.origin.place.line > 0) place = value.origin.place;
}

std::vector<AttributeRow> activityAttributes() {
  return {{.name = "active",
           .type = ValueType::port,
           .unit = "1",
           .default_text = "true",
           .description =
               "Whether it takes part: true, false, or a signal's port without unit: while that is above 0.5.",
           .choices = {"true", "false"},
           .port_type = "scalar"},
          {.name = "active-from", .type = ValueType::real, .unit = "s", .description = "Takes part from this time on."},
          {.name = "active-until", .type = ValueType::real, .unit = "s", .description = "Takes part before this time."},
          {.name = "active-ramp", .type = ValueType::real, .unit = "s",
           .description = "Time in which its forces fade in or out; not given: the ramp of the controller.",
           .lower = 0}};
}

int BuildContext::frame(const std::string& attribute) const {
  const std::string& name = values.text(attribute);
  const int index = model.frameIndex(name);
  if (index < 0) throw ElementError(attribute, "the robot has no link '" + name + "'", linkNames(robot));
  return index;
}

std::vector<int> BuildContext::frames(const std::string& attribute) const {
  std::set<int> found;
  const auto add = [&](std::string_view name) {
    const int index = model.frameIndex(name);
    if (index < 0) {
      auto candidates = linkNames(robot);
      for (const auto& group : robot.link_groups) candidates.push_back(group.name);
      throw ElementError(attribute, "the robot has no link or group of links '" + std::string(name) + "'", candidates);
    }
    found.insert(index);
  };
  for (std::string_view word : words(values.text(attribute))) {
    if (isExtraWord(values, attribute, word)) continue;
    if (const auto* group = findGroup(robot.link_groups, word))
      for (const std::string& member : group->members) add(member);
    else
      add(word);
  }
  return {found.begin(), found.end()};
}

std::vector<int> BuildContext::joints(const std::string& attribute) const {
  std::set<int> found;
  const auto add = [&](std::string_view name) {
    const int index = model.jointIndex(name);
    if (index < 0) {
      auto candidates = model.jointNames();
      for (const auto& group : robot.joint_groups) candidates.push_back(group.name);
      throw ElementError(attribute, "the robot has no moving joint or group of joints '" + std::string(name) + "'",
                         candidates);
    }
    found.insert(index);
  };
  for (std::string_view word : words(values.text(attribute))) {
    if (isExtraWord(values, attribute, word)) continue;
    if (const auto* group = findGroup(robot.joint_groups, word))
      for (const std::string& member : group->members) add(member);
    else
      add(word);
  }
  return {found.begin(), found.end()};
}

std::unique_ptr<Task> BuildContext::task(const std::string& element,
                                         const std::map<std::string, std::string>& attributes) const {
  if (!tasks_) throw std::logic_error("only a controller makes tasks of other elements");
  return tasks_(element, attributes);
}

void Registry::addStructure(ElementRow row) { elements_.add(std::move(row)); }

void Registry::addShape(ElementRow row, ShapeFactory make) {
  row.kind = ElementKind::shape;
  if (!row.attribute("pose"))
    row.attributes.push_back({.name = "pose",
                              .type = ValueType::reals,
                              .unit = "m, rad",
                              .default_text = "0 0 0",
                              .description = "Place in the object: x y z, or x y z roll pitch yaw (fixed axes)."});
  const std::string name = row.name;
  elements_.add(std::move(row));
  shapes_[name] = std::move(make);
}

void Registry::addSensor(ElementRow row, SensorFactory make) {
  addNamed(elements_, ElementKind::sensor, std::move(row), sensors_, std::move(make));
}

void Registry::addSignal(ElementRow row, SignalFactory make) {
  addNamed(elements_, ElementKind::signal, std::move(row), signals_, std::move(make));
}

void Registry::addTask(ElementRow row, TaskFactory make) {
  for (AttributeRow& attribute : activityAttributes())
    if (!row.attribute(attribute.name)) row.attributes.push_back(std::move(attribute));
  addNamed(elements_, ElementKind::task, std::move(row), tasks_, std::move(make));
}

void Registry::addController(ElementRow row, ControllerFactory make) {
  addNamed(elements_, ElementKind::controller, std::move(row), controllers_, std::move(make));
}

void Registry::addMeasure(ElementRow row, MeasureFactory make) {
  addNamed(elements_, ElementKind::measure, std::move(row), measures_, std::move(make));
}

void Registry::addRecorder(ElementRow row, RecorderFactory make) {
  addNamed(elements_, ElementKind::recorder, std::move(row), recorders_, std::move(make));
}

void Registry::addBackEnd(ElementRow row, BackEndFactory make) {
  row.kind = ElementKind::back_end;
  const std::string name = row.name;
  elements_.add(std::move(row));
  back_ends_[name] = std::move(make);
}

std::shared_ptr<const geometry::Shape> Registry::makeShape(const ElementValues& values) const {
  return made(factoryOf(shapes_, values)(values));
}

std::unique_ptr<Sensor> Registry::makeSensor(const SensorContext& context) const {
  return made(factoryOf(sensors_, context.values)(context));
}

std::unique_ptr<Signal> Registry::makeSignal(const BuildContext& context) const {
  return made(factoryOf(signals_, context.values)(context));
}

std::unique_ptr<Task> Registry::makeTask(const BuildContext& context) const {
  auto task = made(factoryOf(tasks_, context.values)(context));
  if (task->capacity() < 0)
    throw ElementError("", "the task says that it has at most " + std::to_string(task->capacity()) + " rows");
  return task;
}

ControlledLevel Registry::makeController(const BuildContext& context) const {
  ControlledLevel level = factoryOf(controllers_, context.values)(context);
  if (!level.controller) throw ElementError("", "its factory made nothing");
  std::set<std::string> names;
  std::string error;
  for (const OwnedTask& owned : level.tasks) {
    if (!owned.task) throw ElementError("", "its task '" + owned.name + "' is none");
    if (!parseValue({.name = "name", .type = ValueType::identifier}, owned.name, error))
      throw ElementError("", "'" + owned.name + "' is no name for a task: " + error);
    if (!names.insert(owned.name).second) throw ElementError("", "it names two tasks '" + owned.name + "'");
  }
  return level;
}

std::unique_ptr<Measure> Registry::makeMeasure(const MeasureContext& context) const {
  return made(factoryOf(measures_, context.values)(context));
}

std::unique_ptr<Observer> Registry::makeRecorder(const RecorderContext& context) const {
  return made(factoryOf(recorders_, context.values)(context));
}

std::unique_ptr<BackEnd> Registry::makeBackEnd(const ElementValues& values) const {
  std::unique_ptr<BackEnd> back_end = made(factoryOf(back_ends_, values)(values));
  Recipe recipe{values.row().name, {}};
  for (const auto& [name, value] : values.all()) recipe.options[name] = value.text;
  back_end->setRecipe(std::move(recipe));
  return back_end;
}

std::vector<std::string> Registry::names(ElementKind kind) const {
  std::vector<std::string> found;
  for (const ElementRow& row : elements_.rows())
    if (row.kind == kind) found.push_back(row.name);
  return found;
}

}  // namespace tactus::control
