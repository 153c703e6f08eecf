#include "framework/control/tick_problem.h"

#include <utility>

namespace tactus::control {

TickTask::TickTask(std::string task_name, int capacity, int dof)
    : name(std::move(task_name)),
      jacobian(Eigen::MatrixXd::Zero(capacity, dof)),
      force(Eigen::VectorXd::Zero(capacity)),
      acceleration(Eigen::VectorXd::Zero(capacity)) {}

int TickProblem::rowCapacity() const {
  int rows = 0;
  for (const TickLevel& level : levels)
    for (const TickTask& task : level.tasks) rows += task.capacity();
  return rows;
}

}  // namespace tactus::control
