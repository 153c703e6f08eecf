#pragma once

#include "dsl/json_node.h"
#include "framework/control/tick_problem.h"

/// Parts of the tick problem file that a capsule shares with it.
namespace tactus::dsl {

/// Every value as it is: JSON knows no infinity, so it is written "inf", "-inf" and "nan".
Json exactNumbers(const Eigen::Ref<const Eigen::VectorXd>& values);

/// The problem at the root of a document.  `checked`: the mass matrix must be symmetric positive definite.
control::TickProblem problemFromJson(const JsonNode& root, bool checked);
Json problemToJson(const control::TickProblem& problem);

}  // namespace tactus::dsl
