#pragma once

#include "framework/control/tick_solution.h"

namespace tactus::control {

/// Of a torque that is not finite, which must reach no robot: it becomes 0, and a status that said `ok` `failed`.
inline void refuseTorque(TickSolution& solution) {
  solution.torque.setZero();
  if (solution.status != Status::ok) return;
  solution.status = Status::failed;
  solution.message = "the back end's torque is not finite";
}

}  // namespace tactus::control
