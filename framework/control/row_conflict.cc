#include "framework/control/row_conflict.h"

#include <algorithm>
#include <numeric>

#include "framework/control/least_distance.h"

namespace tactus::control {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// ‖s‖² + ‖x − x₀‖²/κ² with x₀ the x before: the second term, which makes the point unique, fades with the steps.
constexpr double kappa = 1e3;
constexpr int proximal_steps = 4;

struct Stacked {
  RowMajorMatrix rows;                                             // unit columns
  VectorXd bounds;
  bool contradictory = false;                                      // a row without effect asks for the impossible
};

Stacked stack(const std::vector<const RowGroup*>& groups) {
  Eigen::Index count = 0, variables = 0;
  for (const RowGroup* group : groups) {
    count += group->rows.rows();
    variables = std::max(variables, group->rows.cols());
  }
  Stacked all{RowMajorMatrix(variables, count), VectorXd(count), false};
  Eigen::Index next = 0;
  for (const RowGroup* group : groups)
    for (Eigen::Index r = 0; r < group->rows.rows(); ++r) {
      const double norm = group->rows.row(r).norm();
      if (norm == 0) {
        all.contradictory |= group->bounds[r] < 0;
        continue;
      }
      all.rows.col(next) = group->rows.row(r).transpose() / norm;
      all.bounds[next++] = group->bounds[r] / norm;
    }
  all.rows.conservativeResize(Eigen::NoChange, next);
  all.bounds.conservativeResize(next);
  return all;
}

bool contradict(const std::vector<const RowGroup*>& groups) {
  const Stacked all = stack(groups);
  if (all.contradictory) return true;
  const int variables = static_cast<int>(all.rows.rows()), count = static_cast<int>(all.rows.cols());
  if (count == 0) return false;
  LeastDistance nearest(variables, count);
  return nearest.solve(all.rows, all.bounds, VectorXd::Zero(variables)) == LeastDistance::Outcome::infeasible;
}

std::vector<const RowGroup*> pointers(const std::vector<RowGroup>& groups, const std::vector<int>& indices) {
  std::vector<const RowGroup*> chosen;
  for (const int i : indices) chosen.push_back(&groups[static_cast<std::size_t>(i)]);
  return chosen;
}

/// `kept` contradict each other; leaves out, in the order of `candidates`, whatever can be spared.
std::vector<int> deleted(const std::vector<RowGroup>& groups, std::vector<int> kept,
                         const std::vector<int>& candidates) {
  for (const int candidate : candidates) {
    std::vector<int> without = kept;
    std::erase(without, candidate);
    if (contradict(pointers(groups, without))) kept = without;
  }
  return kept;
}

}  // namespace

bool isFeasible(const std::vector<RowGroup>& groups) {
  std::vector<int> all(groups.size());
  std::iota(all.begin(), all.end(), 0);
  return !contradict(pointers(groups, all));
}

std::vector<int> smallestConflict(const std::vector<RowGroup>& groups) {
  std::vector<int> all(groups.size());
  std::iota(all.begin(), all.end(), 0);
  if (!contradict(pointers(groups, all))) return {};
  const std::vector<int> backwards(all.rbegin(), all.rend());
  const std::vector<int> late = deleted(groups, all, all), early = deleted(groups, all, backwards);
  return early.size() <= late.size() ? early : late;
}

std::optional<VectorXd> leastSlack(const std::vector<RowGroup>& groups, int relaxed) {
  const RowGroup& soft = groups[static_cast<std::size_t>(relaxed)];
  const Eigen::Index slacks = soft.rows.rows();
  Eigen::Index variables = 0;
  for (const RowGroup& group : groups) variables = std::max(variables, group.rows.cols());
  // In z = (x/κ, s): κ rows (x/κ) − s ≤ bounds.
  std::vector<RowGroup> widened = groups;
  for (RowGroup& group : widened) {
    MatrixXd rows = MatrixXd::Zero(group.rows.rows(), variables + slacks);
    rows.leftCols(group.rows.cols()) = kappa * group.rows;
    group.rows = rows;
  }
  widened[static_cast<std::size_t>(relaxed)].rows.rightCols(slacks) = -MatrixXd::Identity(slacks, slacks);
  std::vector<const RowGroup*> all;
  for (const RowGroup& group : widened) all.push_back(&group);
  const Stacked rows = stack(all);
  if (rows.contradictory) return std::nullopt;
  LeastDistance nearest(static_cast<int>(variables + slacks), static_cast<int>(rows.rows.cols()));
  VectorXd z = VectorXd::Zero(variables + slacks);
  for (int step = 0; step < proximal_steps; ++step) {
    z.tail(slacks).setZero();
    if (nearest.solve(rows.rows, rows.bounds, z) != LeastDistance::Outcome::solved) return std::nullopt;
    z = nearest.x();
  }
  return z.tail(slacks).cwiseMax(0.0);
}

}  // namespace tactus::control
