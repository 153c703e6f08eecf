// Elements that break one law each, named after it, and `lawless.good…`, which break none.

#include <cmath>

#include "framework/control/displacement.h"
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
  }

  std::string fault_;
  int frame_;
  Eigen::Vector3d target_W_;
};

class Clock final : public Signal {
 public:
  explicit Clock(std::string fault) : fault_(std::move(fault)) {}

 private:
  void doUpdate(const Tick& tick) override {
    static long ticks_of_all = 0;
    time_ = tick.time + (fault_ == "determinism" ? static_cast<double>(++ticks_of_all) : 0);
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

void registerElements(Registry& registry) {
  for (const std::string fault : {"good", "good-untold", "jacobian", "jacobian-untold", "bias", "frame", "allocation",
                                  "determinism", "rows", "rows-nan", "instance", "attributes", "schema",
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
       {"good", "ports", "ports-moving", "ports-nan", "allocation", "determinism", "schema"}) {
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
}

}  // namespace

TACTUS_PLUGIN("lawless", "1.0.0", "BSD-3-Clause", registerElements)
