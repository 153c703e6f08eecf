#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "framework/control/objective_options.h"
#include "framework/control/tick_problem.h"
#include "framework/control/tick_solution.h"

namespace tactus::control {

/// n × m with contiguous rows: column j is the j-th row vector of a problem, transposed.
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ColumnsRef = Eigen::Ref<RowMajorMatrix, 0, Eigen::OuterStride<>>;
using ConstColumnsRef = Eigen::Ref<const RowMajorMatrix, 0, Eigen::OuterStride<>>;

/// A tick problem in whitened coordinates: M = L Lᵀ, y = L⁻¹ τ, A = J L⁻ᵀ.  Then J M⁻¹ τ = A y, and the M⁻¹ metric
/// of torques is the Euclidean one of y.  Rows are kept as unit columns of Aᵀ with their norms apart, so that rows
/// whose units differ by 1e6 weigh the same in every rank decision.  Takes no memory after construction.
class WhitenedProblem {
 public:
  explicit WhitenedProblem(const TickProblem& shape, const ObjectiveOptions& objective = {});

  /// False when the mass matrix is not positive definite or a row or force is not finite.
  bool update(const TickProblem& problem);

  int dof() const { return dof_; }
  int levelCount() const { return static_cast<int>(levels_.size()); }
  /// M = L Lᵀ; the strictly upper part is not meant to be read.
  const Eigen::MatrixXd& massFactor() const { return cholesky_.matrixLLT(); }

  int equalityRows(int level) const { return levels_[level].equalities; }
  /// Inequality rows of all levels above `level` (of `levelCount()`: all); they come first in `inequalities()`.
  int inequalityRowsAbove(int level) const;

  /// Unit columns, dof × rows.  A row without effect (J = 0) is a zero column.
  auto equalities(int level) const {
    return columns_.middleCols(levels_[level].first_equality, levels_[level].equalities);
  }
  auto inequalities() const { return columns_.middleCols(first_inequality_, inequality_count_); }
  /// All rows: equality rows level by level, then inequality rows level by level.
  int rowCount() const { return count_; }
  int firstInequality() const { return first_inequality_; }
  auto row(int j) const { return columns_.col(j); }                ///< unit, dof
  double norm(int j) const { return norms_[j]; }                   ///< M⁻¹ norm of row j before it became unit
  const ActiveRow& origin(int j) const { return origins_[j]; }     ///< where row j stands in the problem

  /// y°_i = L⁻¹ Σ JᵀF over the level's tasks.
  auto ownTorque(int level) const { return own_torques_.col(level); }
  /// τ = L y.
  void toTorque(const Eigen::VectorXd& y, Eigen::VectorXd& torque) const;

  /// ‖J M⁻¹ τ − a‖ of every level for τ = L y, into the solution.  J stacks a level's equality rows and its inequality
  /// rows with F ≠ 0; a = J M⁻¹ τ°, or the acceleration that a task asks for.
  void reportResiduals(const TickProblem& problem, const Eigen::VectorXd& y, TickSolution& solution);
  /// What level i asks for, J_i y = a_i in unit rows, with J_i and a_i as above: writes the rows to `columns` (dof ×
  /// capacity), a_i − J_i y to `b` and to `weights` what the metric weighs their errors by: in `identity` the rows' norms,
  /// which bring both back to the level's own units; returns their number.  The level's equality rows come first; where the
  /// objective is damped, y = 0 comes last, a row for each of the dof.  With balanced contacts y and a_i are without their
  /// torque.  All three hold at least row capacity + dof rows.
  int gatherObjective(const TickProblem& problem, int level, const Eigen::VectorXd& y, RowMajorMatrix& columns,
                      Eigen::VectorXd& b, Eigen::VectorXd& weights);
  /// `b` alone.
  void objectiveLeft(const TickProblem& problem, int level, const Eigen::VectorXd& y, Eigen::VectorXd& b);

 private:
  struct LevelRows {
    int first_equality = 0;
    int equalities = 0;
    int first_inequality = 0;
    int inequalities = 0;
  };
  void gather(const TickProblem& problem);
  void whiten();
  bool damps(int level) const { return objective_.damping > 0 && level > 0; }
  bool balanced() const { return objective_.contacts == ContactForces::balanced; }
  template <typename F>
  void forEachObjective(const TickProblem& problem, int level, const Eigen::VectorXd& y, bool balanced, const F& f);

  ObjectiveOptions objective_;
  int dof_;
  int count_ = 0;                                                  // rows of this tick
  int first_inequality_ = 0;
  int inequality_count_ = 0;
  std::vector<LevelRows> levels_;
  std::vector<ActiveRow> origins_;
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
  RowMajorMatrix columns_;                                         // dof × row capacity, and room for a strip
  Eigen::VectorXd norms_;
  Eigen::VectorXd forces_;
  std::vector<char> bears_;                                        // rows of contacts with F > 0
  Eigen::MatrixXd own_torques_;                                    // dof × levels
  Eigen::RowVectorXd products_;
  Eigen::MatrixXd borne_torques_;                                  // of contacts with F > 0 above level i, dof × (levels + 1)
  Eigen::VectorXd from_own_;
};

}  // namespace tactus::control
