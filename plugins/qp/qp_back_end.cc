#include "plugins/qp/qp_back_end.h"

#include <algorithm>

#include "framework/control/kkt.h"
#include "framework/control/level_ranks.h"
#include "plugins/qp/reduction.h"

namespace tactus::qp {

using control::ActiveRow;
using control::Status;
using control::TickProblem;
using control::TickSolution;

struct QpBackEnd::Workspace {
  Workspace(const TickProblem& shape, const WeightedQpOptions& options)
      : whitened(shape),
        programme(shape, options),
        reduction(WeightedQp::variableCapacity(shape), WeightedQp::objectiveCapacity(shape), shape.rowCapacity(),
                  WeightedQp::inequalityCapacity(shape)),
        kkt(WeightedQp::variableCapacity(shape), shape.rowCapacity(), WeightedQp::inequalityCapacity(shape)),
        ranks(shape),
        nearest(WeightedQp::variableCapacity(shape), WeightedQp::inequalityCapacity(shape)),
        y(shape.dof) {}

  control::WhitenedProblem whitened;
  WeightedQp programme;
  Reduction reduction;
  control::KktCheck kkt;
  control::LevelRanks ranks;
  control::LeastDistance nearest;
  Eigen::VectorXd v;
  Eigen::VectorXd x;
  Eigen::VectorXd y;                                               // L⁻¹ τ
};

QpBackEnd::QpBackEnd(const WeightedQpOptions& options, std::unique_ptr<QpSolver> solver, bool polish)
    : BackEnd({.inequalities = true, .torque_limits = true, .force_bounds = true, .friction_cones = true}),
      options_(options),
      rows_(std::move(solver), polish) {}

QpBackEnd::~QpBackEnd() = default;

void QpBackEnd::doPrepare(const TickProblem& shape) {
  work_ = std::make_unique<Workspace>(shape, options_);
  rows_.prepare(WeightedQp::variableCapacity(shape), WeightedQp::inequalityCapacity(shape));
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
  work.reduction.reduce(work.programme.programme());
  const LeastDistanceProgramme& reduced = work.reduction.leastDistance();
  SolverReport solver;
  bool optimal = false;
  for (const double tolerance : polish_tolerances) {
    solver = rows_.solve(reduced, tolerance, work.v);
    work.reduction.restore(work.v, work.x);
    optimal = judge(solution);
    if (optimal || !rows_.polishes()) break;
  }
  solution.iterations = solver.iterations;
  if (!optimal || work.reduction.contradictory()) {
    const bool infeasible =
        work.reduction.contradictory() ||
        work.nearest.solve(reduced.rows, reduced.bounds, Eigen::VectorXd::Zero(reduced.variables())) ==
            control::LeastDistance::Outcome::infeasible;
    solution.status = infeasible ? Status::infeasible : Status::failed;
    solution.message = infeasible ? "torque limits, force bounds and rows contradict each other"
                                  : "the solver's answer is not optimal (" + solver.status + ")";
    fallBack(problem, solution);
  } else {
    solution.n_contact_forces = work.programme.answer(problem, work.whitened, work.x, solution.torque,
                                                      solution.contact_forces);
  }
  report(problem, solution);
}

// Computes the KKT residual of work.x; true when it keeps the limits.
bool QpBackEnd::judge(TickSolution& solution) {
  solution.kkt = work_->kkt.residual(work_->programme.programme(), work_->x);
  solution.has_kkt = true;
  return solution.kkt.primal <= primal_limit && solution.kkt.complementarity <= complementarity_limit &&
         solution.kkt.stationarity <= stationarity_limit;
}

void QpBackEnd::fallBack(const TickProblem& problem, TickSolution& solution) {
  if (work_->whitened.levelCount() > 0) {
    work_->y = work_->whitened.ownTorque(0);
    work_->whitened.toTorque(work_->y, solution.torque);
  }
  if (problem.torque_limits)
    solution.torque = solution.torque.cwiseMax(problem.torque_limits->lower).cwiseMin(problem.torque_limits->upper);
}

void QpBackEnd::report(const TickProblem& problem, TickSolution& solution) {
  Workspace& work = *work_;
  work.ranks.report(work.whitened, solution);
  work.y = work.whitened.massFactor().triangularView<Eigen::Lower>().solve(solution.torque);
  for (int i = 0; i < work.whitened.levelCount(); ++i)
    solution.levels[i].residual = work.whitened.residual(problem, i, work.y);
  if (solution.status != Status::ok) return;
  for (int i = 0; i < work.kkt.activeCount(); ++i) {
    const int row = work.programme.inequalityOrigin(work.kkt.active(i));
    if (row < 0) continue;
    const ActiveRow& at = work.whitened.origin(row);
    solution.levels[at.level].active.push_back(at);
    ++solution.rows_held;
  }
}

}  // namespace tactus::qp
