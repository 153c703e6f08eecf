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

/// What every task and signal has besides its own attributes.
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

void Registry::addStructure(ElementRow row) { elements_.add(std::move(row)); }

void Registry::addTask(ElementRow row, TaskFactory make) {
  row.kind = ElementKind::task;
  addBaseAttributes(row);
  for (AttributeRow& attribute : activityAttributes())
    if (!row.attribute(attribute.name)) row.attributes.push_back(std::move(attribute));
  const std::string name = row.name;
  elements_.add(std::move(row));
  tasks_[name] = std::move(make);
}

void Registry::addSignal(ElementRow row, SignalFactory make) {
  row.kind = ElementKind::signal;
  addBaseAttributes(row);
  const std::string name = row.name;
  elements_.add(std::move(row));
  signals_[name] = std::move(make);
}

void Registry::addBackEnd(ElementRow row, BackEndFactory make) {
  row.kind = ElementKind::back_end;
  const std::string name = row.name;
  elements_.add(std::move(row));
  back_ends_[name] = std::move(make);
}

std::unique_ptr<Task> Registry::makeTask(const BuildContext& context) const {
  return factoryOf(tasks_, context.values)(context);
}

std::unique_ptr<Signal> Registry::makeSignal(const BuildContext& context) const {
  return factoryOf(signals_, context.values)(context);
}

std::unique_ptr<BackEnd> Registry::makeBackEnd(const ElementValues& values) const {
  std::unique_ptr<BackEnd> back_end = factoryOf(back_ends_, values)(values);
  if (!back_end) throw ElementError("", "its factory made no back end");
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
