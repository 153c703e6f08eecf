#include "plugins/hqp/hqp.h"

#include "plugins/hqp/solver.h"

namespace tactus::hqp {

Hqp::Hqp(const HqpOptions& options)
    : BackEnd({.strict_levels = true,
               .inequalities = true,
               .torque_limits = true,
               .force_bounds = true,
               .friction_cones = true,
               .strict_first_level = true,
               .limits_at_levels = true}),
      options_(options) {}

Hqp::~Hqp() = default;

void Hqp::doPrepare(const TickProblem& shape) { solver_ = std::make_unique<Solver>(shape, options_); }
void Hqp::doSolve(const TickProblem& problem, TickSolution& solution) {
  solver_->solve(problem, deadline(), reportsRanks(), solution);
}
control::WarmStart Hqp::warmStart() const { return solver_->warmStart(); }
void Hqp::setWarmStart(const control::WarmStart& start) { solver_->setWarmStart(start); }

}  // namespace tactus::hqp
