#pragma once

#include <Eigen/QR>
#include <vector>

#include "framework/control/least_distance.h"
#include "plugins/qp/qp_solver.h"

namespace tactus::qp {

/// Hands a solver only the rows that matter.  It starts with the rows violated at v = 0; while its answer violates
/// others, they are added.  An answer to some rows that keeps all of them is the answer to all of them.  The optimum
/// lies in the span of the rows at their bounds, so the solver works in coordinates of that span.  Of the 90 rows of a
/// tick, mostly limits, some 15 remain.
///
/// With `polish` the solver says which rows may be at their bounds, those that its answer leaves within a tolerance;
/// over these the nearest point is then computed exactly, as OSQP polishes (Stellato et al. 2020).
class LazyRows {
 public:
  LazyRows(std::unique_ptr<QpSolver> solver, bool polish);

  void prepare(int variables, int rows);
  /// `near`: how close to its bound, relative to the largest violation at v = 0, a row may be at its bound.
  SolverReport solve(const LeastDistanceProgramme& programme, double near, Eigen::VectorXd& v);
  bool polishes() const { return polish_; }

 private:
  bool addViolated(const LeastDistanceProgramme& programme, const Eigen::VectorXd& v, double tolerance);
  void solveChosen(const LeastDistanceProgramme& programme, double near, Eigen::VectorXd& v, SolverReport& report);
  void polish(double near);

  std::unique_ptr<QpSolver> solver_;
  bool polish_;
  control::LeastDistance nearest_;
  std::vector<int> chosen_;
  std::vector<bool> is_chosen_;
  LeastDistanceProgramme small_;
  std::vector<bool> is_near_;
  Eigen::VectorXd point_;
  control::RowMajorMatrix near_rows_;
  Eigen::VectorXd near_bounds_;
};

}  // namespace tactus::qp
