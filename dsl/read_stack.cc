#include "dsl/read_stack.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>

#include "dsl/element_checker.h"
#include "dsl/fault_reader.h"
#include "dsl/model_search.h"
#include "dsl/nearest_name.h"
#include "dsl/read_robot.h"
#include "dsl/reference_checker.h"
#include "dsl/scene_reader.h"
#include "dsl/stack_document.h"
#include "dsl/typed_attributes.h"
#include "dsl/upgrade.h"

namespace tactus::dsl {
namespace {

using control::ElementKind;
using control::ElementRow;
using control::ElementValues;
using control::Origin;

/// A name that a stack could give itself, from that of its file: "2 arms.xml" is stack-2-arms.
std::string nameFromFile(const std::string& file) {
  const auto isLetter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  std::string name = std::filesystem::path(file).stem().string();
  for (char& c : name)
    if (!isLetter(c) && !(c >= '0' && c <= '9') && c != '_' && c != '-') c = '-';
  return !name.empty() && isLetter(name.front()) ? name : "stack-" + name;
}

/// From a document to a Stack, step by step; errors are gathered on the way.
class StackReader {
 public:
  StackReader(const std::string& file, control::Registry& registry, const ReadOptions& options)
      : registry_(registry), options_(options) {
    stack_.file = file;
  }

  const std::vector<Diagnostic>& warnings() const { return findings_.warnings(); }

  Stack run() {
    StackDocument document = readDocument(stack_.file, options_.set, options_.include_folders, findings_);
    stack_.files = std::move(document.files);
    stack_.included_from = std::move(document.included_from);
    if (!document.root) findings_.throwErrors();
    checkFormat(*document.root);
    stack_.plugins = loadPlugins(*document.root, options_.load_plugin, findings_);
    useNewNames(*document.root, registry_.elements(), findings_);

    ElementChecker checker(registry_.elements(), findings_);
    const CheckedElement root = checker.check(*document.root);
    stack_.name = root.values.has("name") ? root.values.text("name") : nameFromFile(stack_.file);
    if (const auto* robot = root.first("robot")) readRobotOf(*robot);
    if (const auto* scene = root.first("scene")) readScene(*scene, registry_, stack_, findings_);
    stack_.sensors = readList(root, "sensors", ElementKind::sensor);
    stack_.signals = readList(root, "signals", ElementKind::signal);
    readLevels(root);
    if (const auto* controller = root.first("controller")) readController(*controller);
    readFaultsOf(root);
    readRun(root);
    checkReferences(root);
    findings_.throwErrors();
    keepElements(root, 0);
    return std::move(stack_);
  }

 private:
  /// A later format may mean anything: nothing else is said about such a file.
  void checkFormat(const XmlElement& root) {
    const XmlAttribute* format = root.attribute("format");
    if (!format || format->value == "1") return;
    std::string error;
    if (!control::parseValue({.name = "format", .type = control::ValueType::integer}, format->value, error)) return;
    findings_.errorAtValue(code::wrong_format, root, *format,
                           "format '" + format->value + "' is not one that this version reads: expected '1'");
    findings_.throwErrors();
  }

  void readRobotOf(const CheckedElement& element) {
    if (element.values.has("model")) {
      stack_.robot_model = element.values.text("model");
      const XmlAttribute& written = *element.xml->attribute("model");
      const ModelSearch search = findModel(stack_.robot_model, element.xml->source->text.file(), options_.model_path);
      if (search.file.empty()) {
        std::string tried;
        for (const std::string& file : search.tried) tried += (tried.empty() ? "" : ", ") + file;
        findings_.errorAtValue(code::unknown_model, *element.xml, written,
                               "there is no robot model '" + stack_.robot_model + "': looked for " + tried,
                               nearestName(stack_.robot_model, search.names));
      } else {
        readModel(search.file, element);
      }
    }
    if (!robot_known_) return;
    readStart(element);
    readSelfContact(element);
  }

