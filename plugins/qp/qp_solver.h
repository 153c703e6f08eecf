#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "framework/control/whitened_problem.h"

namespace tactus::qp {

/// min ½‖v‖² subject to rowsᵀ v ≤ bounds.  Every strictly convex quadratic programme comes down to this by a change of
/// variables; the largest violation at v = 0 is of order 1, so that a solver's absolute tolerances mean something.
struct LeastDistanceProgramme {
  control::RowMajorMatrix rows;                                    ///< variables × rows, unit columns
  Eigen::VectorXd bounds;
  int variables() const { return static_cast<int>(rows.rows()); }
  int count() const { return static_cast<int>(rows.cols()); }
};

/// What a solver says of itself.  Nothing rests on it: the answer is judged by its KKT residual.
struct SolverReport {
  std::string status;
  int iterations = 0;
};

class QpSolver {
 public:
  virtual ~QpSolver() = default;
  /// Writes its best point to v (sized by the caller, 0 at first); throws nothing.
  SolverReport solve(const LeastDistanceProgramme& programme, Eigen::VectorXd& v) { return doSolve(programme, v); }

 private:
  virtual SolverReport doSolve(const LeastDistanceProgramme& programme, Eigen::VectorXd& v) = 0;
};

/// `tolerance` as Ipopt's tol, of a programme of order 1.  The default suits polishing; without it the weak directions
/// of a torque magnify what is left by up to 1e7.
std::unique_ptr<QpSolver> makeIpoptSolver(double tolerance = 1e-6);
std::unique_ptr<QpSolver> makeNloptSolver();

}  // namespace tactus::qp
