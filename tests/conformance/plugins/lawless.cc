// Elements that break one law each, named after it, and `lawless.good…`, which break none.

#include <cmath>
#include <limits>

#include "framework/control/displacement.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/plugin_api.h"

namespace {

using namespace tactus;
using namespace tactus::control;

/// A spring and damper on a link's origin, as an acceleration too: three rows, right in all but what its fault says.
class Spring final : public Task {
 public:
  Spring(const BuildContext& context, std::string fault)
      : Task(Relation::equality, 3), fault_(std::move(fault)), frame_(context.frame("frame")),
        target_W_(context.values.vector3("target")) {
    if (fault_ == "instance") throw std::runtime_error("the licence server is on holiday");
  }

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override {
    if (fault_ == "jacobian-untold" || fault_ == "good-untold") return false;
    dx = frameDisplacement(from, to, frame_).head<3>();
    return true;
  }

 private:
  void doUpdate(const Tick& tick, TickTask& rows) override {
    const Eigen::Vector3d x = tick.robot.framePose(frame_).translation();
    const Eigen::Vector3d velocity = tick.robot.frameVelocity(frame_).head<3>();
    rows.rows = 3;
    tick.robot.pointJacobian(frame_, x, rows.jacobian.topRows<3>());
    rows.force.head<3>() = 100 * (target_W_ - x) - 10 * velocity;
    rows.has_acceleration = fault_ == "good" || fault_ == "bias";
    rows.acceleration.head<3>() =
        rows.force.head<3>() - (fault_ == "bias" ? 0.5 : 1) * tick.robot.pointAccelerationBias(frame_, x);
    error_ = (target_W_ - x).norm();

    if (fault_ == "jacobian" || fault_ == "jacobian-untold") rows.jacobian.col(1) *= -1;
    if (fault_ == "rows") rows.rows = 4;
    if (fault_ == "rows-nan") rows.force[1] = std::nan("");
    if (fault_ == "allocation")
      rows.force.head<3>() += 0 * Eigen::VectorXd(Eigen::MatrixXd::Ones(3, 50).rowwise().sum());
    static long ticks_of_all = 0;
    if (fault_ == "determinism") rows.force[0] += 1e-13 * static_cast<double>(++ticks_of_all);
    if (fault_ == "state") rows.force[0] += 1e-13 * static_cast<double>(++ticks_);
  }

  std::string fault_;
  int frame_;
  Eigen::Vector3d target_W_;
  long ticks_ = 0;
};

class Clock final : public Signal {
 public:
  explicit Clock(std::string fault) : fault_(std::move(fault)) {}

 private:
  void doUpdate(const Tick& tick) override {
    static long ticks_of_all = 0;
    time_ = tick.time + (fault_ == "determinism" ? static_cast<double>(++ticks_of_all) : 0);
    if (fault_ == "state") time_ += static_cast<double>(++ticks_);
    if (fault_ == "ports-nan") time_ = std::nan("");
    if (fault_ == "allocation") copy_ = std::make_unique<double>(time_);
    moved_ = !moved_;
  }
  const void* doPort(std::string_view) const override {
    if (fault_ == "ports") return nullptr;
    return fault_ == "ports-moving" && moved_ ? &other_ : &time_;
  }

  std::string fault_;
  double time_ = 0, other_ = 0;
  long ticks_ = 0;
  bool moved_ = false;
  std::unique_ptr<double> copy_;
};

/// τ = Σ JᵀF, cut into its limits.
class Sum final : public BackEnd {
 public:
  explicit Sum(std::string fault)
      : BackEnd({.strict_levels = true, .inequalities = true, .torque_limits = true}), fault_(std::move(fault)) {}

 private:
  void doPrepare(const TickProblem&) override {}
  void doSolve(const TickProblem& problem, TickSolution& solution) override {
    static long ticks_of_all = 0;
    solution.torque.setZero();
    for (const TickLevel& level : problem.levels)
      for (const TickTask& task : level.tasks) solution.torque += task.J().transpose() * task.F();
    if (fault_ == "determinism") solution.torque *= 1 + 1e-9 * static_cast<double>(++ticks_of_all);
    solution.torque = solution.torque.cwiseMax(problem.torque_limits->lower).cwiseMin(problem.torque_limits->upper);
    if (fault_ == "torque") solution.torque[0] = problem.torque_limits->upper[0] + 1;
    if (fault_ == "torque-nan") solution.torque[0] = std::nan("");
    solution.status = Status::ok;
  }
  std::string fault_;
};

/// A ball, right in all but what its fault says.
class Ball final : public geometry::Shape {
 public:
  explicit Ball(std::string fault) : Shape(fault == "distance-bound" ? 0.05 : 0.1, true), fault_(std::move(fault)) {}