  void readModel(const std::string& file, const CheckedElement& element) {
    std::vector<description::Place> way{element.xml->place()};
    const auto& further = element.xml->source->included_from;
    way.insert(way.end(), further.begin(), further.end());
    const auto add = [&](std::vector<Diagnostic> diagnostics) {
      for (Diagnostic& diagnostic : diagnostics) {
        diagnostic.included_from = way;
        findings_.add(std::move(diagnostic));
      }
    };
    stack_.robot_file = file;
    if (auto text = readFile(file)) stack_.files.emplace(file, std::move(*text));
    stack_.included_from.emplace(file, way);
    try {
      std::vector<Diagnostic> warnings;
      stack_.robot = readRobot(file, warnings);
      add(std::move(warnings));
      const auto refusal = refuseForStacks(stack_.robot, stack_.files.at(file));
      robot_known_ = !refusal;
      if (refusal) add({*refusal});
    } catch (const InvalidStack& error) {
      add(error.diagnostics);
    }
  }

  /// Plant and tasks know joints of one coordinate each: the first joint that is none, with the count of all.
  static std::optional<Diagnostic> refuseForStacks(const description::Robot& robot, const std::string& text) {
    const auto hasNoPlace = [](const description::Joint& joint) {
      return joint.mimic || description::velocityCount(joint.type) > 1;
    };
    const auto first = std::find_if(robot.joints.begin(), robot.joints.end(), hasNoPlace);
    if (first == robot.joints.end()) return std::nullopt;
    const auto others = std::count_if(first + 1, robot.joints.end(), hasNoPlace);
    Diagnostic diagnostic;
    diagnostic.code = code::joint_not_for_stacks.id;
    diagnostic.message =
        "joint '" + first->name + "' " +
        (first->mimic ? "follows joint '" + robot.joints[static_cast<std::size_t>(first->mimic->driver)].name + "'"
                      : std::string("has several degrees of freedom")) +
        ": a stack runs robots whose joints are revolute, continuous, prismatic or fixed and move on their own" +
        (others == 0 ? "" : "; " + std::to_string(others) + " more of this one are not like that");
    diagnostic.place = first->place;
    diagnostic.length = 6;                                         // "<joint"
    diagnostic.source_line = SourceText(first->place.file, text).lineAt(first->place.line);
    diagnostic.path = "/robot/joint[@name=" + first->name + "]";
    return diagnostic;
  }

  void readStart(const CheckedElement& element) {
    const auto moving = stack_.robot.movingJoints();
    const auto joint = [&](std::size_t i) -> const description::Joint& {
      return stack_.robot.joints[static_cast<std::size_t>(moving[i])];
    };
    stack_.start_q.resize(static_cast<Eigen::Index>(moving.size()));
    for (std::size_t i = 0; i < moving.size(); ++i)
      stack_.start_q[static_cast<Eigen::Index>(i)] = std::clamp(0.0, joint(i).lower, joint(i).upper);
    stack_.start_jitter.joints = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(moving.size()));
    const CheckedElement* start = element.first("start");
    if (!start || !start->values.has("q")) return;
    readStartJitter(*start);
    const XmlAttribute& written = *start->xml->attribute("q");
    const auto& q = start->values.numbers("q");
    if (q.size() != moving.size())
      return findings_.errorAtValue(code::wrong_start, *start->xml, written,
                                    "the robot has " + std::to_string(moving.size()) + " moving joints, but q gives " +
                                        std::to_string(q.size()) + (q.size() == 1 ? " value" : " values"));
    for (std::size_t i = 0; i < q.size(); ++i) {
      stack_.start_q[static_cast<Eigen::Index>(i)] = q[i];
      if (q[i] < joint(i).lower || q[i] > joint(i).upper)
        findings_.errorAtWord(code::start_outside_limits, *start->xml, written, i,
                              "joint '" + joint(i).name + "' cannot start at " + control::formatNumber(q[i]) +
                                  ": its limits are " + control::formatNumber(joint(i).lower) + " and " +
                                  control::formatNumber(joint(i).upper));
    }
  }

