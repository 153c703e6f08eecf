#pragma once

#include <chrono>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "framework/control/tick_problem.h"
#include "framework/control/tick_solution.h"

namespace tactus::control {

/// What a back end can honour; a stack that asks for more is refused at its line.
struct Abilities {
  bool strict_levels = false;
  bool inequalities = false;
  bool torque_limits = false;
  bool force_bounds = false;
  bool friction_cones = false;
  bool strict_first_level = false;                                 ///< the first level is, even without strict_levels
  std::string why_not_strict = {};                                 ///< said where a level asks to be strict and is not
  bool limits_at_levels = false;                                   ///< TorqueLimits::priority
};

/// How much work one tick may take.  A back end that comes to its end leaves what it has: status `failed`, `late`, and
/// the torque of the strictly higher levels that it has settled.
struct Deadline {
  int iterations = std::numeric_limits<int>::max();                ///< of its solver, so that runs repeat
  double seconds = std::numeric_limits<double>::infinity();        ///< wall clock; runs then need not repeat
  bool isDeclared() const { return iterations < std::numeric_limits<int>::max() || seconds < 1e300; }
  /// The moment at which a solve that begins now must end.
  std::chrono::steady_clock::time_point end() const {
    using Clock = std::chrono::steady_clock;
    if (!(seconds < 1e6)) return Clock::time_point::max();
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }
};

/// What a back end carries from one tick to the next, as plain numbers of its own.
using WarmStart = std::vector<int>;

/// What a back end was made of: its element and the text of each option.  Empty for one that no registry made.
struct Recipe {
  std::string back_end;
  std::map<std::string, std::string> options;
};

/// Turns a tick problem into a torque.
///
/// `prepare` takes the memory for every problem of the given shape (same levels, tasks and capacities);
/// `solve` takes none in back ends that declare themselves free of allocation.  `solve` never throws for
/// numerical reasons: it says `infeasible` or `failed` and leaves a finite torque.
class BackEnd {
 public:
  virtual ~BackEnd() = default;

  const Abilities& abilities() const { return abilities_; }
  const Recipe& recipe() const { return recipe_; }
  void setRecipe(Recipe recipe) { recipe_ = std::move(recipe); }
  void prepare(const TickProblem& shape, TickSolution& solution);
  void solve(const TickProblem& problem, TickSolution& solution) { doSolve(problem, solution); }

  void setDeadline(const Deadline& deadline) { deadline_ = deadline; }
  const Deadline& deadline() const { return deadline_; }
  /// Whether ranks are wanted from back ends that can do without them and would compute them for the report alone; off,
  /// their ranks stay 0 and nullities dof.
  void setReportsRanks(bool wanted) { reports_ranks_ = wanted; }
  /// The state that, with the problem, decides the next solution to the bit; empty where every tick starts afresh.
  /// `setWarmStart` after `prepare`; what does not fit the shape is ignored.
  virtual WarmStart warmStart() const { return {}; }
  virtual void setWarmStart(const WarmStart&) {}

 protected:
  explicit BackEnd(Abilities abilities) : abilities_(std::move(abilities)) {}
  bool reportsRanks() const { return reports_ranks_; }

 private:
  virtual void doPrepare(const TickProblem& shape) = 0;
  virtual void doSolve(const TickProblem& problem, TickSolution& solution) = 0;

  Abilities abilities_;
  Recipe recipe_;
  Deadline deadline_;
  bool reports_ranks_ = true;
};

}  // namespace tactus::control