 private:
  geometry::SignedDistance doDistance(const Eigen::Vector3d& p) const override {
    static long asked = 0;
    const double length = p.norm();
    if (length == 0) return fault_ == "convexity" ? hollow(Eigen::Vector3d(1e-9, 0, 0)) : geometry::SignedDistance{-0.1, {1, 0, 0}};
    geometry::SignedDistance nearest{length - 0.1, p / length};
    if (fault_ == "distance") nearest = {p.x() > 0 ? length - 0.1 : length - 0.07, p / length};
    if (fault_ == "gradient") nearest.gradient *= -1;
    if (fault_ == "convexity") nearest = hollow(p);
    if (fault_ == "allocation") nearest.distance += 0 * Eigen::VectorXd::Ones(30).eval().sum();
    if (fault_ == "determinism") nearest.distance *= 1 + 1e-14 * static_cast<double>(++asked);
    return nearest;
  }
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override {
    return (fault_ == "support" ? 0.09 : 0.1) * n;
  }
  /// The space between two balls about the origin.
  static geometry::SignedDistance hollow(const Eigen::Vector3d& p) {
    const double length = p.norm();
    if (length > 0.06) return {length - 0.1, p / length};
    return {0.02 - length, -p / length};
  }
  std::string fault_;
};

/// Reads the sum of all forces, right in all but what its fault says.
class Scale final : public Sensor {
 public:
  explicit Scale(std::string fault) : fault_(std::move(fault)) {}

 private:
  void doSense(const Sensed&, Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) override {
    static long ticks_of_all = 0;
    readings[0] = 0;
    for (const ContactRecord& contact : felt.contacts) readings[0] += contact.force_N;
    if (fault_ == "felt") readings[0] = std::numeric_limits<double>::infinity();
    if (fault_ == "felt-joints") felt.q.conservativeResize(1);
    if (fault_ == "allocation") copy_ = std::make_unique<double>(readings[0]);
    if (fault_ == "determinism") readings[0] += static_cast<double>(++ticks_of_all);
    if (fault_ == "state") readings[0] += static_cast<double>(++ticks_);
  }
  std::string fault_;
  long ticks_ = 0;
  std::unique_ptr<double> copy_;
};

class Owner final : public LevelController {
 public:
  explicit Owner(std::string fault) : fault_(std::move(fault)) {}
  void columns(std::vector<LogColumn>& columns) const override { columns.push_back({"time", &time_}); }

 private:
  void doUpdate(const Tick& tick) override {
    static long ticks_of_all = 0;
    time_ = tick.time + (fault_ == "determinism" ? static_cast<double>(++ticks_of_all) : 0);
    if (fault_ == "state") time_ += static_cast<double>(++ticks_);
    if (fault_ == "allocation") copy_ = std::make_unique<double>(time_);
  }
  std::string fault_;
  double time_ = 0;
  long ticks_ = 0;
  std::unique_ptr<double> copy_;
};

/// Writes how many ticks there were.
class Tally final : public Observer {
 public:
  Tally(const RecorderContext& context, std::string fault) : folder_(context.folder), fault_(std::move(fault)) {}
  void observe(const ObservedTick& tick) override {
    if (fault_ == "files-throws") throw std::runtime_error("no pencil");
    sum_ += fault_ == "determinism" ? tick.tick_us : 1;
  }
  void close() override {
    if (fault_ != "files") runtime::writeFile(folder_ + "/tally.txt", std::to_string(sum_));
  }

 private:
  std::string folder_, fault_;
  double sum_ = 0;
};

/// Sums forces over ticks.
class Gauge final : public Measure {
 public:
  explicit Gauge(std::string fault) : fault_(std::move(fault)) {}
  void metrics(std::vector<Metric>& metrics) const override {
    if (fault_ == "figures-none") return;
    metrics.push_back({fault_ == "figures-renamed" && ticks_ > 3 ? "force" : "sum_N", sum_});
    if (fault_ == "figures") metrics.push_back({"inverse", 1 / static_cast<double>(ticks_ > 5 ? 0 : 1)});
  }

 private:
  void doObserve(const ObservedTick& tick) override {
    static int calls = 0;
    for (const ContactRecord& contact : tick.truth.contacts) sum_ += contact.force_N;
    if (fault_ == "allocation") copy_ = std::make_unique<double>(sum_);
    if (fault_ == "determinism") sum_ += ++calls;
    ++ticks_;
  }
  void doArchive(Archive& archive) override {
    archive("ticks", ticks_);
    if (fault_ != "state") archive("sum", sum_);
  }