  void readStartJitter(const CheckedElement& start) {
    if (!start.values.has("jitter") || !start.values.has("frame-jitter")) return;  // what is no number was told already
    StartJitter& jitter = stack_.start_jitter;
    const auto& joints = start.values.numbers("jitter");
    const auto moving = static_cast<std::size_t>(jitter.joints.size());
    const auto refuse = [&](const char* attribute, const std::string& message) {
      findings_.errorAtValue(code::wrong_start, *start.xml, *start.xml->attribute(attribute), message);
    };
    const auto isNegative = [](double number) { return number < 0; };
    if (joints.size() == 1)
      jitter.joints.setConstant(joints[0]);
    else if (joints.size() == moving)
      jitter.joints = Eigen::Map<const Eigen::VectorXd>(joints.data(), jitter.joints.size());
    else
      return refuse("jitter", "the robot has " + std::to_string(moving) + " moving joints, but jitter gives " +
                                  std::to_string(joints.size()) + " values; one for all, or one for each");
    if (std::any_of(joints.begin(), joints.end(), isNegative)) return refuse("jitter", "jitter must not be negative");
    const auto& pose = start.values.numbers("frame-jitter");
    if (pose.size() != 6) return;                                  // told already
    if (std::any_of(pose.begin(), pose.end(), isNegative))
      return refuse("frame-jitter", "frame-jitter must not be negative");
    jitter.pose = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(pose.data());
    if (start.values.has("frame"))
      jitter.link = stack_.robot.linkIndex(start.values.text("frame"));
    else if (!jitter.pose.isZero(0))
      refuse("frame-jitter", "frame-jitter needs a frame: the link that it moves");
  }

  void readSelfContact(const CheckedElement& element) {
    if (!element.values.has("self-contact")) return;
    stack_.self_contact.clear();
    std::vector<int> links;
    for (const std::string& word : splitWords(element.values.text("self-contact"))) {
      stack_.self_contact += (stack_.self_contact.empty() ? "" : " ") + word;
      if (const int link = stack_.robot.linkIndex(word); link >= 0) links.push_back(link);
      for (const description::Group& group : stack_.robot.link_groups)
        if (group.name == word)
          for (const std::string& member : group.members) links.push_back(stack_.robot.linkIndex(member));
    }
    if (stack_.self_contact == "all")
      for (int link = 0; link < static_cast<int>(stack_.robot.links.size()); ++link) links.push_back(link);
    if (links.empty()) return;                                     // unknown names are told with the other references
    stack_.self_contacts = dynamics::findSelfContact(stack_.robot, stack_.start_q, links);
    stack_.robot.self_contact = stack_.self_contacts.touching;
  }

  /// A named element; its name is taken from then on.
  ElementInstance instanceOf(const CheckedElement& element) {
    ElementInstance instance{valuesWithin(element), "", element.xml->place(), element.xml->path()};
    if (!element.values.has("name")) return instance;
    instance.name = element.values.text("name");
    const auto [taken, is_new] = names_.emplace(instance.name, element.xml);
    if (!is_new) {
      const description::Place first = taken->second->place();
      const std::string file = first.file == instance.place.file ? "" : " of " + first.file;
      findings_.errorAtValue(code::duplicate_name, *element.xml, *element.xml->attribute("name"),
                             "the name '" + instance.name + "' is taken by the <" + taken->second->name + "> in line " +
                                 std::to_string(first.line) + file);
    }
    return instance;
  }

  /// The named elements of a kind in all lists of that name.
  std::vector<ElementInstance> readList(const CheckedElement& around, const char* list, ElementKind kind) {
    std::vector<ElementInstance> found;
    for (const CheckedElement* elements : around.all(list))
      for (const CheckedElement& element : elements->children)
        if (element.row->kind == kind) found.push_back(instanceOf(element));
    return found;
  }

  /// A <fault> of sensors stands behind all of them.
  void readFaultsOf(const CheckedElement& root) {
    for (ElementInstance& sensor : readList(root, "faults", ElementKind::sensor))
      stack_.sensors.push_back(std::move(sensor));
    stack_.fault_elements = readList(root, "faults", ElementKind::structure);
    for (const CheckedElement* faults : root.all("faults")) readFaults(*faults, stack_, findings_);
  }

