#include "plugins/qp/qp_back_end.h"

#include "framework/control/level_ranks.h"

namespace tactus::qp {

using control::ActiveRow;
using control::Status;
using control::TickProblem;
using control::TickSolution;

struct QpBackEnd::Workspace {
  Workspace(const TickProblem& shape, const WeightedQpOptions& options)
      : whitened(shape),
        programme(shape, options),
        ranks(shape),
        x(WeightedQp::variableCapacity(shape)),
        y(shape.dof) {}

  control::WhitenedProblem whitened;
  WeightedQp programme;
  control::LevelRanks ranks;
  Eigen::VectorXd x;
  Eigen::VectorXd y;                                               // L⁻¹ τ
};

namespace {

bool keepsLimits(const TickProblem& problem, const Eigen::VectorXd& torque) {
  if (!problem.torque_limits) return true;
  const double tolerance = QpBackEnd::primal_limit * torque.norm();
  return (torque - problem.torque_limits->upper).maxCoeff() <= tolerance &&
         (problem.torque_limits->lower - torque).maxCoeff() <= tolerance;
}

void cutToLimits(const TickProblem& problem, Eigen::VectorXd& torque) {
  if (!problem.torque_limits) return;
  torque = torque.cwiseMax(problem.torque_limits->lower).cwiseMin(problem.torque_limits->upper);
}

}  // namespace

bool isOptimal(const control::KktResidual& kkt) {
  return kkt.primal <= QpBackEnd::primal_limit && kkt.complementarity <= QpBackEnd::complementarity_limit &&
         kkt.stationarity <= QpBackEnd::stationarity_limit;
}

QpBackEnd::QpBackEnd(const WeightedQpOptions& options, std::unique_ptr<ProgrammeSolver> solver)
    : BackEnd({.inequalities = true, .torque_limits = true, .force_bounds = true, .friction_cones = true}),
      options_(options),
      solver_(std::move(solver)) {}

QpBackEnd::~QpBackEnd() = default;

void QpBackEnd::doPrepare(const TickProblem& shape) {
  work_ = std::make_unique<Workspace>(shape, options_);
  solver_->prepare(shape, options_);
}

void QpBackEnd::doSolve(const TickProblem& problem, TickSolution& solution) {
  Workspace& work = *work_;
  control::resetSolution(problem, solution);
  if (!work.whitened.update(problem)) {
    solution.status = Status::failed;
    solution.message = "the mass matrix is not positive definite, or a Jacobian or force is not finite";
    return;
  }
  work.programme.build(problem, work.whitened);
  if (!isUsable(work.programme.programme())) {
    solution.status = Status::failed;
    solution.message = "weights, units and masses together make numbers that are too large to work with";
    fallBack(problem, solution);
    return;
  }
  const ProgrammeSolver::Answer answer = solver_->solve(work.programme.programme(), deadline(), work.x);
  solution.kkt = answer.kkt;
  solution.has_kkt = answer.verdict == ProgrammeSolver::Verdict::done;
  solution.iterations = answer.iterations;
  solution.rows_released = answer.released;
  if (solution.has_kkt && isOptimal(answer.kkt)) {
    solution.n_contact_forces = work.programme.answer(problem, work.whitened, work.x, solution.torque,
                                                      solution.contact_forces);
    if (!keepsLimits(problem, solution.torque)) {
      solution.status = Status::failed;
      solution.message = "the answer leaves the torque limits: the problem is scaled too badly";
      fallBack(problem, solution);
    } else {
      cutToLimits(problem, solution.torque);                       // by rounding
    }
  } else {
    solution.late = answer.verdict == ProgrammeSolver::Verdict::late;
    solution.status = answer.verdict == ProgrammeSolver::Verdict::infeasible ? Status::infeasible : Status::failed;
    if (solution.late) {
      solution.message = "the deadline came before the optimum";
    } else if (solution.status == Status::infeasible) {
      solution.message = "torque limits, force bounds and rows contradict each other";
    } else {
      solution.message = "the solver's answer is not optimal (";
      solution.message += answer.status;
      solution.message += ")";
    }
    fallBack(problem, solution);
  }
  report(problem, solution);
}

void QpBackEnd::fallBack(const TickProblem& problem, TickSolution& solution) {
  if (work_->whitened.levelCount() > 0) {
    work_->y = work_->whitened.ownTorque(0);
    work_->whitened.toTorque(work_->y, solution.torque);
  }
  cutToLimits(problem, solution.torque);
}

void QpBackEnd::report(const TickProblem& problem, TickSolution& solution) {
  Workspace& work = *work_;
  if (reportsRanks()) work.ranks.report(work.whitened, solution);
  work.y = solution.torque;
  work.whitened.massFactor().triangularView<Eigen::Lower>().solveInPlace(work.y);
  work.whitened.reportResiduals(problem, work.y, solution);
  if (solution.status != Status::ok) return;
  for (int i = 0; i < solver_->activeCount(); ++i) {
    const int row = work.programme.origin(solver_->active(i));
    if (row < 0 || work.programme.isEquality(solver_->active(i))) continue;
    const ActiveRow& at = work.whitened.origin(row);
    solution.levels[at.level].active.push_back(at);
    ++solution.rows_held;
  }
}

}  // namespace tactus::qp
