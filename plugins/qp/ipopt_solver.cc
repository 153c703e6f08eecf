#include <IpIpoptApplication.hpp>
#include <IpSolveStatistics.hpp>
#include <IpTNLP.hpp>
#include <limits>
#include <string>

#include "plugins/qp/qp_solver.h"

namespace tactus::qp {
namespace {

using Ipopt::Index;
using Ipopt::Number;

constexpr double no_bound = -2e19;                                 // Ipopt's −∞

/// The programme in Ipopt's words: dense rows, constant Jacobian, Hessian of the Lagrangian σ I.
class Problem final : public Ipopt::TNLP {
 public:
  void set(const LeastDistanceProgramme& programme, Eigen::VectorXd& v) {
    programme_ = &programme;
    v_ = &v;
  }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = programme_->variables();
    m = programme_->count();
    jacobian = n * m;
    hessian = n;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* row_lower, Number* row_upper) override {
    std::fill_n(lower, n, no_bound);
    std::fill_n(upper, n, -no_bound);
    std::fill_n(row_lower, m, no_bound);
    std::copy_n(programme_->bounds.data(), m, row_upper);
    return true;
  }
  bool get_starting_point(Index n, bool, Number* v, bool, Number*, Number*, Index, bool, Number*) override {
    std::copy_n(v_->data(), n, v);
    return true;
  }
  bool eval_f(Index n, const Number* v, bool, Number& value) override {
    value = 0.5 * Eigen::Map<const Eigen::VectorXd>(v, n).squaredNorm();
    return true;
  }
  bool eval_grad_f(Index n, const Number* v, bool, Number* gradient) override {
    std::copy_n(v, n, gradient);
    return true;
  }
  bool eval_g(Index n, const Number* v, bool, Index m, Number* value) override {
    Eigen::Map<Eigen::VectorXd>(value, m).noalias() =
        programme_->rows.transpose() * Eigen::Map<const Eigen::VectorXd>(v, n);
    return true;
  }
  bool eval_jac_g(Index n, const Number*, bool, Index m, Index, Index* row, Index* column, Number* values) override {
    // Entry k m + j is row j, variable k: the order in which the rows are stored.
    if (values) {
      std::copy_n(programme_->rows.data(), n * m, values);
      return true;
    }
    for (Index k = 0; k < n; ++k)
      for (Index j = 0; j < m; ++j) {
        row[k * m + j] = j;
        column[k * m + j] = k;
      }
    return true;
  }
  bool eval_h(Index n, const Number*, bool, Number factor, Index, const Number*, bool, Index, Index* row, Index* column,
              Number* values) override {
    for (Index k = 0; k < n; ++k) {
      if (values)
        values[k] = factor;
      else
        row[k] = column[k] = k;
    }
    return true;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* v, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    std::copy_n(v, n, v_->data());
  }

 private:
  const LeastDistanceProgramme* programme_ = nullptr;
  Eigen::VectorXd* v_ = nullptr;
};

/// Primal-dual interior point (Wächter and Biegler 2006).
class IpoptSolver final : public QpSolver {
 public:
  explicit IpoptSolver(double tolerance) : application_(new Ipopt::IpoptApplication(false)), problem_(new Problem) {
    const auto options = application_->Options();
    options->SetIntegerValue("print_level", 0);
    options->SetStringValue("sb", "yes");
    options->SetStringValue("hessian_constant", "yes");
    options->SetStringValue("jac_d_constant", "yes");
    options->SetStringValue("nlp_scaling_method", "none");
    options->SetStringValue("mehrotra_algorithm", "yes");
    options->SetNumericValue("bound_relax_factor", relaxation);
    options->SetNumericValue("tol", tolerance);
    options->SetNumericValue("constr_viol_tol", tolerance);
    options->SetNumericValue("compl_inf_tol", tolerance);
    options->SetNumericValue("dual_inf_tol", tolerance);
    options->SetIntegerValue("max_iter", max_iterations);
    initialised_ = application_->Initialize("") == Ipopt::Solve_Succeeded;
  }

 private:
  static constexpr int max_iterations = 100;                       // 10 to 20 are usual
  /// Rows that oppose each other leave no interior; so much of one keeps the barrier finite.  Relative to a problem
  /// of order 1.
  static constexpr double relaxation = 1e-12;

  SolverReport doSolve(const LeastDistanceProgramme& programme, Eigen::VectorXd& v) override {
    if (!initialised_) return {"Ipopt could not be set up", 0};
    if (programme.variables() == 0) return {"no variables", 0};
    static_cast<Problem*>(Ipopt::GetRawPtr(problem_))->set(programme, v);
    const Ipopt::ApplicationReturnStatus status = application_->OptimizeTNLP(problem_);
    SolverReport report;
    report.status = "Ipopt return status " + std::to_string(static_cast<int>(status));
    if (Ipopt::IsValid(application_->Statistics())) report.iterations = application_->Statistics()->IterationCount();
    return report;
  }

  Ipopt::SmartPtr<Ipopt::IpoptApplication> application_;
  Ipopt::SmartPtr<Ipopt::TNLP> problem_;
  bool initialised_ = false;
};

}  // namespace

std::unique_ptr<QpSolver> makeIpoptSolver(double tolerance) { return std::make_unique<IpoptSolver>(tolerance); }

}  // namespace tactus::qp