  void readLevels(const CheckedElement& root) {
    for (const CheckedElement* element : root.all("level")) {
      LevelDescription level;
      level.element = {element->values, "", element->xml->place(), element->xml->path()};
      checkActivity(*element);
      if (element->values.has("weight")) level.weight = element->values.real("weight");
      if (element->values.has("strict")) {
        level.strict = element->values.flag("strict");
        level.strict_place = element->values.value("strict").origin.place;
      }
      if (element->values.has("priority")) {
        level.priority = element->values.integer("priority");
        if (!stack_.levels.empty() && level.priority <= stack_.levels.back().priority)
          findings_.errorAtValue(code::level_order, *element->xml, *element->xml->attribute("priority"),
                                 (level.priority == stack_.levels.back().priority
                                      ? "priority " + std::to_string(level.priority) + " is that of the level before"
                                      : "priority " + std::to_string(level.priority) + " stands after priority " +
                                            std::to_string(stack_.levels.back().priority)) +
                                     ": the levels of a stack rise strictly");
      }
      for (const CheckedElement& task : element->children)
        if (task.row->kind == ElementKind::task) {
          level.tasks.push_back(instanceOf(task));
          checkActivity(task);
        } else if (task.row->kind == ElementKind::controller) {
          level.controller = instanceOf(task);
        }
      checkOwner(*element, level);
      if (element->values.has("priority")) stack_.levels.push_back(std::move(level));
    }
  }

  /// A level has tasks or one controller that owns it.
  void checkOwner(const CheckedElement& element, const LevelDescription& level) {
    const bool whole = !element.xml->incomplete && element.children.size() == element.xml->children.size();
    if (level.tasks.empty() && !level.controller && whole)
      findings_.error(code::missing_element, *element.xml, "<level> needs a task, or a controller that owns it");
    if (level.tasks.empty() || !level.controller) return;
    for (const CheckedElement& child : element.children)
      if (child.row->kind == ElementKind::task)
        findings_.error(code::misplaced_element, *child.xml,
                        "<" + level.controller->values.row().name + "> owns this level: '" + level.controller->name +
                            "' has no tasks beside its own. Give this one a level of its own");
  }

  /// A window that never opens is a mistake.
  void checkActivity(const CheckedElement& element) {
    if (!element.values.has("active-from") || !element.values.has("active-until")) return;
    const double from = element.values.real("active-from"), until = element.values.real("active-until");
    if (until > from) return;
    const XmlAttribute* written = element.xml->attribute("active-until");
    const std::string message = "attribute 'active-until': " + control::formatNumber(until) + " s is not after " +
                                control::formatNumber(from) + " s, where active-from opens the window";
    if (written)
      findings_.errorAtValue(code::bad_value, *element.xml, *written, message);
    else
      findings_.error(code::bad_value, *element.xml, message);
  }

  void readController(const CheckedElement& element) {
    stack_.controller = {ElementValues(*element.row), "", element.xml->place(), element.xml->path()};
    for (const auto& [name, value] : element.values.all())
      if (element.row->attribute(name)) stack_.controller.values.set(name, value);
    if (element.values.has("rate")) checkRate(element);
    if (!element.values.has("backend")) return;
    std::vector<ElementValues> written = givenOptions(element);
    if (written.empty()) return;
    const auto called = [&](const ElementValues& options) { return options.row().name == options_.backend; };
    auto chosen = written.begin();
    if (!options_.backend.empty()) chosen = std::find_if(written.begin(), written.end(), called);
    if (chosen == written.end()) {
      const ElementRow* row = registry_.elements().findBackEnd(options_.backend);
      if (!row) {
        findings_.error(code::unknown_back_end, *element.xml,
                        "--backend " + options_.backend + ": there is no such back end",
                        nearestName(options_.backend, registry_.names(ElementKind::back_end)));
        return;
      }
      chosen = written.emplace(written.end(), *row);
    }
    if (chosen != written.begin()) {
      control::Value value = element.values.value("backend");
      value.text = chosen->row().name;
      value.origin.kind = Origin::Kind::command_line;
      value.origin.detail = "--backend " + value.text;
      stack_.controller.values.set("backend", std::move(value));
    }
    stack_.back_end = std::move(*chosen);
    written.erase(chosen);
    stack_.alternatives = std::move(written);
    setOptions(element, stack_.back_end.row());
    fillOptions(element, stack_.back_end.row());
  }

