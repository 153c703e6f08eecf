#pragma once

#include "framework/control/constrained_least_squares.h"
#include "framework/control/priority_factor.h"
#include "plugins/qp/qp_solver.h"

namespace tactus::qp {

/// Change of variables x = x₀ + T v that turns a constrained least-squares programme into a least-distance one:
/// equality rows are eliminated by a rank-revealing basis of what they leave, the objective becomes ½‖v‖² by the QR
/// factor of F in that basis (never by FᵀF, whose condition is the square), and v is scaled by the largest violation.
class Reduction {
 public:
  Reduction(int variables, int objective_rows, int equality_rows, int inequality_rows);

  void reduce(const control::ConstrainedLeastSquares& programme);
  const LeastDistanceProgramme& leastDistance() const { return reduced_; }
  /// Some row cannot be met whatever v is.
  bool contradictory() const { return contradictory_; }
  void restore(const Eigen::VectorXd& v, Eigen::VectorXd& x);

 private:
  control::PriorityFactor factor_;
  control::RowMajorMatrix equalities_;
  control::RowMajorMatrix objective_;
  control::RowMajorMatrix rows_;
  Eigen::MatrixXd triangle_;                                       // R of F Z = Q R
  Eigen::VectorXd optimum_;                                        // x₀ in the coordinates that keep the equality rows
  double scale_ = 1;
  int free_ = 0;
  bool contradictory_ = false;
  LeastDistanceProgramme reduced_;
};

}  // namespace tactus::qp
