#pragma once

#include <memory>

#include "framework/control/back_end.h"
#include "plugins/qp/qp_solver.h"
#include "plugins/qp/weighted_qp.h"

namespace tactus::qp {

/// The weighted quadratic programme of a tick, solved by a given solver.
///
/// With `polish` the solver says which rows may be at their bounds, those that its answer leaves within a tolerance;
/// over these rows alone the nearest point is then computed exactly, as OSQP polishes (Stellato et al. 2020).  The
/// tolerances are tried from the least; where none gives an optimum, and without polish, the solver's own numbers stand.
///
/// Whatever the solver says of itself, the answer is `ok` only when its KKT residual, computed apart, keeps the limits
/// below.  Otherwise the torque of the first level, cut to the torque limits, is left, and the status is `infeasible`
/// when the constraints contradict each other, `failed` when not.
class QpBackEnd final : public control::BackEnd {
 public:
  QpBackEnd(const WeightedQpOptions& options, std::unique_ptr<QpSolver> solver, bool polish = true);
  ~QpBackEnd() override;

  static constexpr double polish_tolerances[] = {1e-6, 1e-4, 1e-2}; ///< relative to the largest violation at v = 0
  static constexpr double primal_limit = 1e-6;
  static constexpr double complementarity_limit = 1e-6;
  static constexpr double stationarity_limit = 1e-4;

 private:
  void doPrepare(const control::TickProblem& shape) override;
  void doSolve(const control::TickProblem& problem, control::TickSolution& solution) override;

  struct Workspace;
  bool polish(double tolerance);
  bool judge(control::TickSolution& solution);
  void report(const control::TickProblem& problem, control::TickSolution& solution);
  void fallBack(const control::TickProblem& problem, control::TickSolution& solution);

  WeightedQpOptions options_;
  std::unique_ptr<QpSolver> solver_;
  bool polish_;
  std::unique_ptr<Workspace> work_;
};

}  // namespace tactus::qp