  void checkRate(const CheckedElement& element) {
    const double rate = element.values.real("rate"), step = options_.plant_step;
    const XmlAttribute* written = element.xml->attribute("rate");
    if (step <= 0 || !written) return;
    const double steps = 1 / (rate * step);
    if (steps > 0.5 && std::abs(steps - std::round(steps)) <= 1e-6) return;
    const auto rateOf = [&](double whole) { return control::formatNumber(1 / (whole * step)); };
    const std::string nearest =
        steps < 1 ? "the highest rate is " + rateOf(1)
                  : "the nearest rates are " + rateOf(std::ceil(steps)) + " and " + rateOf(std::floor(steps));
    findings_.errorAtValue(code::unfit_rate, *element.xml, *written,
                           "at " + control::formatNumber(rate) + " Hz a tick is not a whole number of the plant's " +
                               "steps of " + control::formatNumber(step) + " s: " + nearest + " Hz");
  }

  /// What the controller, first, and its alternatives give their back ends; those that name none are left out.
  std::vector<ElementValues> givenOptions(const CheckedElement& controller) {
    std::vector<const CheckedElement*> elements{&controller};
    for (const CheckedElement* alternative : controller.all("alternative")) elements.push_back(alternative);
    std::vector<ElementValues> given;
    for (const CheckedElement* element : elements) {
      if (!element->values.has("backend")) continue;
      const std::string name = element->values.text("backend");
      const ElementRow* row = registry_.elements().findBackEnd(name);
      if (!row) {
        sayUnknownBackEnd(*element->xml, name);
        if (element == &controller) return {};
        continue;
      }
      for (const ElementValues& other : given)
        if (other.row().name == name)
          findings_.errorAtValue(code::duplicate_name, *element->xml, *element->xml->attribute("backend"),
                                 "back end '" + name + "' has its options already");
      ElementValues options(*row);
      for (const auto& [option, value] : element->values.all())
        if (row->attribute(option)) options.set(option, value);
      given.push_back(std::move(options));
    }
    return given;
  }

  void sayUnknownBackEnd(const XmlElement& element, const std::string& name) {
    const auto names = registry_.names(ElementKind::back_end);
    std::string listed;
    for (const std::string& known : names) listed += (listed.empty() ? "" : ", ") + known;
    findings_.errorAtValue(code::unknown_back_end, element, *element.attribute("backend"),
                           "there is no back end '" + name + "': there " + (listed.empty() ? "are none" : "are " + listed),
                           nearestName(name, names));
  }

  /// Options from the command line.
  void setOptions(const CheckedElement& element, const ElementRow& row) {
    for (const auto& [option, text] : options_.backend_options) {
      const control::AttributeRow* attribute = row.attribute(option);
      if (!attribute) {
        std::vector<std::string> known;
        for (const auto& candidate : row.attributes) known.push_back(candidate.name);
        findings_.error(code::unknown_option, *element.xml,
                        "back end '" + row.name + "' has no option '" + option + "', which the command line gives",
                        nearestName(option, known));
        continue;
      }
      std::string error;
      auto value = control::parseValue(*attribute, text, error);
      if (!value) {
        findings_.error(code::bad_value, *element.xml, "option '" + option + "' of the command line: " + error);
        continue;
      }
      value->origin.kind = Origin::Kind::command_line;
      value->origin.detail = option + "=" + text;
      stack_.back_end.set(option, std::move(*value));
    }
  }

  void fillOptions(const CheckedElement& element, const ElementRow& row) {
    for (const control::AttributeRow& attribute : row.attributes) {
      if (stack_.back_end.has(attribute.name)) continue;
      std::string error;
      if (attribute.default_text)
        stack_.back_end.set(attribute.name, control::parseValue(attribute, *attribute.default_text, error).value());
      else if (attribute.required)
        findings_.error(code::missing_attribute, *element.xml,
                        "back end '" + row.name + "' needs the option '" + attribute.name + "'");
    }
  }

  void readRun(const CheckedElement& root) {
    const CheckedElement* run = root.first("run");
    if (!run || !run->complete) return;
    stack_.run.duration = run->values.real("duration");
    stack_.run.seed = static_cast<std::uint64_t>(run->values.integer("seed"));
    if (run->values.has("count-while")) stack_.run.count_while = run->values.text("count-while");
    checkDuration(*run);
    for (const CheckedElement* target : run->all("target")) readTarget(*target);
    stack_.run.measures = readList(root, "run", ElementKind::measure);
    stack_.run.recorders = readList(root, "run", ElementKind::recorder);
    const CheckedElement* record = run->first("record");
    if (!record || !record->complete) return;
    stack_.run.columns = record->values.text("columns");
    stack_.run.record_rate = record->values.real("rate");
  }

