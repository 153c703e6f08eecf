#pragma once

#include <stdexcept>
#include <string>

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

/// What is wrong with a tick problem file; the message starts with the JSON path, e.g.
/// "levels[1].tasks[0].jacobian: row 2 has 8 numbers, expected 9" (rows count from 1).
class TickFileError : public std::runtime_error {
 public:
  TickFileError(std::string json_path, const std::string& reason);
  std::string json_path;                                           ///< "" = the file as a whole
};

/// Reads a file; throws runtime::FileError or TickFileError.
control::TickProblem readTickProblem(const std::string& file);
/// Reads a text; throws TickFileError.  Strict: an unknown, missing or repeated key is an error, and so are sizes that
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
