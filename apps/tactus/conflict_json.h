#pragma once

#include <nlohmann/json.hpp>

#include "framework/control/conflict.h"

namespace tactus::app {

/// {sentence, groups: [{what: "rows" | "forces" | "torque-limit", task? | joint?, place?}],
///  relaxations: [the same with {amount, unit, upper?, enough}], beyond: [{joint, beyond_Nm}]}; joints by their names,
/// by their numbers from 1 where they have none.
nlohmann::ordered_json conflictToJson(const control::Conflict& conflict, const control::TickProblem& problem,
                                      const control::ConflictNames& names);

}  // namespace tactus::app
