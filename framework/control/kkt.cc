#include "framework/control/kkt.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::control {
namespace {

// Equality rows whose dependence is decided here only have to agree with what any solver could keep.
constexpr RankOptions equality_rank{1e-9, 1e-9};

}  // namespace

KktCheck::KktCheck(int variable_capacity, int equality_capacity, int inequality_capacity)
    : factor_(variable_capacity, std::max(equality_capacity, inequality_capacity), 1, equality_rank),
      least_distance_(variable_capacity, inequality_capacity),
      equalities_(variable_capacity, equality_capacity),
      rows_(variable_capacity, inequality_capacity),
      vectors_(variable_capacity, 2),
      slack_(inequality_capacity),
      zero_(Eigen::VectorXd::Zero(inequality_capacity)),
      near_(inequality_capacity),
      active_rows_(inequality_capacity) {}

KktResidual KktCheck::residual(const ConstrainedLeastSquares& programme, const Eigen::Ref<const Eigen::VectorXd>& x) {
  active_count_ = 0;
  KktResidual residual;
  constexpr double worst = std::numeric_limits<double>::infinity();
  if (!x.allFinite()) return {worst, worst, worst};
  const int n = programme.variables;

  // Coordinates in which E x = 0 holds by construction.
  factor_ = PriorityFactor(
      n, std::max({2, programme.equality_rows, programme.objective_rows, programme.inequality_rows}), 1, equality_rank);
  equalities_ = programme.equalities().transpose();
  factor_.hold(equalities_);
  const int free = n - factor_.held();
  const auto reduce = [&](RowMajorMatrix& columns) { factor_.advance(0, columns); };

  objective_ = programme.objective().transpose();
  reduce(objective_);
  const auto B = objective_.bottomRows(free);
  const Eigen::LLT<Eigen::MatrixXd> hessian(B * B.transpose());
  vectors_.resize(n, 2);
  vectors_.col(0) = programme.objective().transpose() * (programme.objective() * x - programme.target());
  vectors_.col(1) = programme.objective().transpose() * programme.target();
  reduce(vectors_);
  const auto L = hessian.matrixL();
  const Eigen::VectorXd gradient = L.solve(vectors_.col(0).tail(free));
  const double size = x.norm() + hessian.solve(vectors_.col(1).tail(free)).norm();
  if (hessian.info() != Eigen::Success) return {worst, worst, worst};
  if (size == 0) return residual;

  slack_ = programme.bounds() - programme.inequalities() * x;
  if (programme.equality_rows > 0)
    residual.primal = (programme.equalities() * x).cwiseAbs().maxCoeff() / size;
  int near = 0;
  for (int j = 0; j < programme.inequality_rows; ++j) {
    residual.primal = std::max(residual.primal, -slack_[j] / size);
    if (slack_[j] <= active_tolerance * size) near_[near++] = j;
  }
  rows_.resize(n, near);
  for (int i = 0; i < near; ++i) rows_.col(i) = programme.G.row(near_[i]).head(n).transpose();
  reduce(rows_);
  RowMajorMatrix scaled = rows_.bottomRows(free);
  if (near > 0) L.solveInPlace(scaled);
  for (int i = 0; i < near; ++i) {
    const double norm = scaled.col(i).norm();
    if (norm > 0) scaled.col(i) /= norm;
  }
  if (!std::isfinite(gradient.squaredNorm()) || !scaled.allFinite()) return {worst, worst, worst};
  // −gradient less a nonnegative combination of rows: what is left is the nearest point of the rows' polar cone.
  const LeastDistance::Outcome outcome = least_distance_.solve(scaled, zero_.head(near), -gradient);
  const Eigen::VectorXd left = least_distance_.x();
  residual.stationarity = outcome == LeastDistance::Outcome::solved
                              ? hessian.matrixU().solve(left).norm() / size
                              : worst;
  for (int i = 0; i < near; ++i)
    if (least_distance_.multipliers()[i] > 0) {
      active_rows_[active_count_++] = near_[i];
      residual.complementarity = std::max(residual.complementarity, std::abs(slack_[near_[i]]) / size);
    }
  return residual;
}

}  // namespace tactus::control
