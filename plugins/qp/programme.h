#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/control/constrained_least_squares.h"
#include "framework/control/whitened_problem.h"

namespace tactus::qp {

/// The weighted programme of a tick in the form that keeps its structure:
///
///   min ½‖F x_d − t‖² + ½ Σ_k d_k² (x_k − r_k)²  subject to  l ≤ A x ≤ u,
///
/// x_d the first `dense` variables, which stand for task torques; the others are contact forces, which only their
/// ridge d and the constraints know.  Rows with l = u are equalities.  Sized once.
struct Programme {
  int variables = 0;
  int dense = 0;
  int objective_rows = 0;
  int rows = 0;
  Eigen::MatrixXd F;                                               ///< objective rows × dense
  Eigen::VectorXd t;
  Eigen::VectorXd ridge;                                           ///< d ≥ 0, > 0 where F alone would leave x free
  Eigen::VectorXd reference;                                       ///< r
  control::RowMajorMatrix A;                                       ///< variables × rows: column j is row j
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;

  auto row(int j) { return A.col(j).head(variables); }
  auto row(int j) const { return A.col(j).head(variables); }
};

/// Whether the squares that every solver takes stay finite.
bool isUsable(const Programme& programme);

/// The same programme in the plain form, for solvers and checks that know no structure.  `origins` gets, for each of
/// its inequality rows, the row of `programme` that it came from.  Takes memory.
void expand(const Programme& programme, control::ConstrainedLeastSquares& plain, std::vector<int>& origins);

}  // namespace tactus::qp
