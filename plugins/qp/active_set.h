#pragma once

#include "framework/control/least_distance.h"
#include "framework/control/tick_solution.h"
#include "plugins/qp/programme.h"

namespace tactus::qp {

/// The project's own solver for real time: a dense dual active set, warm-started with the rows that were at their bounds
/// in the last call.
///
/// F and the ridge are brought to a triangle R by Householder reflections (never through FᵀF, whose condition is the
/// square); in u = R x_d, d x_f the programme is a least-distance one.  Takes no memory after construction.
class ActiveSet {
 public:
  ActiveSet(int variables, int dense, int objective_rows, int rows);

  using Outcome = control::LeastDistance::Outcome;
  Outcome solve(const Programme& programme);
  void limit(int steps, control::LeastDistance::TimePoint end) { least_distance_.limit(steps, end); }
  bool late() const { return least_distance_.late(); }

  const Eigen::VectorXd& x() const { return x_; }                  ///< the first `variables` are valid
  int steps() const { return least_distance_.steps(); }
  int releasedCount() const { return least_distance_.releasedCount(); }
  /// Rows at their bounds: index into the programme's rows, and side (+1 upper, −1 lower).
  int activeCount() const { return least_distance_.activeCount(); }
  int active(int i) const { return least_distance_.active(i); }
  int side(int i) const { return least_distance_.side(i); }
  /// Residual of the last answer from the programme as it was given, as in control::KktCheck.
  control::KktResidual residual(const Programme& programme);

  /// The next solve starts from these rows.
  void guess(int row, int side) { least_distance_.guess(row, side); }

 private:
  void triangularise(const Programme& programme);
  void transformRows(const Programme& programme);

  control::LeastDistance least_distance_;
  Eigen::MatrixXd F_;                                              // what is left of F; reflected in place
  Eigen::VectorXd t_;
  control::RowMajorMatrix R_;                                      // upper triangle
  Eigen::VectorXd c_;                                              // u without constraints
  control::RowMajorMatrix rows_;                                   // variables × rows, unit
  Eigen::RowVectorXd scales_;                                      // 1 / length of each row in u
  Eigen::RowVectorXd products_;
  Eigen::VectorXd lower_;
  Eigen::VectorXd upper_;
  Eigen::VectorXd x_;
  Eigen::VectorXd gradient_;
};

}  // namespace tactus::qp
