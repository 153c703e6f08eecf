#pragma once

#include <string>

#include "dsl/json_file_error.h"
#include "framework/control/tick_problem.h"
#include "framework/control/tick_solution.h"

/// The tick problem file, JSON with "format": "tactus-tick/1":
///
///   {format, dof, mass_matrix: [[…]], torque_limits?: {lower, upper, priority?},
///    levels: [{priority, weight?, tasks: [{name, relation: "equality" | "inequality", jacobian: [[…]], force: […],
///              acceleration?, contact?, force_max?, friction?}]}]}
///
/// A limit that is null is infinite.  Numbers keep every bit through a file.  A capsule (dsl/capsule.h) is such a file
/// with one more key, and reads as one.
namespace tactus::dsl {

/// Reads a file; throws runtime::FileError or JsonFileError.
control::TickProblem readTickProblem(const std::string& file);
/// Reads a text; throws JsonFileError.  Strict: an unknown, missing or repeated key is an error, and so are sizes that
/// do not fit and a mass matrix that is not symmetric positive definite.  Levels may come in any order.
control::TickProblem parseTickProblem(const std::string& text);

std::string tickProblemToJson(const control::TickProblem& problem);

/// "ok", "infeasible", "failed"
const char* statusName(control::Status status);

/// {backend, status, message?, torque, contact_forces?, scale, levels: [{priority, rank, nullity, residual,
/// active: [{task, row}]}], kkt?: {stationarity, primal, complementarity}, iterations, solve_us}
std::string solutionToJson(const control::TickProblem& problem, const control::TickSolution& solution,
                           const std::string& back_end, double solve_us);

}  // namespace tactus::dsl
