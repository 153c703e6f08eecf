#include "dsl/compile.h"

#include <algorithm>
#include <map>

#include "dsl/codes.h"
#include "dsl/nearest_name.h"
#include "dsl/source_text.h"
#include "framework/control/random.h"
#include "framework/runtime/file_error.h"

namespace tactus::dsl {
namespace {

using control::ElementError;
using control::ElementValues;
using description::Place;

/// Leaves a factory whose signal failed: the reason has been told already.
struct SignalFailed {};

const Code& unknownNameOf(control::ValueType type) {
  switch (type) {
    case control::ValueType::link:
    case control::ValueType::links: return code::unknown_link;
    case control::ValueType::joints: return code::unknown_joint;
    case control::ValueType::object: return code::unknown_object;
    case control::ValueType::port: return code::unknown_port;
    default: return code::refused_by_factory;
  }
}

/// Findings about a stack whose text is kept only as a string.
class CompileErrors {
 public:
  explicit CompileErrors(const Stack& stack) : stack_(stack) {}

  void add(const Code& code, const Place& place, int length, const std::string& path, const std::string& message,
           const std::string& suggestion = "") {
    Diagnostic diagnostic;
    diagnostic.code = code.id;
    diagnostic.message = message;
    diagnostic.place = place;
    diagnostic.length = std::max(1, length);
    diagnostic.suggestion = suggestion;
    diagnostic.path = path;
    if (const auto file = stack_.files.find(place.file); file != stack_.files.end())
      diagnostic.source_line = SourceText(place.file, file->second).lineAt(place.line);
    if (const auto way = stack_.included_from.find(place.file); way != stack_.included_from.end())
      diagnostic.included_from = way->second;
    found_.push_back(std::move(diagnostic));
  }

  /// At an attribute's value where it is written, else at the element.
  void addAt(const Code& code, const ElementInstance& element, const std::string& attribute, const std::string& message,
             const std::string& suggestion = "") {
    if (!attribute.empty() && element.values.has(attribute)) {
      const control::Value& value = element.values.value(attribute);
      if (value.origin.place.line > 0)
        return add(code, value.origin.place, countCharacters(value.text), element.path, message, suggestion);
    }
    add(code, element.place, countCharacters(element.values.row().name) + 1, element.path, message, suggestion);
  }

  void addElementError(const ElementInstance& element, const ElementError& error) {
    if (error.place.line > 0)
      return add(code::refused_by_factory, error.place, std::max(1, countCharacters(error.text)), element.path, error.what(),
                 nearestName(error.text, error.candidates));
    const control::AttributeRow* row =
        error.attribute.empty() ? nullptr : element.values.row().attribute(error.attribute);
    std::string suggestion;
    if (row && element.values.has(error.attribute))
      suggestion = nearestName(element.values.text(error.attribute), error.candidates);
    const Code& code = row && !error.candidates.empty() ? unknownNameOf(row->type) : code::refused_by_factory;
    addAt(code, element, error.attribute, error.what(), suggestion);
  }

  void throwIfAny() const {
    if (!found_.empty()) throw InvalidStack(found_);
  }

 private:
  const Stack& stack_;
  std::vector<Diagnostic> found_;
};

/// Calls factories with what they may look at; what they refuse becomes an error at its place.
class PartMaker {
 public:
  PartMaker(const Stack& stack, const control::Registry& registry)
      : stack_(stack), registry_(registry), errors_(stack), period_(1 / stack.controller.values.real("rate")) {
    try {
      model_ = std::make_shared<const dynamics::Model>(stack_.robot);
    } catch (const dynamics::ModelError& error) {
      const Place place = error.place.line > 0 ? error.place : stack_.robot.place;
      errors_.add(code::unfit_for_dynamics, place, 1, "", error.what());
    }
    errors_.throwIfAny();
  }

  /// Nothing of Made, and the reason in `errors()`, when the factory refuses.
  template <class Factory>
  auto make(const ElementInstance& element, Factory factory) -> std::optional<decltype(factory())> {
    try {
      return factory();
    } catch (const SignalFailed&) {
    } catch (const ElementError& error) {
      errors_.addElementError(element, error);
    } catch (const runtime::FileError&) {
      throw;
    } catch (const std::exception& error) {
      errors_.addAt(code::refused_by_factory, element, "", error.what());
    }
    return std::nullopt;
  }

