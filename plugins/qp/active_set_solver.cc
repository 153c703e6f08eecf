#include <algorithm>
#include <limits>

#include "plugins/qp/active_set.h"
#include "plugins/qp/solvers.h"

namespace tactus::qp {
namespace {

/// Gives ActiveSet the rows that were at their bounds in the last tick.  A tick whose programme has another shape starts
/// afresh, since its rows are others.
class ActiveSetSolver final : public ProgrammeSolver {
 public:
  void prepare(const control::TickProblem& shape, const WeightedQpOptions& options) override {
    const int variables = WeightedQp::variableCapacity(shape);
    active_set_ = std::make_unique<ActiveSet>(variables, shape.dof, WeightedQp::objectiveCapacity(shape),
                                              WeightedQp::rowCapacity(shape, options));
    start_.clear();
    start_.reserve(2 + variables);
  }

  Answer solve(const Programme& programme, const control::Deadline& deadline, Eigen::VectorXd& x) override {
    if (start_.size() > 2 && start_[0] == programme.rows && start_[1] == programme.variables)
      for (std::size_t i = 2; i < start_.size(); ++i)
        active_set_->guess(std::abs(start_[i]) - 1, start_[i] > 0 ? 1 : -1);
    active_set_->limit(deadline.iterations, deadline.end());
    const ActiveSet::Outcome outcome = active_set_->solve(programme);
    Answer answer;
    answer.iterations = active_set_->steps();
    answer.released = active_set_->releasedCount();
    start_.clear();
    if (outcome == ActiveSet::Outcome::solved) {
      answer.kkt = active_set_->residual(programme);
      start_.push_back(programme.rows);
      start_.push_back(programme.variables);
      for (int i = 0; i < activeCount(); ++i)
        if (programme.lower[active(i)] != programme.upper[active(i)])
          start_.push_back(active_set_->side(i) * (active(i) + 1));
      x.head(programme.variables) = active_set_->x().head(programme.variables);
    } else if (outcome == ActiveSet::Outcome::infeasible) {
      answer.verdict = Verdict::infeasible;
    } else if (active_set_->late()) {
      answer.verdict = Verdict::late;
    } else {
      answer.kkt = {1, 1, 1};
      answer.status = "its bounded number of steps did not suffice";
    }
    return answer;
  }

  int activeCount() const override { return active_set_->activeCount(); }
  int active(int i) const override { return active_set_->active(i); }
  control::WarmStart warmStart() const override { return start_; }
  void setWarmStart(const control::WarmStart& start) override {
    const auto fits = [](int number) { return number != 0 && number != std::numeric_limits<int>::min(); };
    if (start.size() <= start_.capacity() && std::all_of(start.begin(), start.end(), fits)) start_ = start;
  }

 private:
  std::unique_ptr<ActiveSet> active_set_;
  control::WarmStart start_;                                       // rows, variables, then side · (row + 1)
};

}  // namespace

std::unique_ptr<ProgrammeSolver> makeActiveSetSolver() { return std::make_unique<ActiveSetSolver>(); }

}  // namespace tactus::qp
