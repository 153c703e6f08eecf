#include "plugins/qp/lazy_rows.h"

#include <algorithm>

namespace tactus::qp {
namespace {

constexpr int max_rounds = 20;                                     // 1 to 3 are usual
constexpr double kept = 1e-9;                                      // violation of a row that counts as none

}  // namespace

LazyRows::LazyRows(std::unique_ptr<QpSolver> solver, bool polish)
    : solver_(std::move(solver)), polish_(polish), nearest_(0, 0) {}

void LazyRows::prepare(int variables, int rows) { nearest_ = control::LeastDistance(variables, rows); }

SolverReport LazyRows::solve(const LeastDistanceProgramme& programme, double near, Eigen::VectorXd& v) {
  v.setZero(programme.variables());
  chosen_.clear();
  is_chosen_.assign(programme.count(), false);
  SolverReport report{"no row is violated", 0};
  for (int round = 0; addViolated(programme, v, round == 0 ? 0 : kept); ++round) {
    if (round == max_rounds) {                                     // all of them, then
      for (int j = 0; j < programme.count(); ++j)
        if (!is_chosen_[j]) chosen_.push_back(j);
      is_chosen_.assign(programme.count(), true);
    }
    solveChosen(programme, near, v, report);
    if (!v.allFinite()) break;
  }
  return report;
}

bool LazyRows::addViolated(const LeastDistanceProgramme& programme, const Eigen::VectorXd& v, double tolerance) {
  const std::size_t before = chosen_.size();
  for (int j = 0; j < programme.count(); ++j) {
    if (is_chosen_[j] || programme.rows.col(j).dot(v) <= programme.bounds[j] + tolerance) continue;
    chosen_.push_back(j);
    is_chosen_[j] = true;
  }
  return chosen_.size() > before;
}

void LazyRows::solveChosen(const LeastDistanceProgramme& programme, double near, Eigen::VectorXd& v,
                           SolverReport& report) {
  const int n = programme.variables();
  const int m = static_cast<int>(chosen_.size());
  const int span = std::min(n, m);
  Eigen::MatrixXd columns(n, m);
  small_.bounds.resize(m);
  for (int i = 0; i < m; ++i) {
    columns.col(i) = programme.rows.col(chosen_[i]);
    small_.bounds[i] = programme.bounds[chosen_[i]];
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);         // v = Q [s; 0]
  small_.rows = qr.matrixQR().topRows(span).triangularView<Eigen::Upper>();
  point_.setZero(span);
  const SolverReport round = solver_->solve(small_, point_);
  report.status = round.status;
  report.iterations += round.iterations;
  if (polish_ && point_.allFinite()) polish(near);
  v.setZero(n);
  v.head(span) = point_;
  v.applyOnTheLeft(qr.householderQ());
}

// Rows that the exact point then violates were wrongly left out by the solver's answer, and join.
void LazyRows::polish(double near) {
  const int n = small_.variables();
  is_near_.assign(small_.count(), false);
  near_rows_.resize(n, small_.count());
  near_bounds_.resize(small_.count());
  Eigen::VectorXd exact = point_;
  int count = 0;
  double reach = near;                                             // how far inside its bound a row still joins
  for (int before = -1; count > before;) {
    before = count;
    for (int j = 0; j < small_.count(); ++j) {
      if (is_near_[j] || small_.bounds[j] - small_.rows.col(j).dot(exact) > reach) continue;
      near_rows_.col(count) = small_.rows.col(j);
      near_bounds_[count++] = small_.bounds[j];
      is_near_[j] = true;
    }
    if (count == before) break;
    const auto outcome =
        nearest_.solve(near_rows_.leftCols(count), near_bounds_.head(count), Eigen::VectorXd::Zero(n));
    if (outcome != control::LeastDistance::Outcome::solved) return;
    exact = nearest_.x();
    reach = -kept;
  }
  if (count > 0) point_ = exact;
}

}  // namespace tactus::qp
