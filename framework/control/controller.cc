#include "framework/control/controller.h"

#include <cmath>

#include "framework/control/element_values.h"

namespace tactus::control {

namespace {

/// Numbers beyond it overflow when a back end squares them.
constexpr double largest_usable = 1e150;

template <class Matrix>
bool isUsable(const Matrix& numbers) {
  return numbers.size() == 0 || (numbers.allFinite() && numbers.cwiseAbs().maxCoeff() < largest_usable);
}

bool isUsable(const TickTask& task) {
  return isUsable(task.J()) && isUsable(task.F()) && isUsable(task.J().transpose() * task.F()) &&
         (!task.has_acceleration || isUsable(task.acceleration.head(task.rows)));
}

/// Runs the step of one part of the stack, "task 'hold'"; what it throws becomes a TickError that names the part.
template <class Step, class Name>
void guarded(double time, Step step, Name name) {
  const auto said = [&] { return name() + " failed at t = " + formatNumber(time) + " s: "; };
  try {
    step();
  } catch (const std::exception& error) {
    throw TickError(said() + error.what());
  } catch (...) {
    throw TickError(said() + "it threw something that is not a std::exception");
  }
}

/// A task must leave its storage as it got it, and fill no more rows than it announced.
void checkRows(const TickTask& rows, int capacity, int dof) {
  if (rows.rows < 0 || rows.rows > capacity) {
    throw std::runtime_error("it fills " + std::to_string(rows.rows) + " rows, but announced at most " +
                             std::to_string(capacity));
  }
  if (rows.jacobian.rows() != capacity || rows.jacobian.cols() != dof || rows.force.size() != capacity ||
      rows.acceleration.size() != capacity) {
    throw std::runtime_error("it changed the size of its rows: jacobian must stay " + std::to_string(capacity) + " × " +
                             std::to_string(dof) + ", force and acceleration " + std::to_string(capacity));
  }
}

TickProblem makeProblemShape(const dynamics::Model& model, const std::vector<Level>& levels) {
  const int dof = model.dof();
  TickProblem problem;
  problem.dof = dof;
  problem.mass_matrix = Eigen::MatrixXd::Identity(dof, dof);
  TorqueLimits limits;
  limits.lower = -model.effort();
  limits.upper = model.effort();
  problem.torque_limits = limits;
  for (const Level& level : levels) {
    TickLevel& shape = problem.levels.emplace_back();
    shape.priority = level.priority;
    shape.weight = level.weight;
    for (const NamedTask& named : level.tasks) {
      TickTask& task = shape.tasks.emplace_back(named.name, named.task->capacity(), dof);
      task.relation = named.task->relation();
      task.contact = named.task->isContact();
    }
  }
  return problem;
}

}  // namespace

Controller::Controller(std::shared_ptr<const dynamics::Model> model, std::vector<NamedSignal> signals,
                       std::vector<Level> levels, std::unique_ptr<BackEnd> back_end, double period,
                       const Eigen::Vector3d& gravity_W)
    : model_(std::move(model)),
      signals_(std::move(signals)),
      levels_(std::move(levels)),
      back_end_(std::move(back_end)),
      period_(period),
      cache_(*model_, gravity_W),
      problem_(makeProblemShape(*model_, levels_)),
      torque_(Eigen::VectorXd::Zero(model_->dof())) {
  back_end_->prepare(problem_, solution_);
}

const Eigen::VectorXd& Controller::tick(const Sensed& sensed) {
  cache_.update(sensed.q, sensed.qd);
  const Tick now{sensed.time, period_, sensed, cache_};
  for (const NamedSignal& named : signals_) {
    guarded(now.time, [&] { named.signal->update(now); }, [&] { return "signal '" + named.name + "'"; });
  }
  assembleProblem(now);
  record_ = TickRecord{};
  guarded(now.time, [&] { back_end_->solve(problem_, solution_); }, [] { return std::string("the back end"); });
  record_.status = solution_.status;
  // A torque that is not finite must never reach the robot: hold it against gravity instead.
  record_.fallback = solution_.status != Status::ok || !solution_.torque.allFinite();
  if (record_.fallback) record_.unusable_task = findUnusableTask();
  if (!solution_.torque.allFinite()) solution_.torque.setZero();

  record_.limited = solution_.scale < 1;
  const Eigen::VectorXd& effort = model_->effort();
  for (int i = 0; i < model_->dof(); ++i) {
    const double wanted = solution_.torque[i] + cache_.bias()[i];
    torque_[i] = std::fmin(std::fmax(wanted, -effort[i]), effort[i]);
    if (std::abs(wanted - torque_[i]) > 1e-9 * effort[i]) record_.limited = true;
  }
  return torque_;
}

void Controller::assembleProblem(const Tick& tick) {
  problem_.mass_matrix = cache_.massMatrix();
  problem_.torque_limits->lower = -model_->effort() - cache_.bias();
  problem_.torque_limits->upper = model_->effort() - cache_.bias();
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    for (std::size_t k = 0; k < levels_[i].tasks.size(); ++k) {
      const NamedTask& named = levels_[i].tasks[k];
      TickTask& rows = problem_.levels[i].tasks[k];
      const auto update = [&] {
        named.task->update(tick, rows);
        checkRows(rows, named.task->capacity(), problem_.dof);
      };
      guarded(tick.time, update, [&] { return "task '" + named.name + "'"; });
    }
  }
}

const std::string* Controller::findUnusableTask() const {
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    for (std::size_t k = 0; k < levels_[i].tasks.size(); ++k) {
      if (!isUsable(problem_.levels[i].tasks[k])) return &levels_[i].tasks[k].name;
    }
  }
  return nullptr;
}

}  // namespace tactus::control
