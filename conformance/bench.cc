#include "conformance/bench.h"

#include <stdexcept>

#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "framework/runtime/program_path.h"
#include "tasks/register_tasks.h"

namespace tactus::conformance {

Workshop::Workshop(const std::vector<std::string>& plugins)
    : plugins_(registry_, {runtime::shippedPluginFolder()}, runtime::shippedPluginFolder()) {
  dsl::addStructureElements(registry_);
  tasks::registerBuiltIns(registry_);
  for (const std::string& library : plugins) plugins_.loadFile(library);
  plugins_.loadFolder(runtime::shippedPluginFolder());
}

dsl::Stack Workshop::read(const std::string& file) {
  dsl::ReadOptions options;
  options.model_path = runtime::foldersFromEnvironment("TACTUS_MODEL_PATH");
  options.model_path.push_back(runtime::shippedModelFolder());
  options.load_plugin = [this](const std::string& name) { plugins_.loadNamed(name); };
  return dsl::readStack(file, registry_, options);
}

Bench::Bench(const dsl::Stack& stack, const control::Registry& registry)
    : controller_(dsl::compile(stack, registry)), cache_(controller_->model(), stack.gravity) {
  const int dof = controller_->model().dof();
  sensed.q = stack.start_q;
  sensed.qd = Eigen::VectorXd::Zero(dof);
  sensed.readings = Eigen::VectorXd::Zero(controller_->readings().size());
  for (const control::Level& level : controller_->levels()) {
    for (const control::NamedTask& named : level.tasks) {
      control::TickTask rows(named.name, named.task->capacity(), dof);
      rows.relation = named.task->relation();
      rows.contact = named.task->isContact();
      tasks_.push_back({named.name, named.task.get(), std::move(rows)});
    }
  }
}

Bench::Bench(std::shared_ptr<Workshop> workshop, const std::string& stack_file)
    : Bench(workshop->read(stack_file), workshop->registry()) {
  workshop_ = std::move(workshop);
}

Bench::Bench(const std::string& stack_file, const std::vector<std::string>& plugins)
    : Bench(std::make_shared<Workshop>(plugins), stack_file) {}

control::Tick Bench::sense() {
  cache_.update(sensed.q, sensed.qd);
  controller_->readings().take(sensed.readings);
  return {sensed.time, period(), sensed, cache_};
}

void Bench::prepare(const control::Tick& tick) {
  for (const control::NamedSignal& signal : signals()) signal.signal->update(tick);
  for (const control::Level& level : controller_->levels())
    if (level.owner.controller) level.owner.controller->update(tick);
}

void Bench::tick() {
  const control::Tick tick = sense();
  prepare(tick);
  for (TaskOnBench& on_bench : tasks_) on_bench.task->update(tick, on_bench.rows);
  endTick();
}

void Bench::archive(control::Archive& archive) {
  archive("controller", *controller_);
  archive("sensed", sensed);
}

Bench::TaskOnBench& Bench::taskNamed(std::string_view name) {
  for (TaskOnBench& on_bench : tasks_)
    if (on_bench.name == name) return on_bench;
  throw std::invalid_argument("the stack has no task '" + std::string(name) + "'");
}

const control::TickTask& Bench::rows(std::string_view task) const {
  return const_cast<Bench*>(this)->taskNamed(task).rows;
}

const control::Task& Bench::task(std::string_view name) const {
  return *const_cast<Bench*>(this)->taskNamed(name).task;
}

const control::Signal& Bench::signal(std::string_view name) const {
  for (const control::NamedSignal& named : signals())
    if (named.name == name) return *named.signal;
  throw std::invalid_argument("the stack has no signal '" + std::string(name) + "'");
}

}  // namespace tactus::conformance
