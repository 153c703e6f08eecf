#pragma once

#include <memory>

#include "framework/control/back_end.h"
#include "plugins/qp/lazy_rows.h"
#include "plugins/qp/weighted_qp.h"

namespace tactus::qp {

/// The weighted quadratic programme of a tick, solved by a given solver.
///
/// The solver sees the programme through LazyRows.  Polishing tries its tolerances from the least; where none gives an
/// optimum, the solver's own numbers stand.
///
/// Whatever the solver says of itself, the answer is `ok` only when its KKT residual, computed apart, keeps the limits
/// below.  Otherwise the torque of the first level, cut to the torque limits, is left, and the status is `infeasible`
/// when the constraints contradict each other, `failed` when not.
class QpBackEnd final : public control::BackEnd {
 public:
  QpBackEnd(const WeightedQpOptions& options, std::unique_ptr<QpSolver> solver, bool polish = true);
  ~QpBackEnd() override;

  static constexpr double polish_tolerances[] = {1e-3, 1e-1};
  static constexpr double primal_limit = 1e-6;
  static constexpr double complementarity_limit = 1e-6;
  static constexpr double stationarity_limit = 1e-4;

 private:
  void doPrepare(const control::TickProblem& shape) override;
  void doSolve(const control::TickProblem& problem, control::TickSolution& solution) override;

  struct Workspace;
  bool judge(control::TickSolution& solution);
  void report(const control::TickProblem& problem, control::TickSolution& solution);
  void fallBack(const control::TickProblem& problem, control::TickSolution& solution);

  WeightedQpOptions options_;
  LazyRows rows_;
  std::unique_ptr<Workspace> work_;
};

}  // namespace tactus::qp
