#include "apps/tactus/session.h"

#include <algorithm>
#include <cmath>

#include "apps/tactus/command.h"
#include "dsl/codes.h"
#include "dsl/compile.h"
#include "framework/control/element_values.h"
#include "framework/runtime/faulty_drives.h"
#include "framework/runtime/feature_truth.h"
#include "sim/simbody_plant.h"

namespace tactus::app {
namespace {

std::unique_ptr<runtime::SensingPlant> makePlant(const dsl::Stack& stack, const control::Registry& registry,
                                                 const description::Scene& scene) {
  try {
    auto sensors = dsl::makeSensors(stack, registry, scene, stack.run.seed);
    sim::PlantOptions options;
    options.wrench_links = runtime::wrenchLinks(sensors);
    options.wrong_masses = stack.faults.masses;
    options.frictions = stack.faults.frictions;
    options.shoves = stack.faults.shoves;
    auto body = std::make_unique<sim::SimbodyPlant>(stack.robot, scene, stack.start(stack.run.seed), options);
    auto driven = std::make_unique<runtime::FaultyDrives>(std::move(body), stack.faults.torques,
                                                          1 / stack.controller.values.real("rate"));
    return std::make_unique<runtime::SensingPlant>(std::move(driven), std::move(sensors));
  } catch (const runtime::PlantError& error) {
    dsl::Diagnostic diagnostic;
    diagnostic.code = dsl::code::unfit_for_dynamics.id;
    diagnostic.message = error.what();
    diagnostic.place = stack.robot.place;
    throw dsl::InvalidStack({diagnostic});
  }
}

void expectSame(const char* what, const std::vector<std::string>& in_state, const std::vector<std::string>& here) {
  if (in_state == here) return;
  const auto missingIn = [](const std::vector<std::string>& names, const std::vector<std::string>& of) {
    std::string text;
    for (const std::string& name : of)
      if (std::find(names.begin(), names.end(), name) == names.end()) text += (text.empty() ? "" : ", ") + name;
    return text;
  };
  const std::string only_here = missingIn(in_state, here), only_there = missingIn(here, in_state);
  std::string message = std::string("the state has other ") + what + " than this stack";
  if (!only_there.empty()) message += "; only in the state: " + only_there;
  if (!only_here.empty()) message += "; only here: " + only_here;
  if (only_here.empty() && only_there.empty()) message += ": the same in another order";
  throw control::StateError(message);
}

/// "controller/task/hold/excess" is of "controller/task/hold"; each once.
std::vector<std::string> partsOf(const std::vector<std::string>& paths) {
  std::vector<std::string> parts;
  for (const std::string& path : paths) {
    size_t end = 0;
    for (int depth = 0; depth < 3 && end != std::string::npos; ++depth) end = path.find('/', end + (depth > 0));
    const std::string part = path.substr(0, end);
    if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(part);
  }
  return parts;
}

}  // namespace

Session::Session(dsl::Stack stack, const control::Registry& registry)
    : stack_(std::move(stack)),
      registry_(registry),
      scene_(stack_.scene(stack_.run.seed)),
      controller_(dsl::compile(stack_, registry)),
      plant_(makePlant(stack_, registry, scene_)),
      statistics_(std::lround(stack_.run.duration / controller_->period())) {
  contacts_ = std::make_unique<runtime::ContactMetrics>(static_cast<int>(stack_.robot.links.size()),
                                                        static_cast<int>(scene_.objects.size()), desiredLinks(),
                                                        !stack_.robot.self_contact.empty());
  measures_ = std::make_unique<runtime::Measures>(dsl::makeMeasures(stack_, registry_, *controller_, scene_, stack_.start(stack_.run.seed)));
  if (!stack_.run.count_while.empty()) contacts_->countWhile(findScalar(stack_.run.count_while));
  for (size_t i = 0; i < stack_.signals.size() && !touched_points_; ++i) {
    touched_points_ = findPort<control::TouchedPoints>(i, "points");
  }
  findFeatures();
  plant_->faults(faults_);
}

std::map<std::string, std::string> Session::taskPlaces() const {
  const auto text = [](const description::Place& place) {
    return place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
  };
  std::map<std::string, std::string> places;
  for (size_t i = 0; i < stack_.levels.size(); ++i) {
    for (const dsl::ElementInstance& task : stack_.levels[i].tasks) places[task.name] = text(task.place);
    if (!stack_.levels[i].controller) continue;
    for (const control::NamedTask& owned : controller_->levels()[i].tasks)
      places[owned.name] = text(stack_.levels[i].controller->place);
  }
  return places;
}

template <class T>
const T* Session::findPort(size_t signal, const std::string& port) const {
  const dsl::ElementInstance& instance = stack_.signals[signal];
  for (const control::PortRow& row : instance.values.ports()) {
    if (row.name != port || row.type != control::PortType<T>::name) continue;
    for (const control::NamedSignal& named : controller_->signals()) {
      if (named.name == instance.name) return static_cast<const T*>(named.signal->port(port));
    }
  }
  return nullptr;
}

const double* Session::findScalar(const std::string& reference) const {
  const std::size_t dot = reference.find('.');
  const std::string source = reference.substr(0, dot), port = reference.substr(dot + 1);
  for (size_t i = 0; i < stack_.signals.size(); ++i)
    if (stack_.signals[i].name == source) return findPort<double>(i, port);
  return static_cast<const double*>(controller_->readings().port(source, port));
}

std::vector<int> Session::desiredLinks() const {
  for (size_t i = 0; i < stack_.signals.size(); ++i) {
    // Frame i of the model is link i of the robot.
    if (const auto* desired = findPort<control::FrameSet>(i, "desired")) return desired->frames;
  }
  return {};
}

void Session::findFeatures() {
  for (size_t i = 0; i < stack_.signals.size(); ++i) {
    const auto* estimate = findPort<control::FeatureEstimate>(i, "estimate");
    if (!estimate) continue;
    SoughtFeature feature{stack_.signals[i].name, estimate, {}};
    for (const description::Object& object : scene_.objects) {
      if (object.name == feature.name) feature.truth_W = runtime::highestPoint(object);
    }
    features_.push_back(feature);
  }
}

dsl::SavedState Session::save() {
  dsl::SavedState saved;
  saved.stack = stack_.name;
  saved.back_end = backEndName();
  saved.seed = stack_.run.seed;
  saved.time = time();
  saved.robot = stack_.robot.name;
  saved.joints = controller_->model().jointNames();
  for (const description::Link& link : stack_.robot.links) saved.links.push_back(link.name);
  for (const description::Object& object : scene_.objects) saved.objects.push_back(object.name);
  control::Archive archive = control::Archive::saving(saved.values);
  archiveParts(archive);
  return saved;
}

std::vector<std::string> Session::restore(const dsl::SavedState& saved) {
  const dsl::SavedState here = save();
  expectSame("joints", saved.joints, here.joints);
  expectSame("links", saved.links, here.links);
  expectSame("objects", saved.objects, here.objects);
  control::Archive archive = control::Archive::restoring(saved.values);
  archiveParts(archive);
  const std::string world = "plant/world/";
  for (const std::string& path : archive.missing())
    if (path.starts_with(world)) throw control::StateError("the state lacks '" + path + "'");
  for (const std::string& path : archive.unclaimed(world))
    throw control::StateError("this stack's world has no '" + path + "'");
  const double period = controller_->period();
  if (!(std::abs(saved.time - time()) < 1e-6 * period) || !(std::abs(time() - static_cast<double>(tick()) * period) < 1e-6 * period))
    throw control::StateError("the state says that it is of t = " + control::formatNumber(saved.time) + " s, its world stands at " +
                              control::formatNumber(time()) + " s; both are the time of a tick, a multiple of " +
                              control::formatNumber(period) + " s");
  std::vector<std::string> notes;
  for (const std::string& part : partsOf(archive.missing()))
    notes.push_back(part + " is not in the state, or not all of it: it starts afresh");
  for (const std::string& part : partsOf(archive.unclaimed()))
    notes.push_back(part + " of the state is not in this stack");
  return notes;
}

void Session::archiveParts(control::Archive& archive) {
  archive("plant", static_cast<runtime::Plant&>(*plant_));
  archive("controller", *controller_);
  archive("contacts", *contacts_);
  archive("measure", *measures_);
}

runtime::LoopResult Session::run(const std::vector<control::Observer*>& others, const std::atomic<bool>& stop) {
  std::vector<control::Observer*> observers{contacts_.get(), measures_.get(), &statistics_};
  observers.insert(observers.end(), others.begin(), others.end());
  runtime::LoopResult result = runtime::runLoop(*plant_, *controller_, stack_.run.duration - time(), observers, stop);
  if (result.ending == runtime::Ending::plant_error || result.ending == runtime::Ending::tick_error) {
    std::string striking;
    for (const control::FaultRecord* fault : faults_)
      if (fault->strikes) striking += (striking.empty() ? "" : ", ") + ("'" + fault->name + "' (" + fault->kind + ")");
    if (!striking.empty()) result.message += " Faults that struck then: " + striking;
  }
  return result;
}

std::unique_ptr<runtime::Recorder> Session::recordInto(const std::string& folder) const {
  runtime::RecorderOptions options;
  options.folder = folder;
  options.columns = stack_.run.columns == "all" ? runtime::ColumnSet::all : runtime::ColumnSet::standard;
  options.row_rate = stack_.run.record_rate;
  options.contacts = contacts_.get();
  options.touched_points = touched_points_;
  options.first_tick = tick();
  options.faults = faults_;
  options.measures = measures_->columns();
  for (int i = 0; i < static_cast<int>(scene_.objects.size()); ++i)
    if (scene_.objects[i].mobility != description::Mobility::fixed) options.objects.push_back({scene_.objects[i].name, i});
  return std::make_unique<runtime::Recorder>(options);
}

std::vector<control::Observer*> Session::startRecorders(const std::string& folder) {
  recorders_ = dsl::makeRecorders(stack_, registry_, *controller_, folder);
  std::vector<control::Observer*> started;
  for (const auto& recorder : recorders_) started.push_back(recorder.get());
  return started;
}

std::vector<control::Metric> Session::metrics() const {
  std::vector<control::Metric> metrics = contacts_->metrics();
  for (const control::Level& level : controller_->levels()) {
    if (level.owner.controller) level.owner.controller->metrics(metrics);
    for (const control::NamedTask& named : level.tasks) named.task->metrics(metrics);
  }
  for (const control::NamedSignal& named : controller_->signals()) named.signal->metrics(metrics);
  if (touched_points_) metrics.push_back({"points_touched", static_cast<double>(touched_points_->points.size())});
  for (const SoughtFeature& feature : features_) {
    for (control::Metric& metric : runtime::featureMetrics(feature.name, *feature.estimate, feature.truth_W)) {
      metrics.push_back(std::move(metric));
    }
  }
  for (control::Metric& metric : measures_->metrics()) metrics.push_back(std::move(metric));
  return metrics;
}

std::vector<std::string> Session::metricNames() const {
  std::vector<std::string> names;
  for (const control::Metric& metric : metrics()) names.push_back(metric.name);
  for (const SoughtFeature& feature : features_) {
    if (!feature.truth_W) continue;
    control::FeatureEstimate found = *feature.estimate;
    found.found = true;
    for (const control::Metric& metric : runtime::featureMetrics(feature.name, found, feature.truth_W)) {
      if (std::find(names.begin(), names.end(), metric.name) == names.end()) names.push_back(metric.name);
    }
  }
  return names;
}

std::vector<std::string> Session::warnings() const {
  std::vector<std::string> warnings = statistics_.warnings();
  for (const control::SwitchedOff& fault : controller_->switchedOff())
    warnings.push_back("task '" + fault.task + "' was switched off at t = " + control::formatNumber(fault.time) + " s: " +
                       fault.reason);
  for (const auto& recorder : recorders_)
    if (!recorder->fault().empty()) warnings.push_back(recorder->fault() + "; it recorded nothing more");
  const std::vector<control::Metric> figures = metrics();
  for (const dsl::TargetDescription& target : stack_.run.targets) {
    const bool known = std::any_of(figures.begin(), figures.end(),
                                   [&](const control::Metric& metric) { return metric.name == target.metric; });
    if (!known) warnings.push_back("the target '" + target.metric + "' names no figure of this run");
  }
  return warnings;
}

int Session::faultCode() const {
  const auto& off = controller_->switchedOff();
  const auto failed = [](const auto& recorder) { return !recorder->fault().empty(); };
  if (std::any_of(recorders_.begin(), recorders_.end(), failed)) return exit_plugin;
  if (std::any_of(off.begin(), off.end(), [](const control::SwitchedOff& fault) { return fault.threw; })) return exit_plugin;
  const bool none_solved = statistics_.ticks() > 0 && statistics_.fallbacks == statistics_.ticks();
  return off.empty() && statistics_.unusableTasks().empty() && !none_solved ? exit_done : exit_numerical;
}

std::string Session::backEndName() const { return stack_.back_end.row().name; }

std::optional<double> Session::wantedForce() const {
  for (const dsl::LevelDescription& level : stack_.levels) {
    for (const dsl::ElementInstance& task : level.tasks) {
      if (task.values.row().name == "contact-force" && task.values.has("force")) return task.values.real("force");
    }
  }
  return std::nullopt;
}

}  // namespace tactus::app
