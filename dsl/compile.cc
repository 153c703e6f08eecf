#include "dsl/compile.h"

#include <algorithm>
#include <map>

#include "dsl/codes.h"
#include "dsl/nearest_name.h"
#include "dsl/source_text.h"

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

/// Signals are made when a port first asks for them, so that they end up in dependency order.
class Compiler {
 public:
  Compiler(const Stack& stack, const control::Registry& registry)
      : stack_(stack), registry_(registry), errors_(stack), period_(1 / stack.controller.values.real("rate")) {}

  std::unique_ptr<control::Controller> run() {
    makeModel();
    auto back_end = makeBackEnd();
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
    try {
      return std::make_unique<control::Controller>(model_, std::move(signals_), std::move(levels), std::move(back_end),
                                                   period_, stack_.gravity, controllerOptions());
    } catch (const std::exception& error) {
      errors_.addAt(code::refused_by_factory, stack_.controller, "backend", error.what());
    }
    errors_.throwIfAny();
    return nullptr;
  }

 private:
  enum class State { being_made, made, failed };

  void makeModel() {
    try {
      model_ = std::make_shared<const dynamics::Model>(stack_.robot);
    } catch (const dynamics::ModelError& error) {
      const Place place = error.place.line > 0 ? error.place : stack_.robot.place;
      errors_.add(code::unfit_for_dynamics, place, 1, "", error.what());
    }
    errors_.throwIfAny();
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
    return {element.values, stack_.robot, *model_, period_,
            [this, &element](const std::string& attribute, const std::string& reference, const std::string& type) {
              return port(element, attribute, reference, type);
            }};
  }

  const void* port(const ElementInstance& reader, const std::string& attribute, const std::string& reference,
                   const std::string& type) {
    const std::size_t dot = reference.find('.');
    const std::string name = reference.substr(0, dot);
    const std::string port = dot == std::string::npos ? "" : reference.substr(dot + 1);
    const auto found = std::find_if(stack_.signals.begin(), stack_.signals.end(),
                                    [&](const ElementInstance& signal) { return signal.name == name; });
    if (found == stack_.signals.end()) throw ElementError(attribute, "the stack has no signal '" + name + "'", names());
    const std::vector<control::PortRow> rows = found->values.ports();
    const auto row =
        std::find_if(rows.begin(), rows.end(), [&](const auto& candidate) { return candidate.name == port; });
    if (row == rows.end()) throw ElementError(attribute, "signal '" + name + "' has no port '" + port + "'");
    if (row->type != type)
      throw ElementError(attribute, "'" + reference + "' is a " + row->type + ", but a " + type + " is read here");
    if (const auto state = states_.find(name); state != states_.end() && state->second == State::being_made) {
      errors_.addAt(code::reference_cycle, reader, attribute,
                    "signal '" + name + "' reads itself, directly or through others");
      throw SignalFailed();
    }
    const void* value = makeSignal(*found).port(port);
    if (!value) throw ElementError(attribute, "signal '" + name + "' gives nothing behind its port '" + port + "'");
    return value;
  }

  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const ElementInstance& signal : stack_.signals)
      for (const control::PortRow& port : signal.values.ports()) found.push_back(signal.name + "." + port.name);
    return found;
  }

  const control::Signal& makeSignal(const ElementInstance& element) {
    if (const auto state = states_.find(element.name); state != states_.end()) {
      if (state->second == State::made) return *made_.at(element.name);
      throw SignalFailed();
    }
    states_[element.name] = State::being_made;
    auto signal = make<control::Signal>(element, [&](const control::BuildContext& context) {
      return registry_.makeSignal(context);
    });
    if (!signal) {
      states_[element.name] = State::failed;
      throw SignalFailed();
    }
    states_[element.name] = State::made;
    made_[element.name] = signal.get();
    signals_.push_back({element.name, std::move(signal)});
    return *made_.at(element.name);
  }

  /// Null, and the reason in `errors_`, when the factory refuses.
  template <class T, class Factory>
  std::unique_ptr<T> make(const ElementInstance& element, Factory factory) {
    try {
      const control::BuildContext context = contextOf(element);
      if (auto made = factory(context)) return made;
      errors_.addAt(code::refused_by_factory, element, "",
                    "the factory of <" + element.values.row().name + "> made nothing");
    } catch (const SignalFailed&) {
    } catch (const ElementError& error) {
      errors_.addElementError(element, error);
    } catch (const std::exception& error) {
      errors_.addAt(code::refused_by_factory, element, "", error.what());
    }
    return nullptr;
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
        auto task = make<control::Task>(element, [&](const control::BuildContext& context) {
          return registry_.makeTask(context);
        });
        if (!task) continue;
        if (task->capacity() < 0) {
          errors_.addAt(code::refused_by_factory, element, "",
                        "the task says that it has at most " + std::to_string(task->capacity()) + " rows");
          continue;
        }
        if (abilities) checkAbilities(element, *task, *abilities);
        level.tasks.push_back({element.name, std::move(task), activationOf(element)});
      }
      levels.push_back(std::move(level));
    }
    return levels;
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

  const Stack& stack_;
  const control::Registry& registry_;
  CompileErrors errors_;
  double period_;
  std::shared_ptr<const dynamics::Model> model_;
  std::map<std::string, State> states_;
  std::map<std::string, const control::Signal*> made_;
  std::vector<control::NamedSignal> signals_;
};

}  // namespace

std::unique_ptr<control::Controller> compile(const Stack& stack, const control::Registry& registry) {
  return Compiler(stack, registry).run();
}

}  // namespace tactus::dsl
