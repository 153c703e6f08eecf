#pragma once

#include <Eigen/Core>

#include "framework/control/least_distance.h"
#include "framework/control/priority_factor.h"

namespace tactus::null_space {

enum class Inequalities {
  one_pass,                                                        ///< Algorithm 3
  exact                                                            ///< nearest torque in the M⁻¹ metric
};

/// Projection of a torque onto equality and inequality rows, in whitened coordinates, where the M⁻¹ metric is the
/// Euclidean one.  Counts what it did, row by row.
class Projection {
 public:
  struct Counts {
    int held = 0;                                                  ///< inequality rows held at their bound
    int released = 0;                                              ///< held on the way and let go again
    int steps = 0;                                                 ///< of the search for the rows to hold
    bool failed = false;                                           ///< the bounded number of steps did not suffice
    bool late = false;                                             ///< because the deadline came first
  };

  Projection(int dof, int row_capacity, Inequalities inequalities, control::RankOptions options, bool release);

  /// `factor` holds the equality rows.  `inequalities`: the rows of I, taken through its stages; `original`: the same
  /// rows before that.  `torque` (dof × 1, whitened, not taken through the stages) becomes the projected one.
  void apply(control::PriorityFactor& factor, const control::ConstColumnsRef& inequalities,
             const control::ConstColumnsRef& original, control::ColumnsRef torque);

  /// What is left of a tick's deadline for the next call.
  void limit(int steps, control::LeastDistance::TimePoint end) { least_distance_.limit(steps, end); }
  const Counts& counts() const { return counts_; }
  /// Column indices of the inequality rows held by the last projection, counts().held of them.
  int heldRow(int i) const { return held_rows_[i]; }

 private:
  void holdViolated(control::PriorityFactor& factor, const control::ConstColumnsRef& inequalities,
                    const control::ConstColumnsRef& original, control::ColumnsRef torque);
  void nearest(control::PriorityFactor& factor, const control::ConstColumnsRef& inequalities,
               control::ColumnsRef torque);

  Inequalities mode_;
  control::RankOptions options_;
  bool release_;
  Counts counts_;
  control::LeastDistance least_distance_;
  Eigen::VectorXi held_rows_;
  Eigen::VectorXi candidates_;                                     // rows that are not held by equalities already
  control::RowMajorMatrix rows_;
  Eigen::VectorXd bounds_;
  Eigen::VectorXd point_;
};

}  // namespace tactus::null_space
