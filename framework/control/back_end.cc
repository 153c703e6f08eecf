#include "framework/control/back_end.h"

namespace tactus::control {
namespace {

constexpr int message_capacity = 256;                              // characters: a tick's message takes no memory

}  // namespace

void BackEnd::prepare(const TickProblem& shape, TickSolution& solution) {
  solution = TickSolution{};
  solution.message.reserve(message_capacity);
  solution.torque.setZero(shape.dof);
  int contact_rows = 0;
  for (const TickLevel& level : shape.levels) {
    LevelReport report;
    report.priority = level.priority;
    int rows = 0;
    for (const TickTask& task : level.tasks) {
      rows += task.capacity();
      if (task.contact) contact_rows += task.capacity();
    }
    report.active.reserve(rows);
    // Moved, not copied: a copy would forget what was reserved.
    solution.levels.push_back(std::move(report));
  }
  solution.contact_forces.setZero(contact_rows);
  doPrepare(shape);
}

}  // namespace tactus::control
