#include "plugins/qp/reduction.h"

#include <Eigen/QR>
#include <algorithm>

namespace tactus::qp {
namespace {

constexpr control::RankOptions equality_rank{1e-9, 1e-9};
constexpr double empty_row = 1e-9;                                 // part of a unit row that the equalities leave
constexpr double contradiction = 1e-9;                             // violation of such a row, absolute over its size
constexpr double least_scale = 1e-3;                               // of v, relative to the optimum without rows

}  // namespace

Reduction::Reduction(int variables, int objective_rows, int equality_rows, int inequality_rows)
    : factor_(variables, std::max(equality_rows, 1), 1, equality_rank),
      objective_(variables, objective_rows),
      rows_(variables, inequality_rows) {}

void Reduction::reduce(const control::ConstrainedLeastSquares& programme) {
  const int n = programme.variables;
  factor_ = control::PriorityFactor(
      n, std::max({1, programme.equality_rows, programme.objective_rows, programme.inequality_rows}), 1, equality_rank);
  equalities_ = programme.equalities().transpose();
  factor_.hold(equalities_);
  free_ = n - factor_.held();

  objective_ = programme.objective().transpose();
  factor_.advance(0, objective_);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(objective_.bottomRows(free_).transpose());
  triangle_ = qr.matrixQR().topRows(free_).triangularView<Eigen::Upper>();
  Eigen::VectorXd target = programme.target();
  target.applyOnTheLeft(qr.householderQ().adjoint());
  const Eigen::VectorXd centre = target.head(free_);               // R x₀
  optimum_ = triangle_.triangularView<Eigen::Upper>().solve(centre);

  rows_ = programme.inequalities().transpose();
  factor_.advance(0, rows_);
  contradictory_ = false;
  const int count = programme.inequality_rows;
  reduced_.rows.resize(free_, count);
  reduced_.bounds.resize(count);
  int kept = 0;
  double violation = 0;
  for (int j = 0; j < count; ++j) {
    const auto row = rows_.col(j).tail(free_);
    if (row.norm() <= empty_row) {
      contradictory_ |= programme.h[j] < -contradiction * std::max(1.0, programme.h.head(count).cwiseAbs().maxCoeff());
      continue;
    }
    reduced_.rows.col(kept) = row;
    reduced_.bounds[kept++] = programme.h[j] - row.dot(optimum_);
  }
  reduced_.rows.conservativeResize(free_, kept);
  reduced_.bounds.conservativeResize(kept);
  if (kept > 0) triangle_.transpose().triangularView<Eigen::Lower>().solveInPlace(reduced_.rows);
  for (int j = 0; j < kept; ++j) {
    const double norm = reduced_.rows.col(j).norm();
    reduced_.rows.col(j) /= norm;
    reduced_.bounds[j] /= norm;
    violation = std::max(violation, -reduced_.bounds[j]);
  }
  scale_ = std::max(violation, least_scale * centre.norm());
  if (scale_ == 0) scale_ = 1;
  reduced_.bounds /= scale_;
}

void Reduction::restore(const Eigen::VectorXd& v, Eigen::VectorXd& x) {
  control::RowMajorMatrix column(factor_.dimension(), 1);
  column.bottomRows(free_) = optimum_ + scale_ * triangle_.triangularView<Eigen::Upper>().solve(v);
  factor_.embed(column);
  x = column.col(0);
}

}  // namespace tactus::qp