  std::vector<runtime::NamedSensor> makeSensors(const description::Scene& scene, std::uint64_t seed) {
    std::vector<runtime::NamedSensor> sensors;
    std::vector<control::ReadingRow> rows;
    for (const ElementInstance& element : stack_.sensors) {
      const control::SensorContext context(contextOf(element, noPorts), scene, control::seedOf(seed, element.name), rows);
      auto sensor = make(element, [&] { return registry_.makeSensor(context); });
      if (!sensor) continue;
      runtime::NamedSensor named{element.name, std::move(*sensor), {}};
      for (const control::PortRow& port : element.values.ports()) {
        const int count = named.sensor->count(port);
        const bool scalar = port.type == control::PortType<double>::name;
        if (scalar ? count != 1 : count < 1)
          errors_.addAt(code::refused_by_factory, element, "",
                        "sensor '" + element.name + "' says that its port '" + port.name + "', a " + port.type + ", has " +
                            std::to_string(count) + " numbers");
        named.rows.push_back({element.name, port.name, std::max(1, count), scalar});
      }
      rows.insert(rows.end(), named.rows.begin(), named.rows.end());
      sensors.push_back(std::move(named));
    }
    return sensors;
  }

  control::BuildContext contextOf(const ElementInstance& element, control::BuildContext::PortLookup ports,
                                  control::BuildContext::TaskMaker tasks = {}) const {
    return {element.values, stack_.robot, *model_, period_, std::move(ports), std::move(tasks)};
  }

  const Stack& stack() const { return stack_; }
  const control::Registry& registry() const { return registry_; }
  CompileErrors& errors() { return errors_; }
  double period() const { return period_; }
  const std::shared_ptr<const dynamics::Model>& model() const { return model_; }

 private:
  static const void* noPorts(const std::string& attribute, const std::string&, const std::string&) {
    throw ElementError(attribute, "a sensor reads no ports");
  }

  const Stack& stack_;
  const control::Registry& registry_;
  CompileErrors errors_;
  double period_;
  std::shared_ptr<const dynamics::Model> model_;
};

/// The row of a port, where sensor or signal and port are there and the type is right; throws ElementError.
const control::PortRow& portRow(const Stack& stack, const std::string& attribute, const std::string& reference,
                                const std::string& type, std::vector<control::PortRow>& rows) {
  const std::size_t dot = reference.find('.');
  const std::string name = reference.substr(0, dot);
  const std::string port = dot == std::string::npos ? "" : reference.substr(dot + 1);
  const ElementInstance* source = stack.source(name);
  if (!source) {
    std::vector<std::string> names;
    for (const ElementInstance* other : stack.sources())
      for (const control::PortRow& row : other->values.ports()) names.push_back(other->name + "." + row.name);
    throw ElementError(attribute, "the stack has no signal '" + name + "'", names);
  }
  rows = source->values.ports();
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& candidate) { return candidate.name == port; });
  if (row == rows.end()) throw ElementError(attribute, "signal '" + name + "' has no port '" + port + "'");
  if (row->type != type)
    throw ElementError(attribute, "'" + reference + "' is a " + row->type + ", but a " + type + " is read here");
  return *row;
}

/// Signals are made when a port first asks for them, so that they end up in dependency order.
class Compiler {
 public:
  Compiler(const Stack& stack, const control::Registry& registry)
      : parts_(stack, registry), stack_(stack), registry_(registry), errors_(parts_.errors()) {}

  std::unique_ptr<control::Controller> run() {
    auto back_end = makeBackEnd();
    makeReadings();
    for (const ElementInstance& signal : stack_.signals) {
      try {
        makeSignal(signal);
      } catch (const SignalFailed&) {
        continue;
      }
    }
    if (back_end && stack_.controller.values.has("torque-limits-priority") && !back_end->abilities().limits_at_levels)
      errors_.addAt(code::lacking_ability, stack_.controller, "torque-limits-priority",
                    backEndName() + " cannot put torque limits at a level" +
                        whoCould([](const control::Abilities& a) { return a.limits_at_levels; }));
    auto levels = makeLevels(back_end ? &back_end->abilities() : nullptr);
    errors_.throwIfAny();
    for (control::NamedSignal& signal : signals_) signal.readers = readers_[signal.name];
    try {
      return std::make_unique<control::Controller>(parts_.model(), std::move(signals_), std::move(levels),
                                                   std::move(back_end), parts_.period(), stack_.gravity,
                                                   controllerOptions(), std::move(readings_));
    } catch (const std::exception& error) {
      errors_.addAt(code::refused_by_factory, stack_.controller, "backend", error.what());
    }
    errors_.throwIfAny();
    return nullptr;
  }

 private:
  enum class State { being_made, made, failed };