  std::string fault_;
  double sum_ = 0;
  long ticks_ = 0;
  std::unique_ptr<double> copy_;
};

void registerParts(Registry& registry) {
  const auto rowOf = [](const std::string& name) {
    ElementRow row;
    row.name = "lawless." + name;
    row.description = "A part.";
    return row;
  };
  for (const std::string fault : {"good", "distance", "distance-bound", "gradient", "convexity", "support", "allocation",
                                  "determinism"})
    registry.addShape(rowOf("ball-" + fault), [fault](const ElementValues&) { return std::make_shared<Ball>(fault); });
  for (const std::string fault : {"good", "felt", "felt-joints", "allocation", "determinism", "state"}) {
    ElementRow row = rowOf("scale-" + fault);
    row.ports = {{"force", "scalar", "N", "The sum.", 1}};
    registry.addSensor(row, [fault](const SensorContext&) { return std::make_unique<Scale>(fault); });
  }
  for (const std::string fault : {"good", "tasks", "allocation", "determinism", "state", "jacobian", "frame"}) {
    ElementRow row = rowOf("owner-" + fault);
    row.attributes = {{.name = "target", .type = ValueType::reals, .unit = "m", .default_text = "0.6 0.1 0.3",
                       .description = "World axes.", .count = 3, .in_world = InWorld::positions}};
    registry.addController(row, [fault](const BuildContext& context) {
      ControlledLevel level{std::make_unique<Owner>(fault), {}};
      const std::string spring = fault == "jacobian" ? "lawless.jacobian" : "lawless.good";
      const std::string target = context.values.text("target");
      if (fault != "tasks")
        level.tasks.push_back(
            {"spring", context.task(spring, {{"frame", "palm"}, {"target", fault == "frame" ? "0 0 0.5" : target}})});
      return level;
    });
  }
  for (const std::string fault :
       {"good", "figures", "figures-none", "figures-renamed", "allocation", "determinism", "state"})
    registry.addMeasure(rowOf("gauge-" + fault), [fault](const MeasureContext&) { return std::make_unique<Gauge>(fault); });
  for (const std::string fault : {"good", "files", "files-throws", "determinism"})
    registry.addRecorder(rowOf("tally-" + fault), [fault](const RecorderContext& context) {
      return std::make_unique<Tally>(context, fault);
    });
}

void registerElements(Registry& registry) {
  for (const std::string fault : {"good", "good-untold", "jacobian", "jacobian-untold", "bias", "frame", "allocation",
                                  "determinism", "state", "rows", "rows-nan", "instance", "attributes", "schema",
                                  "schema-unit"}) {
    ElementRow row;
    row.name = "lawless." + fault;
    row.description = "A spring.";
    row.attributes = {{.name = "frame", .type = ValueType::link, .required = true, .description = "The link."},
                      {.name = "target", .type = ValueType::reals, .unit = "m", .default_text = "0.6 0.1 0.3",
                       .description = "World axes.", .count = 3, .in_world = InWorld::positions}};
    if (fault == "frame") row.attributes[1].in_world = InWorld::no;
    if (fault == "schema") row.attributes[0].description = "";
    if (fault == "schema-unit") row.attributes[1].unit = "";
    if (fault == "attributes") row.attributes.push_back({.name = "idle", .description = "Nobody reads it."});
    registry.addTask(row, [fault](const BuildContext& context) { return std::make_unique<Spring>(context, fault); });
  }
  for (const std::string fault :
       {"good", "ports", "ports-moving", "ports-nan", "allocation", "determinism", "state", "schema"}) {
    ElementRow row;
    row.name = "lawless.clock-" + fault;
    row.description = "Tells the time.";
    row.ports = {{"now", "scalar", "s", fault == "schema" ? "" : "The time."}};
    registry.addSignal(row, [fault](const BuildContext&) { return std::make_unique<Clock>(fault); });
  }
  for (const std::string fault : {"good", "torque", "torque-nan", "determinism"}) {
    ElementRow row;
    row.name = "lawless.sum-" + fault;
    row.description = "Adds all torques.";
    registry.addBackEnd(row, [fault](const ElementValues&) { return std::make_unique<Sum>(fault); });
  }
  registerParts(registry);
}

}  // namespace

TACTUS_PLUGIN("lawless", "1.0.0", "BSD-3-Clause", registerElements)
