#pragma once

#include <Eigen/Core>

namespace tactus::control {

/// min ½‖F x − t‖² subject to E x = 0 and G x ≤ h: what weighted and hierarchical back ends come down to.  Rows of E
/// and G have unit length or are zero.  Storage is sized once; each count says how many rows are valid.
struct ConstrainedLeastSquares {
  int variables = 0;
  int objective_rows = 0;
  int equality_rows = 0;
  int inequality_rows = 0;
  Eigen::MatrixXd F;
  Eigen::VectorXd t;
  Eigen::MatrixXd E;
  Eigen::MatrixXd G;
  Eigen::VectorXd h;

  auto objective() const { return F.topLeftCorner(objective_rows, variables); }
  auto target() const { return t.head(objective_rows); }
  auto equalities() const { return E.topLeftCorner(equality_rows, variables); }
  auto inequalities() const { return G.topLeftCorner(inequality_rows, variables); }
  auto bounds() const { return h.head(inequality_rows); }
};

}  // namespace tactus::control
