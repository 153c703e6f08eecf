#include <nlopt.h>

#include <memory>

#include "plugins/qp/qp_solver.h"

namespace tactus::qp {
namespace {

constexpr int max_evaluations = 200;
constexpr double relative_step = 1e-12;                            // of v, at which SLSQP stops

double objective(unsigned n, const double* v, double* gradient, void*) {
  const Eigen::Map<const Eigen::VectorXd> point(v, n);
  if (gradient) Eigen::Map<Eigen::VectorXd>(gradient, n) = point;
  return 0.5 * point.squaredNorm();
}

void constraints(unsigned m, double* result, unsigned n, const double* v, double* gradient, void* data) {
  const auto& programme = *static_cast<const LeastDistanceProgramme*>(data);
  Eigen::Map<Eigen::VectorXd>(result, m).noalias() =
      programme.rows.transpose() * Eigen::Map<const Eigen::VectorXd>(v, n) - programme.bounds;
  // m × n by rows, as NLopt wants it.
  if (gradient) Eigen::Map<control::RowMajorMatrix>(gradient, m, n) = programme.rows.transpose();
}

/// Sequential least-squares programming (Kraft 1988).  Its first quadratic model has the identity as Hessian, which
/// here is the true one, so that one or two steps suffice.
class NloptSolver final : public QpSolver {
  SolverReport doSolve(const LeastDistanceProgramme& programme, Eigen::VectorXd& v) override {
    const unsigned n = static_cast<unsigned>(programme.variables());
    const unsigned m = static_cast<unsigned>(programme.count());
    const std::unique_ptr<nlopt_opt_s, void (*)(nlopt_opt)> optimiser(nlopt_create(NLOPT_LD_SLSQP, n), nlopt_destroy);
    nlopt_opt opt = optimiser.get();
    nlopt_set_min_objective(opt, objective, nullptr);
    const Eigen::VectorXd tolerance = Eigen::VectorXd::Zero(m);
    if (m > 0)
      nlopt_add_inequality_mconstraint(opt, m, constraints, const_cast<LeastDistanceProgramme*>(&programme),
                                       tolerance.data());
    nlopt_set_xtol_rel(opt, relative_step);
    nlopt_set_maxeval(opt, max_evaluations);
    double value = 0;
    const nlopt_result result = nlopt_optimize(opt, v.data(), &value);
    return {nlopt_result_to_string(result), nlopt_get_numevals(opt)};
  }
};

}  // namespace

std::unique_ptr<QpSolver> makeNloptSolver() { return std::make_unique<NloptSolver>(); }

}  // namespace tactus::qp
