#include "framework/control/controller.h"

#include <cmath>

namespace tactus::control {

namespace {

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
  for (const NamedSignal& named : signals_) named.signal->update(now);
  assembleProblem(now);
  back_end_->solve(problem_, solution_);

  record_ = TickRecord{};
  record_.status = solution_.status;
  // A torque that is not finite must never reach the robot: hold it against gravity instead.
  record_.fallback = solution_.status != Status::ok || !solution_.torque.allFinite();
  if (!solution_.torque.allFinite()) solution_.torque.setZero();

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
      levels_[i].tasks[k].task->update(tick, problem_.levels[i].tasks[k]);
    }
  }
}

}  // namespace tactus::control
