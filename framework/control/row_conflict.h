#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace tactus::control {

/// Rows of B x ≤ d that stand or fall together.  An equality is two opposed rows.
struct RowGroup {
  Eigen::MatrixXd rows;                                            ///< m × n, in the unit in which slack shall be told
  Eigen::VectorXd bounds;                                          ///< m
};

/// Is there an x that meets all groups?  Judged by LeastDistance.
bool isFeasible(const std::vector<RowGroup>& groups);

/// A set of groups that contradict each other, of which none can be spared: indices, rising; empty when all groups
/// can be met together.  By deletion (Chinneck and Dravnieks 1991): each group in turn is left out, for good where the
/// rest still contradict each other.  The smaller one of the sets that deletion from the front and from the back find.
std::vector<int> smallestConflict(const std::vector<RowGroup>& groups);

/// The least slack s ≥ 0, in the sense of ‖s‖², that makes rows x ≤ bounds + s of one group compatible with all others;
/// none when the others contradict each other.
std::optional<Eigen::VectorXd> leastSlack(const std::vector<RowGroup>& groups, int relaxed);

}  // namespace tactus::control
