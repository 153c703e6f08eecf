#pragma once

#include <memory>

#include "framework/control/back_end.h"
#include "plugins/qp/weighted_qp.h"

namespace tactus::qp {

/// Solves the programme of a tick.  Whatever it says of itself, the back end judges its answer by `kkt`.
class ProgrammeSolver {
 public:
  virtual ~ProgrammeSolver() = default;

  enum class Verdict {
    done,                                                          ///< as good as it gets: `kkt` says how good
    infeasible,
    late                                                           ///< the deadline came first
  };
  struct Answer {
    Verdict verdict = Verdict::done;
    control::KktResidual kkt;
    int iterations = 0;
    int released = 0;                                              ///< rows held on the way and let go again
    const char* status = "";                                       ///< what the solver says of itself
  };

  virtual void prepare(const control::TickProblem& shape, const WeightedQpOptions& options) = 0;
  virtual Answer solve(const Programme& programme, const control::Deadline& deadline, Eigen::VectorXd& x) = 0;
  /// Rows of the programme that are at their bounds in the last answer.
  virtual int activeCount() const = 0;
  virtual int active(int i) const = 0;
  /// See control::BackEnd.
  virtual control::WarmStart warmStart() const { return {}; }
  virtual void setWarmStart(const control::WarmStart&) {}
};

/// The weighted quadratic programme of a tick, solved by a given solver.
///
/// The answer is `ok` only when its KKT residual and its torque keep the limits below.  Otherwise the torque of the first level, cut
/// to the torque limits, is left, and the status is `infeasible` when the constraints contradict each other, `failed`
/// when not.
class QpBackEnd final : public control::BackEnd {
 public:
  QpBackEnd(const WeightedQpOptions& options, std::unique_ptr<ProgrammeSolver> solver);
  ~QpBackEnd() override;

  static constexpr double primal_limit = 1e-6;
  static constexpr double complementarity_limit = 1e-6;
  static constexpr double stationarity_limit = 1e-4;

  control::WarmStart warmStart() const override { return solver_->warmStart(); }
  void setWarmStart(const control::WarmStart& start) override { solver_->setWarmStart(start); }

 private:
  void doPrepare(const control::TickProblem& shape) override;
  void doSolve(const control::TickProblem& problem, control::TickSolution& solution) override;

  struct Workspace;
  void report(const control::TickProblem& problem, control::TickSolution& solution);
  void fallBack(const control::TickProblem& problem, control::TickSolution& solution);

  WeightedQpOptions options_;
  std::unique_ptr<ProgrammeSolver> solver_;
  std::unique_ptr<Workspace> work_;
};

bool isOptimal(const control::KktResidual& kkt);

}  // namespace tactus::qp