  /// Where the numbers of the sensors will stand; the sensors themselves belong to the run.
  void makeReadings() {
    std::vector<control::ReadingRow> rows;
    if (!stack_.sensors.empty())
      for (runtime::NamedSensor& sensor : parts_.makeSensors(stack_.scene(stack_.run.seed), stack_.run.seed))
        rows.insert(rows.end(), sensor.rows.begin(), sensor.rows.end());
    readings_ = std::make_unique<control::Readings>(std::move(rows));
  }

  std::unique_ptr<control::BackEnd> makeBackEnd() {
    ElementInstance element = stack_.controller;  // with the options, so that errors find their places
    for (const auto& [name, value] : stack_.back_end.all()) element.values.set(name, value);
    try {
      return registry_.makeBackEnd(stack_.back_end);
    } catch (const ElementError& error) {
      errors_.addAt(code::refused_by_factory, element, error.attribute, error.what(),
                    element.values.has(error.attribute)
                        ? nearestName(element.values.text(error.attribute), error.candidates)
                        : "");
    } catch (const std::exception& error) {
      errors_.addAt(code::refused_by_factory, element, "backend", error.what());
    }
    return nullptr;
  }

  control::BuildContext contextOf(const ElementInstance& element) {
    return parts_.contextOf(
        element,
        [this, &element](const std::string& attribute, const std::string& reference, const std::string& type) {
          return port(element, attribute, reference, type);
        },
        [this, &element](const std::string& task, const std::map<std::string, std::string>& attributes) {
          return makeTaskFor(element, task, attributes);
        });
  }

  const void* port(const ElementInstance& reader, const std::string& attribute, const std::string& reference,
                   const std::string& type) {
    std::vector<control::PortRow> rows;
    const control::PortRow& row = portRow(stack_, attribute, reference, type, rows);
    const ElementInstance& source = *stack_.source(reference.substr(0, reference.find('.')));
    readers_[source.name].push_back(reader.name);
    const void* value = nullptr;
    if (source.values.row().kind == control::ElementKind::sensor) {
      value = readings_->port(source.name, row.name);
    } else {
      if (const auto state = states_.find(source.name); state != states_.end() && state->second == State::being_made) {
        errors_.addAt(code::reference_cycle, reader, attribute,
                      "signal '" + source.name + "' reads itself, directly or through others");
        throw SignalFailed();
      }
      value = makeSignal(source).port(row.name);
    }
    if (!value)
      throw ElementError(attribute, "signal '" + source.name + "' gives nothing behind its port '" + row.name + "'");
    return value;
  }

  /// A task of another element, for a controller that owns it.
  std::unique_ptr<control::Task> makeTaskFor(const ElementInstance& owner, const std::string& element,
                                             const std::map<std::string, std::string>& attributes) {
    const control::ElementRow* row = registry_.elements().find(element);
    if (!row || row->kind != control::ElementKind::task)
      throw ElementError("", "it wants a task <" + element + ">, and there is no such task",
                         registry_.names(control::ElementKind::task));
    std::map<std::string, std::string> given = attributes;
    given.try_emplace("name", owner.name);
    try {
      const control::ElementValues values = control::makeValues(*row, given);
      return registry_.makeTask({values, stack_.robot, *parts_.model(), parts_.period(),
                                 [&](const std::string& attribute, const std::string& reference, const std::string& type) {
                                   return port(owner, attribute, reference, type);
                                 }});
    } catch (const ElementError& error) {
      throw ElementError("", "its <" + element + ">: " +
                                 (error.attribute.empty() ? "" : "attribute '" + error.attribute + "': ") + error.what());
    } catch (const std::invalid_argument& error) {
      throw ElementError("", "its <" + element + ">: " + error.what());
    }
  }

  const control::Signal& makeSignal(const ElementInstance& element) {
    if (const auto state = states_.find(element.name); state != states_.end()) {
      if (state->second == State::made) return *made_.at(element.name);
      throw SignalFailed();
    }
    states_[element.name] = State::being_made;
    const control::BuildContext context = contextOf(element);
    auto signal = parts_.make(element, [&] { return registry_.makeSignal(context); });
    if (!signal) {
      states_[element.name] = State::failed;
      throw SignalFailed();
    }
    states_[element.name] = State::made;
    made_[element.name] = signal->get();
    signals_.push_back({element.name, std::move(*signal)});
    return *made_.at(element.name);
  }

