#include <string>

#include "framework/control/kkt.h"
#include "plugins/qp/lazy_rows.h"
#include "plugins/qp/reduction.h"
#include "plugins/qp/solvers.h"

namespace tactus::qp {
namespace {

constexpr double polish_tolerances[] = {1e-3, 1e-1};

class ReferenceSolver final : public ProgrammeSolver {
 public:
  ReferenceSolver(std::unique_ptr<QpSolver> solver, bool polish) : rows_(std::move(solver), polish) {}

  void prepare(const control::TickProblem& shape, const WeightedQpOptions& options) override {
    const int variables = WeightedQp::variableCapacity(shape);
    const int rows = 2 * WeightedQp::rowCapacity(shape, options);
    reduction_ = std::make_unique<Reduction>(variables, WeightedQp::objectiveCapacity(shape) + variables,
                                             shape.rowCapacity(), rows);
    kkt_ = std::make_unique<control::KktCheck>(variables, shape.rowCapacity(), rows);
    nearest_ = std::make_unique<control::LeastDistance>(variables, rows);
    rows_.prepare(variables, rows);
  }

  Answer solve(const Programme& programme, const control::Deadline&, Eigen::VectorXd& x) override {
    expand(programme, plain_, origins_);
    reduction_->reduce(plain_);
    const LeastDistanceProgramme& reduced = reduction_->leastDistance();
    Answer answer;
    if (!reduced.rows.allFinite() || !reduced.bounds.allFinite()) {
      answer.status = "its programme overflows";
      answer.kkt = {1, 1, 1};
      return answer;
    }
    for (const double tolerance : polish_tolerances) {
      const SolverReport report = rows_.solve(reduced, tolerance, v_);
      reduction_->restore(v_, point_);
      status_ = report.status;
      answer.iterations = report.iterations;
      answer.kkt = kkt_->residual(plain_, point_);
      if (isOptimal(answer.kkt) || !rows_.polishes()) break;
    }
    answer.status = status_.c_str();
    const auto contradiction = [&] {
      return nearest_->solve(reduced.rows, reduced.bounds, Eigen::VectorXd::Zero(reduced.variables())) ==
             control::LeastDistance::Outcome::infeasible;
    };
    if (reduction_->contradictory() || (!isOptimal(answer.kkt) && contradiction()))
      answer.verdict = Verdict::infeasible;
    x.head(programme.variables) = point_;
    return answer;
  }

  int activeCount() const override { return kkt_->activeCount(); }
  int active(int i) const override { return origins_[kkt_->active(i)]; }

 private:
  LazyRows rows_;
  std::unique_ptr<Reduction> reduction_;
  std::unique_ptr<control::KktCheck> kkt_;
  std::unique_ptr<control::LeastDistance> nearest_;
  control::ConstrainedLeastSquares plain_;
  std::vector<int> origins_;
  std::string status_;
  Eigen::VectorXd v_;
  Eigen::VectorXd point_;
};

}  // namespace

std::unique_ptr<ProgrammeSolver> makeReferenceSolver(std::unique_ptr<QpSolver> solver, bool polish) {
  return std::make_unique<ReferenceSolver>(std::move(solver), polish);
}

}  // namespace tactus::qp
