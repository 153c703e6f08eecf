#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/control/back_end.h"
#include "framework/control/tick_problem.h"
#include "framework/control/tick_solution.h"

/// A failure capsule: a tick problem file with one more key, "capsule", that holds all that is needed to meet the same
/// answer again to the bit, and what is needed to understand it.
///
///   capsule: {backend, options: {name: text}, deadline?: {iterations?, seconds?}, warm_start: [integers],
///             capacities: [[rows that each task may have] of each level],
///             status, message?, threw?, late, iterations, torque,
///             tick, time (s), q, qd, joints: [names], places: {task: "file:line:column"}, stack: the resolved XML}
///
/// The problem of a tick that went wrong may hold what no other tick file may: the numbers "nan", "inf" and "-inf", and
/// a mass matrix that is not positive definite.
namespace tactus::dsl {

struct Capsule {
  // What decides the answer, together with the problem and the memory that its tasks may fill.
  std::string back_end;
  std::map<std::string, std::string> options;
  control::WarmStart warm_start;                                   ///< before the tick
  control::Deadline deadline;
  // What came of it.
  control::Status status = control::Status::failed;
  std::string message;
  bool threw = false;                                              ///< the back end did, and said `message`
  bool late = false;
  int iterations = 0;
  Eigen::VectorXd torque;                                          ///< N m, b + g not included
  // Where it happened.
  int tick = 0;                                                    ///< of the run, from 0
  double time = 0;                                                 ///< s
  Eigen::VectorXd q;
  Eigen::VectorXd qd;
  std::vector<std::string> joints;                                 ///< in the order of q
  std::map<std::string, std::string> places;                       ///< of tasks in the stack, "file:line:column"
  std::string stack;                                               ///< resolved, XML
};

/// A tick problem file, with or without a capsule.
struct TickFile {
  control::TickProblem problem;
  std::optional<Capsule> capsule;
};

/// Throws runtime::FileError or JsonFileError.
TickFile readTickFile(const std::string& file);
/// Throws JsonFileError.
TickFile parseTickFile(const std::string& text);

std::string capsuleToJson(const control::TickProblem& problem, const Capsule& capsule);

}  // namespace tactus::dsl
