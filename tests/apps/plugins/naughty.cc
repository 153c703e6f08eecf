// A plugin whose task or back end goes wrong in the way, and from the time on, that the stack says.

#include <cstdlib>
#include <limits>
#include <stdexcept>

#include "framework/runtime/file_error.h"
#include "framework/runtime/plugin_api.h"

namespace {

using namespace tactus::control;

class Naughty final : public Task {
 public:
  explicit Naughty(const BuildContext& context)
      : Task(Relation::equality, context.values.text("fault") == "capacity" ? -1 : 1),
        fault_(context.values.text("fault")),
        from_(context.values.real("from")) {}

 private:
  void doUpdate(const Tick& tick, TickTask& rows) override {
    rows.rows = 1;
    rows.jacobian.row(0).setZero();
    rows.jacobian(0, 0) = 1;
    rows.force[0] = 0;
    if (tick.time < from_) return;
    if (fault_ == "nan") rows.force[0] = std::numeric_limits<double>::quiet_NaN();
    if (fault_ == "huge") rows.force[0] = 1e308;
    if (fault_ == "abort") std::abort();
    if (fault_ == "throw") throw std::runtime_error("the licence server is on holiday");
    if (fault_ == "throw-other") throw 7;
    if (fault_ == "rows") rows.rows = 5;
    if (fault_ == "resize") rows.jacobian.resize(2, 2);
  }
  std::string fault_;
  double from_;
};

/// τ = Σ JᵀF / (1 + ticks so far): the count is its warm start, and what it answers rests on it.
class Moody final : public BackEnd {
 public:
  explicit Moody(const ElementValues& values)
      : BackEnd({.strict_levels = true, .inequalities = true, .torque_limits = true}),
        fault_(values.text("fault")),
        from_(static_cast<int>(values.real("from"))),
        until_(static_cast<int>(values.real("until"))) {}

  WarmStart warmStart() const override { return {ticks_}; }
  void setWarmStart(const WarmStart& state) override { ticks_ = state.at(0); }

 private:
  void doPrepare(const TickProblem&) override {}
  void doSolve(const TickProblem& problem, TickSolution& solution) override {
    solution.torque.setZero();
    for (const TickLevel& level : problem.levels)
      for (const TickTask& task : level.tasks) solution.torque += task.J().transpose() * task.F();
    solution.torque /= 1 + ticks_;
    const bool wrong = ticks_ >= from_ && ticks_ < until_;
    ++ticks_;
    if (wrong && fault_ == "throw") throw std::runtime_error("no licence for tick " + std::to_string(ticks_ - 1));
    if (wrong && fault_ == "throw-other") throw 7;
    solution.status = wrong ? Status::failed : Status::ok;
    solution.message = wrong ? "not in the mood" : "";
    solution.late = wrong && fault_ == "late";
    if (wrong && fault_ == "nan") solution.torque[0] = std::numeric_limits<double>::quiet_NaN();
  }
  std::string fault_;
  int from_, until_, ticks_ = 0;
};

/// Goes wrong at 0.02 s, as all parts below.
void failAt(double time, const std::string& what) {
  if (time >= 0.0195) throw std::runtime_error(what);
}

class Numb final : public Sensor {
  void doSense(const Sensed& truth, Sensed&, Eigen::Ref<Eigen::VectorXd> readings) override {
    readings.setZero();
    failAt(truth.time, "the nerve is cut");
  }
};

class Idea final : public Signal {
  void doUpdate(const Tick& tick) override { failAt(tick.time, "out of ideas"); }
  const void* doPort(std::string_view) const override { return &value_; }
  double value_ = 1;
};

class Pencil final : public Observer {
 public:
  explicit Pencil(const RecorderContext& context) {
    if (context.values.text("fault") == "disk") throw tactus::runtime::FileError(context.folder + "/notes", "no space left");
  }
  void observe(const ObservedTick& tick) override { failAt(tick.truth.time, "the pencil broke"); }
};

class Owner final : public LevelController {
  void doUpdate(const Tick& tick) override { failAt(tick.time, "lost the thread"); }
};

void registerParts(Registry& registry) {
  const auto rowOf = [](const std::string& name) {
    ElementRow row;
    row.name = "naughty." + name;
    row.description = "Goes wrong.";
    return row;
  };
  registry.addSensor(rowOf("sensor"), [](const SensorContext&) { return std::make_unique<Numb>(); });
  ElementRow signal = rowOf("signal");
  signal.attributes = {{.name = "from", .type = ValueType::port, .port_type = "scalar"}};
  signal.ports = {{"value", "scalar", "1", "One.", 1}};
  registry.addSignal(signal, [](const BuildContext& context) {
    if (context.values.has("from")) context.port<double>("from");
    return std::make_unique<Idea>();
  });
  ElementRow recorder = rowOf("recorder");
  recorder.attributes = {{.name = "fault", .type = ValueType::choice, .default_text = "throw", .choices = {"throw", "disk"}}};
  registry.addRecorder(recorder, [](const RecorderContext& context) { return std::make_unique<Pencil>(context); });
  registry.addController(rowOf("owner"), [](const BuildContext& context) {
    ControlledLevel level{std::make_unique<Owner>(), {}};
    level.tasks.push_back({"rest", context.task("posture", {{"joints", "tip"}})});
    return level;
  });
}

void registerElements(Registry& registry) {
  registerParts(registry);
  ElementRow row;
  row.name = "naughty.task";
  row.description = "Goes wrong.";
  row.attributes = {{.name = "fault", .type = ValueType::choice, .required = true,
                     .choices = {"capacity", "nan", "huge", "throw", "throw-other", "rows", "resize", "abort"}},
                    {.name = "from", .type = ValueType::real, .unit = "s", .default_text = "0.0205"}};
  ElementRow moody;
  moody.name = "naughty.moody";
  moody.kind = ElementKind::back_end;
  moody.description = "Fails when it likes to.";
  moody.attributes = {{.name = "fault", .type = ValueType::choice, .default_text = "fail",
                       .choices = {"fail", "late", "nan", "throw", "throw-other"}},
                      {.name = "from", .type = ValueType::real, .default_text = "20"},
                      {.name = "until", .type = ValueType::real, .default_text = "1e6"}};
  registry.addBackEnd(moody, [](const ElementValues& values) { return std::make_unique<Moody>(values); });
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<Naughty>(context); });
}

}  // namespace

TACTUS_PLUGIN("naughty", "1.0.0", "BSD-3-Clause", registerElements)
