#pragma once

#include <vector>

#include "framework/control/back_end.h"
#include "framework/control/observer.h"

/// Back ends on the same tick problems: what they answer, apart from where their answers would lead.
namespace tactus::app {

/// Keeps every k-th tick problem of a run.
class ProblemSampler final : public control::Observer {
 public:
  explicit ProblemSampler(long every) : every_(every) {}
  void observe(const control::ObservedTick& tick) override;
  const std::vector<control::TickProblem>& problems() const { return problems_; }
  const std::vector<double>& times() const { return times_; }      ///< of the problems, s

 private:
  long every_;
  long ticks_ = 0;
  std::vector<control::TickProblem> problems_;
  std::vector<double> times_;
};

/// What one back end answered to a list of problems.
struct Answers {
  std::vector<Eigen::VectorXd> torques;                            ///< empty where it did not solve
  std::vector<control::TickSolution> solutions;
  std::vector<double> solve_us;
  long unsolved = 0;                                               ///< infeasible or failed
  bool has_kkt = false;
  control::KktResidual kkt_max;
  double violation_max = 0;                                        ///< relative; see relativeViolation
};

Answers solveAll(control::BackEnd& back_end, const std::vector<control::TickProblem>& problems);

/// Worst violation of a constraint, relative: the KKT primal residual where the back end has one.  A cascade has
/// none; its promise is that lower levels leave the rows of level 1 alone: |J M⁻¹ τ_l| for an equality row,
/// max(0, J M⁻¹ τ_l) for an inequality row, with τ_l = τ − scale · Σ JᵀF of level 1, over ‖J‖ ‖τ‖ in the M⁻¹ norm.
double relativeViolation(const control::TickProblem& problem, const control::TickSolution& solution);

/// Differences of torques in the M⁻¹ norm, ‖x‖² = xᵀ M⁻¹ x; `relative` is over the norm of the reference, or
/// leastTorque where that is shorter.
struct TorqueDifference {
  double mean = 0, max = 0;
  double relative_mean = 0, relative_max = 0;
  long compared = 0;                                               ///< problems that both solved
};

/// A length of torques, M⁻¹ norm, that is worth the name in this problem: below it there is only rounding.
double leastTorque(const control::TickProblem& problem);

TorqueDifference compareTorques(const std::vector<control::TickProblem>& problems, const Answers& reference,
                                const Answers& other);

}  // namespace tactus::app
