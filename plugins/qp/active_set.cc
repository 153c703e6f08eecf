#include "plugins/qp/active_set.h"

#include <algorithm>
#include <cmath>

#include "framework/control/strips.h"

namespace tactus::qp {
namespace {

constexpr double without_digits = 1e-3;                            // change of x, relative, by one more Newton step
constexpr double smallest = 1e-9;                                  // N m or N: a length of x below it counts as this

}  // namespace

ActiveSet::ActiveSet(int variables, int dense, int objective_rows, int rows)
    : least_distance_(variables, rows),
      F_(objective_rows, dense),
      t_(objective_rows),
      R_(dense, dense),
      c_(variables),
      rows_(variables, rows),
      scales_(rows),
      products_(rows),
      lower_(rows),
      upper_(rows),
      x_(variables),
      gradient_(variables) {}

ActiveSet::Outcome ActiveSet::solve(const Programme& programme) {
  const int n = programme.variables;
  const int dense = programme.dense;
  triangularise(programme);
  transformRows(programme);
  const Outcome outcome = least_distance_.solve(rows_.topLeftCorner(n, programme.rows), lower_.head(programme.rows),
                                                upper_.head(programme.rows), c_.head(n));
  x_.head(n) = least_distance_.x();
  for (int i = dense - 1; i >= 0; --i) {
    double sum = x_[i];
    if (programme.objective_rows > 0) sum -= R_.row(i).tail(dense - i - 1).dot(x_.segment(i + 1, dense - i - 1));
    x_[i] = sum / R_(i, i);
  }
  x_.segment(dense, n - dense).array() /= programme.ridge.segment(dense, n - dense).array();
  return outcome;
}

// [diag(d); F] = Q R and c = Qᵀ [d r; t], one reflection a column: it mixes row k of the triangle with the rows of F.
void ActiveSet::triangularise(const Programme& programme) {
  const int n = programme.dense;
  const int m = programme.objective_rows;
  c_.head(programme.variables) =
      programme.ridge.head(programme.variables).cwiseProduct(programme.reference.head(programme.variables));
  R_.setZero();
  R_.diagonal() = programme.ridge.head(n);
  if (m == 0) return;
  F_.topRows(m) = programme.F.topRows(m);
  t_.head(m) = programme.t.head(m);
  for (int k = 0; k < n; ++k) {
    auto v = F_.col(k).head(m);
    const double square = v.squaredNorm();
    if (square == 0) continue;
    const double length = std::sqrt(R_(k, k) * R_(k, k) + square);
    const double head = R_(k, k) + std::copysign(length, R_(k, k));
    const double beta = 1 / (length * std::abs(head));             // H = I − β [head; v] [head; v]ᵀ
    for (int j = k + 1; j < n; ++j) {
      const double s = beta * (head * R_(k, j) + v.dot(F_.col(j).head(m)));
      R_(k, j) -= s * head;
      F_.col(j).head(m) -= s * v;
    }
    const double s = beta * (head * c_[k] + v.dot(t_.head(m)));
    c_[k] -= s * head;
    t_.head(m) -= s * v;
    R_(k, k) = -std::copysign(length, R_(k, k));
  }
}

// a x = a_d R⁻¹ u_d + (a_f / d) u_f, a strip of rows at a time, each then to unit length.
void ActiveSet::transformRows(const Programme& programme) {
  const int n = programme.variables;
  const int m = programme.rows;
  const int coupled = programme.objective_rows > 0 ? programme.dense : 0;
  auto inverses = gradient_.head(n);
  inverses = programme.ridge.head(n).cwiseInverse();
  inverses.head(programme.dense) = R_.diagonal().head(programme.dense).cwiseInverse();
  const Eigen::Index stride = rows_.outerStride();
  control::forEachStrip(m, [&](auto width, int j) {
    using Strip = control::Strip<width()>;
    Strip scale = Strip::Zero();
    double* strip = rows_.data() + j;
    for (int i = 0; i < n; ++i) {
      Strip row = Eigen::Map<const Strip>(&programme.A(i, j));
      for (int k = 0; k < (i < coupled ? i : 0); ++k)
        if (R_(k, i) != 0) row -= R_(k, i) * Eigen::Map<const Strip>(strip + k * stride);
      row *= inverses[i];
      Eigen::Map<Strip>(strip + i * stride) = row;
      scale += row.square();
    }
    scale = (scale > 0).select(scale.sqrt().inverse(), 1.0);
    for (int i = 0; i < n; ++i) Eigen::Map<Strip>(strip + i * stride) *= scale;
    scales_.segment<width()>(j) = scale.transpose();
  });
  const auto scales = scales_.head(m).transpose();
  lower_.head(m) = programme.lower.head(m).cwiseProduct(scales);
  upper_.head(m) = programme.upper.head(m).cwiseProduct(scales);
}

control::KktResidual ActiveSet::residual(const Programme& programme) {
  const int n = programme.variables;
  const int dense = programme.dense;
  const int m = programme.rows;
  const auto x = x_.head(n);
  const auto multipliers = least_distance_.multipliers();
  control::KktResidual residual;
  // Everything is measured in u, where a step's length is what it costs.
  const double size = least_distance_.x().norm() + c_.head(n).norm();
  if (!(size > 0)) return residual;

  // The gradient, and what the multipliers make of it, as the programme was given.
  auto gradient = gradient_.head(n);
  gradient = programme.ridge.head(n).array().square() * (x - programme.reference.head(n)).array();
  if (programme.objective_rows > 0) {
    auto left = t_.head(programme.objective_rows);
    left = -programme.t.head(programme.objective_rows);
    left.noalias() += programme.F.topRows(programme.objective_rows) * x.head(dense);
    gradient.head(dense).noalias() += programme.F.topRows(programme.objective_rows).transpose() * left;
  }
  for (int i = 0; i < least_distance_.activeCount(); ++i) {
    const int j = least_distance_.active(i);
    gradient += multipliers[j] * scales_[j] * programme.row(j);
    if (programme.lower[j] != programme.upper[j] && multipliers[j] * least_distance_.side(i) < 0)
      residual.stationarity = std::max(residual.stationarity, std::abs(multipliers[j]) / size);
  }
  // R⁻ᵀ g is the length of the Newton step in u.
  for (int i = 0; i < n; ++i) {
    if (i < dense && programme.objective_rows > 0)
      for (int k = 0; k < i; ++k) gradient[i] -= R_(k, i) * gradient[k];
    gradient[i] /= i < dense ? R_(i, i) : programme.ridge[i];
  }
  residual.stationarity = std::max(residual.stationarity, gradient.norm() / size);
  // Small there may be large in x, in directions that cost little and are free: then the answer has no digits in them.
  least_distance_.leaveActiveRows(gradient);
  for (int i = n - 1; i >= 0; --i) {
    if (i < dense && programme.objective_rows > 0)
      for (int k = i + 1; k < dense; ++k) gradient[i] -= R_(i, k) * gradient[k];
    gradient[i] /= i < dense ? R_(i, i) : programme.ridge[i];
  }
  const double change = gradient.norm() / std::max(x.norm(), smallest);
  if (change > without_digits) residual.stationarity = std::max(residual.stationarity, change);

  auto products = products_.head(m);
  products.setZero();
  for (int i = 0; i < n; ++i) products += x[i] * programme.A.row(i).head(m);
  for (int j = 0; j < m; ++j) {
    const double outside = std::max(programme.lower[j] - products[j], products[j] - programme.upper[j]) * scales_[j];
    residual.primal = std::max(residual.primal, outside / size);
    if (multipliers[j] != 0)
      residual.complementarity = std::max(residual.complementarity, std::abs(outside) / size);
  }
  return residual;
}

}  // namespace tactus::qp