  control::ControllerOptions controllerOptions() const {
    const ElementValues& values = stack_.controller.values;
    control::ControllerOptions options;
    if (values.has("torque-rate")) options.torque_rate = values.real("torque-rate");
    options.ramp = values.real("ramp");
    const std::string& on_fault = values.text("on-fault");
    if (on_fault == "switch-off") options.on_fault = control::OnFault::switch_off;
    if (on_fault == "end") options.on_fault = control::OnFault::end;
    options.hold = values.real("hold");
    if (values.has("deadline-iterations")) options.deadline.iterations = values.integer("deadline-iterations");
    if (values.has("torque-limits-priority")) options.limits_priority = values.integer("torque-limits-priority");
    if (values.has("deadline-us")) options.deadline.seconds = 1e-6 * values.real("deadline-us");
    return options;
  }

  /// When the task or level takes part; the reason in `errors_` where its port refuses.
  control::Activation activationOf(const ElementInstance& element) {
    const ElementValues& values = element.values;
    control::ActiveWhen when;
    when.ramp = (values.has("active-ramp") ? values : stack_.controller.values)
                    .real(values.has("active-ramp") ? "active-ramp" : "ramp");
    if (values.has("active-from")) when.from = values.real("active-from");
    if (values.has("active-until")) when.until = values.real("active-until");
    const std::string& active = values.text("active");
    when.active = active != "false";
    if (active == "true" || active == "false") return control::Activation(when);
    try {
      when.on = static_cast<const double*>(port(element, "active", active, control::PortType<double>::name));
    } catch (const SignalFailed&) {
    } catch (const ElementError& error) {
      errors_.addElementError(element, error);
    }
    return control::Activation(when);
  }

  std::vector<control::Level> makeLevels(const control::Abilities* abilities) {
    std::vector<control::Level> levels;
    for (const LevelDescription& description : stack_.levels) {
      control::Level level;
      level.priority = description.priority;
      level.weight = description.weight;
      level.activation = activationOf(description.element);
      if (abilities) checkStrictness(description, levels.empty(), *abilities);
      for (const ElementInstance& element : description.tasks) {
        const control::BuildContext context = contextOf(element);
        auto task = parts_.make(element, [&] { return registry_.makeTask(context); });
        if (!task) continue;
        if (abilities) checkAbilities(element, **task, *abilities);
        level.tasks.push_back({element.name, std::move(*task), activationOf(element)});
      }
      if (description.controller) fillOwned(*description.controller, abilities, level);
      levels.push_back(std::move(level));
    }
    return levels;
  }

  /// The level of a controller: its tasks, named after it.
  void fillOwned(const ElementInstance& element, const control::Abilities* abilities, control::Level& level) {
    const control::BuildContext context = contextOf(element);
    auto made = parts_.make(element, [&] { return registry_.makeController(context); });
    if (!made) return;
    level.owner = {element.name, std::move(made->controller)};
    for (control::OwnedTask& owned : made->tasks) {
      if (abilities) checkAbilities(element, *owned.task, *abilities);
      control::ActiveWhen when;
      when.on = owned.active;
      when.ramp = stack_.controller.values.real("ramp");
      level.tasks.push_back({element.name + "." + owned.name, std::move(owned.task), control::Activation(when)});
    }
  }

  void checkStrictness(const LevelDescription& level, bool first, const control::Abilities& abilities) {
    if (!level.strict || abilities.strict_levels || (first && abilities.strict_first_level)) return;
    const std::string reason = abilities.why_not_strict.empty()
                                   ? "weighs levels against each other: it cannot keep one strictly"
                                   : "cannot keep this level strictly: " + abilities.why_not_strict;
    errors_.add(code::lacking_ability, level.strict_place, 4, "",
                backEndName() + " " + reason + whoCould([first](const control::Abilities& a) {
                  return a.strict_levels || (first && a.strict_first_level);
                }));
  }

  void checkAbilities(const ElementInstance& element, const control::Task& task, const control::Abilities& abilities) {
    if (task.relation() == control::Relation::inequality && !abilities.inequalities)
      errors_.addAt(code::lacking_ability, element, "",
                    "<" + element.values.row().name + "> is an inequality, and " + backEndName() + " honours none" +
                        whoCould([](const control::Abilities& a) { return a.inequalities; }));
    const auto asked = [&](const char* attribute) {
      return task.isContact() && element.values.has(attribute) &&
             element.values.value(attribute).origin.kind != control::Origin::Kind::table_default;
    };
    if (asked("friction") && !abilities.friction_cones)
      errors_.addAt(code::lacking_ability, element, "friction",
                    backEndName() + " honours no friction cones" +
                        whoCould([](const control::Abilities& a) { return a.friction_cones; }));
    if (asked("force-max") && !abilities.force_bounds)
      errors_.addAt(code::lacking_ability, element, "force-max",
                    backEndName() + " honours no bounds of contact forces" +
                        whoCould([](const control::Abilities& a) { return a.force_bounds; }));
  }

