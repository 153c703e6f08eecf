#include "plugins/null-space/projection.h"

#include <algorithm>
#include <cmath>

namespace tactus::null_space {
namespace {

// Relative to ‖row‖‖torque‖; a row that the torque presses on by less is not violated but rounded.
constexpr double press_tolerance = 1e-12;

}  // namespace

using control::ColumnsRef;
using control::ConstColumnsRef;
using control::PriorityFactor;

Projection::Projection(int dof, int row_capacity, Inequalities inequalities, control::RankOptions options,
                       bool release)
    : mode_(inequalities),
      options_(options),
      release_(release),
      least_distance_(dof, row_capacity),
      held_rows_(row_capacity),
      candidates_(row_capacity),
      rows_(dof, row_capacity),
      bounds_(row_capacity),
      point_(dof) {}

void Projection::apply(PriorityFactor& factor, const ConstColumnsRef& inequalities, const ConstColumnsRef& original,
                       ColumnsRef torque) {
  counts_ = {};
  if (mode_ == Inequalities::one_pass)
    holdViolated(factor, inequalities, original, torque);
  else
    nearest(factor, inequalities, torque);
}

// Algorithm 3: the rows that the torque itself, before any projection, presses on count as equalities.
void Projection::holdViolated(PriorityFactor& factor, const ConstColumnsRef& inequalities,
                              const ConstColumnsRef& original, ColumnsRef torque) {
  const double tolerance = press_tolerance * torque.norm();
  for (int j = 0; j < original.cols(); ++j)
    if (original.col(j).dot(torque.col(0)) > tolerance) {
      rows_.col(counts_.held) = inequalities.col(j);
      held_rows_[counts_.held++] = j;
    }
  factor.hold(rows_.leftCols(counts_.held));
  factor.advance(torque);
  factor.embed(torque);
  factor.dropLastStage();
}

// argmin ‖t' − t‖² with E t' = 0 and I t' ≤ 0, in the coordinates that the equality rows leave free.
void Projection::nearest(PriorityFactor& factor, const ConstColumnsRef& inequalities, ColumnsRef torque) {
  factor.advance(torque);
  const int first = factor.held();
  const int free = factor.dimension() - first;
  auto t = torque.col(0).tail(free);
  auto point = point_.head(free);
  point = t;
  int count = 0;
  for (int j = 0; j < inequalities.cols(); ++j) {
    const auto row = inequalities.col(j).tail(free);
    // What the equality rows leave of a unit row; a row that they hold already fades out of the inequalities.
    const double norm = row.norm();
    const double weight = control::fadeWeight(norm, options_);
    if (weight == 0) continue;
    rows_.col(count).head(free) = row / norm;
    bounds_[count] = weight == 1 ? 0 : (1 - weight) * std::max(0.0, row.dot(t) / norm);
    candidates_[count++] = j;
  }
  if (count > 0 && !std::isfinite(point.squaredNorm())) {
    counts_.failed = true;
    t.setZero();
  } else if (count > 0) {
    const auto outcome =
        least_distance_.solve(rows_.topLeftCorner(free, count), bounds_.head(count), point, release_);
    counts_.failed = outcome != control::LeastDistance::Outcome::solved;
    counts_.late = least_distance_.late();
    counts_.steps = least_distance_.steps();
    counts_.held = least_distance_.activeCount();
    counts_.released = least_distance_.releasedCount();
    for (int i = 0; i < counts_.held; ++i) held_rows_[i] = candidates_[least_distance_.active(i)];
    // Nothing at all keeps every row, whatever it costs this torque.
    if (counts_.failed)
      t.setZero();
    else
      t = least_distance_.x();
  }
  factor.embed(torque);
}

}  // namespace tactus::null_space
