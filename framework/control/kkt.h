#pragma once

#include "framework/control/constrained_least_squares.h"
#include "framework/control/least_distance.h"
#include "framework/control/priority_factor.h"
#include "framework/control/tick_solution.h"

namespace tactus::control {

/// Karush–Kuhn–Tucker residual of a point, from the programme and the point alone: no solver's word is taken.
///
/// Multipliers are found here, by nonnegative least squares over the rows within `active_tolerance` of their bound.
/// All figures are relative to S = ‖x‖ + ‖x₀‖, with x₀ the optimum without inequality rows:
///   stationarity     length of the Newton step that would remove what is left of the gradient, over S; so it says
///                    how far x is from the optimum of these active rows, low weights included;
///   primal           largest violation of a (unit) row, over S;
///   complementarity  largest distance from its bound of a row with a multiplier above 0, over S.
class KktCheck {
 public:
  KktCheck(int variable_capacity, int equality_capacity, int inequality_capacity);

  KktResidual residual(const ConstrainedLeastSquares& programme, const Eigen::Ref<const Eigen::VectorXd>& x);
  /// Rows with a multiplier above 0 at the last point.
  int activeCount() const { return active_count_; }
  int active(int i) const { return active_rows_[i]; }

  static constexpr double active_tolerance = 1e-6;                 ///< relative to S

 private:
  PriorityFactor factor_;
  LeastDistance least_distance_;
  RowMajorMatrix equalities_;                                      // n × m
  RowMajorMatrix objective_;                                       // Fᵀ in coordinates that keep the equality rows
  RowMajorMatrix rows_;                                            // near-active rows in these coordinates
  RowMajorMatrix vectors_;                                         // gradient and target
  Eigen::VectorXd slack_;
  Eigen::VectorXd zero_;
  Eigen::VectorXi near_;
  Eigen::VectorXi active_rows_;
  int active_count_ = 0;
};

}  // namespace tactus::control