  /// "; hqp could": the back ends that, with their defaults, have an ability.
  template <class Predicate>
  std::string whoCould(Predicate able) const {
    std::string names;
    for (const std::string& name : registry_.names(control::ElementKind::back_end)) {
      try {
        const std::unique_ptr<control::BackEnd> back_end =
            registry_.makeBackEnd(control::makeValues(*registry_.elements().findBackEnd(name)));
        if (!able(back_end->abilities())) continue;
        names += (names.empty() ? "" : ", ") + name + (name == stack_.back_end.row().name ? " with its default options" : "");
      } catch (const std::exception&) {                            // one that needs options: nothing is known of it
      }
    }
    return names.empty() ? "" : "; it could be: " + names;
  }

  std::string backEndName() const { return "back end '" + stack_.back_end.row().name + "'"; }

  PartMaker parts_;
  const Stack& stack_;
  const control::Registry& registry_;
  CompileErrors& errors_;
  std::unique_ptr<control::Readings> readings_;
  std::map<std::string, State> states_;
  std::map<std::string, const control::Signal*> made_;
  std::map<std::string, std::vector<std::string>> readers_;        // of each signal
  std::vector<control::NamedSignal> signals_;
};

/// Of parts that are made when the controller stands.
control::BuildContext::PortLookup portsOf(const Stack& stack, const control::Controller& controller) {
  return [&](const std::string& attribute, const std::string& reference, const std::string& type) -> const void* {
    std::vector<control::PortRow> rows;
    const control::PortRow& row = portRow(stack, attribute, reference, type, rows);
    const std::string name = reference.substr(0, reference.find('.'));
    for (const control::NamedSignal& named : controller.signals())
      if (named.name == name) return named.signal->port(row.name);
    return controller.readings().port(name, row.name);
  };
}

}  // namespace

std::unique_ptr<control::Controller> compile(const Stack& stack, const control::Registry& registry) {
  return Compiler(stack, registry).run();
}

std::vector<runtime::NamedSensor> makeSensors(const Stack& stack, const control::Registry& registry,
                                              const description::Scene& scene, std::uint64_t seed) {
  PartMaker parts(stack, registry);
  auto sensors = parts.makeSensors(scene, seed);
  parts.errors().throwIfAny();
  return sensors;
}

std::vector<runtime::NamedMeasure> makeMeasures(const Stack& stack, const control::Registry& registry,
                                                const control::Controller& controller,
                                                const description::Scene& scene, const Eigen::VectorXd& start_q) {
  PartMaker parts(stack, registry);
  const auto another_back_end = [&]() -> std::unique_ptr<control::BackEnd> {
    const control::Recipe& recipe = controller.backEnd().recipe();
    const control::ElementRow* row = registry.elements().findBackEnd(recipe.back_end);
    return row ? registry.makeBackEnd(control::makeValues(*row, recipe.options)) : nullptr;
  };
  std::vector<runtime::NamedMeasure> measures;
  for (const ElementInstance& element : stack.run.measures) {
    const control::MeasureContext context(parts.contextOf(element, portsOf(stack, controller)), controller, scene,
                                          start_q, another_back_end);
    if (auto made = parts.make(element, [&] { return registry.makeMeasure(context); }))
      measures.push_back({element.name, std::move(*made)});
  }
  parts.errors().throwIfAny();
  return measures;
}

std::vector<std::unique_ptr<runtime::GuardedObserver>> makeRecorders(const Stack& stack,
                                                                     const control::Registry& registry,
                                                                     const control::Controller& controller,
                                                                     const std::string& folder) {
  PartMaker parts(stack, registry);
  const bool switch_off = controller.options().on_fault == control::OnFault::switch_off;
  std::vector<std::unique_ptr<runtime::GuardedObserver>> recorders;
  for (const ElementInstance& element : stack.run.recorders) {
    const control::RecorderContext context(parts.contextOf(element, portsOf(stack, controller)), controller, folder);
    if (auto made = parts.make(element, [&] { return registry.makeRecorder(context); }))
      recorders.push_back(std::make_unique<runtime::GuardedObserver>(element.name, std::move(*made), switch_off));
  }
  parts.errors().throwIfAny();
  return recorders;
}

}  // namespace tactus::dsl
