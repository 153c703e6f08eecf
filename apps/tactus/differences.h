#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/tactus/same_states.h"

/// Where two back ends differ on the same tick problems, and why: active sets, saturated joints, scaling.
namespace tactus::app {

/// What one answer has at a bound and another has not.
struct BoundsOf {
  std::vector<control::ActiveRow> rows;                            ///< inequality rows
  std::vector<int> joints;                                         ///< at a torque limit
};

/// A task that one answer does better than the other.
struct TaskDifference {
  int level = 0, task = 0;                                         ///< indices into the problem
  double asked = 0;                                                ///< ‖a‖, m/s² or rad/s²
  double here = 0, there = 0;                                      ///< ‖J M⁻¹ τ − a‖ of both answers
};

struct TickDifference {
  double time = 0;                                                 ///< s
  bool both_solved = true;
  double distance = 0;                                             ///< of the torques, M⁻¹ norm
  double relative = 0;                                             ///< over the norm of the reference
  BoundsOf here;                                                   ///< at a bound in this answer alone
  BoundsOf there;                                                  ///< in the reference alone
  std::vector<TaskDifference> tasks;                               ///< the largest shares of what is asked first
};

TickDifference differenceOf(const control::TickProblem& problem, const control::TickSolution& reference,
                            const control::TickSolution& other);

/// Of all problems, in their order.
std::vector<TickDifference> differences(const ProblemSampler& sampler, const Answers& reference, const Answers& other);

/// [{time, both_solved, distance, relative, active_here: [{task, row}], active_there, limits_here: [joints],
///   limits_there, tasks: [{task, asked, missed_here, missed_there}], solve_us}]
nlohmann::ordered_json toJson(const std::vector<TickDifference>& differences, const ProblemSampler& sampler,
                              const Answers& other, const std::vector<std::string>& joints);

/// "t = 0.35 s, 12 % apart: at their bounds here alone: 'limits' row 2; …": the largest ones, a line each.
std::vector<std::string> largestDifferences(const std::vector<TickDifference>& differences,
                                            const ProblemSampler& sampler, const std::vector<std::string>& joints,
                                            const std::string& reference, size_t most = 3);

}  // namespace tactus::app