  void checkDuration(const CheckedElement& run) {
    const XmlAttribute* written = run.xml->attribute("duration");
    if (!written || !stack_.controller.values.has("rate")) return;
    const double period = 1 / stack_.controller.values.real("rate");
    if (std::lround(stack_.run.duration / period) > 0) return;
    findings_.errorAtValue(code::bad_value, *run.xml, *written,
                           "attribute 'duration': " + control::formatNumber(stack_.run.duration) +
                               " s is shorter than one tick of " + control::formatNumber(period) + " s");
  }

  void readTarget(const CheckedElement& element) {
    if (!element.complete) return;
    const auto bound = [&](const char* name) {
      return element.values.has(name) ? std::optional(element.values.real(name)) : std::nullopt;
    };
    const TargetDescription target{element.values.text("metric"), bound("lower"), bound("upper")};
    if (target.lower && target.upper && *target.lower > *target.upper)
      findings_.errorAtValue(code::bad_value, *element.xml, *element.xml->attribute("upper"),
                             "attribute 'upper': it must not be below 'lower'");
    for (const TargetDescription& other : stack_.run.targets)
      if (other.metric == target.metric)
        findings_.errorAtValue(code::duplicate_name, *element.xml, *element.xml->attribute("metric"),
                               "'" + target.metric + "' has its target already");
    stack_.run.targets.push_back(target);
  }

  void keepElements(const CheckedElement& element, int depth) {
    if (element.row->name == "defaults") return;
    ResolvedElement kept{element.values, {}, element.xml->place(), element.xml->path(), depth};
    if (element.row->takes_back_end_options) {
      // Options stand among the element's own values until they are sorted out.
      const bool chosen = element.row->name == "controller";
      const ElementRow* back_end =
          chosen ? &stack_.back_end.row() : registry_.elements().findBackEnd(element.values.text("backend"));
      kept.options = ElementValues(*back_end);
      for (const control::AttributeRow& option : back_end->attributes) {
        const ElementValues& from = chosen ? stack_.back_end : element.values;
        if (from.has(option.name)) kept.options.set(option.name, from.value(option.name));
      }
    }
    stack_.elements.push_back(std::move(kept));
    for (const CheckedElement& child : element.children) keepElements(child, depth + 1);
  }

  void checkReferences(const CheckedElement& root) {
    ReferenceChecker references(stack_, robot_known_, findings_);
    if (const auto* robot = root.first("robot")) references.check(*robot);
    std::vector<const CheckedElement*> sources;
    for (const char* lists : {"sensors", "signals"})
      for (const CheckedElement* list : root.all(lists))
        for (const CheckedElement& source : list->children) sources.push_back(&source);
    for (const CheckedElement* source : sources) references.checkAll(*source);
    for (const CheckedElement* faults : root.all("faults"))
      for (const CheckedElement& fault : faults->children) references.checkAll(fault);
    for (const CheckedElement* level : root.all("level")) {
      references.check(*level);
      for (const CheckedElement& task : level->children) references.checkAll(task);
    }
    for (const CheckedElement* run : root.all("run")) {
      references.check(*run);
      for (const CheckedElement& recorder : run->children) references.checkAll(recorder);
    }
    references.warnOfUnusedSignals(sources);
  }

  control::Registry& registry_;
  const ReadOptions& options_;
  Findings findings_;
  Stack stack_;
  bool robot_known_ = false;
  std::map<std::string, const XmlElement*> names_;
};

}  // namespace

Stack readStack(const std::string& file, control::Registry& registry, const ReadOptions& options,
                std::vector<Diagnostic>* warnings) {
  StackReader reader(file, registry, options);
  const auto handOver = [&] {
    if (warnings) warnings->insert(warnings->end(), reader.warnings().begin(), reader.warnings().end());
  };
  try {
    Stack stack = reader.run();
    handOver();
    return stack;
  } catch (const InvalidStack&) {
    handOver();
    throw;
  }
}

}  // namespace tactus::dsl
