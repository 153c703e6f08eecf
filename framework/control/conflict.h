#pragma once

#include <map>
#include <string>
#include <vector>

#include "framework/control/tick_problem.h"

/// Why a tick problem has no solution: the tasks and limits that contradict each other, and what would reconcile them.
///
/// The constraints are those that a back end with limits keeps (thesis 5.3.6–5.3.10).  With τ = τ_s + J_cᵀ f:
///   rows of a task       J M⁻¹ τ_s = 0 for equality contacts, ≤ 0 for inequality rows and for contacts that back off
///   forces of a contact  0 ≤ f ≤ f_max, |f_t₁| + |f_t₂| ≤ μ f_n
///   torque limit         lower ≤ τ ≤ upper, joint by joint
/// Each line of a task, and each joint, is one group for the search (row_conflict.h).
namespace tactus::control {

struct ConflictGroup {
  enum class Kind { rows, forces, torque_limit } kind = Kind::rows;
  int level = -1;                                                  ///< indices into the problem, of a task
  int task = -1;
  int joint = -1;                                                  ///< of a torque limit
};

/// How far one group of the conflict must give way, all others kept: the least in the sense of the sum of squares.
struct Relaxation {
  ConflictGroup group;
  double amount = 0;                            ///< of the row that gives most: m/s² or rad/s² of rows, N, or N m
  bool upper = true;                                               ///< of a torque limit: which side gives
  bool enough = true;                           ///< false: other constraints contradict each other besides
};

/// A joint whose limits leave out 0: b + g alone asks for more than its actuator has.
struct LimitBeyond {
  int joint = 0;
  double beyond = 0;                                               ///< N m by which 0 lies outside
};

struct Conflict {
  std::vector<ConflictGroup> groups;                               ///< none can be spared; empty: a solution exists
  std::vector<Relaxation> relaxations;                             ///< one for each group; any one of them would do
  std::vector<LimitBeyond> beyond;                                 ///< what keeps a back end that only scales from one

  bool exists() const { return !groups.empty(); }
};

/// Works on any problem; numbers that are not finite, or a mass matrix that is not positive definite, make no conflict.
/// Takes memory: not for every tick.
Conflict findConflict(const TickProblem& problem);

/// What a sentence calls things by.
struct ConflictNames {
  std::vector<std::string> joints;                                 ///< empty: "joint 3", counted from 1
  std::map<std::string, std::string> places;                       ///< of tasks, "stack.xml:12:5"; may be empty
};

/// "task 'hold' (stack.xml:12:5) and the torque limit of joint a3 contradict each other; …"; "" where nothing is wrong.
std::string describe(const Conflict& conflict, const TickProblem& problem, const ConflictNames& names = {});

}  // namespace tactus::control
