#pragma once

#include <Eigen/Core>
#include <vector>

#include "framework/control/whitened_problem.h"

namespace tactus::control {

/// When a direction counts as held.  σ are singular values of the rows of one level, each row first divided by its
/// own norm in the M⁻¹ metric and then projected into what the levels above left: dimensionless, and the same
/// whatever unit a row is written in.  σ ≥ fade: held exactly.  σ ≤ rank_tolerance: not held.  Between them a
/// smoothstep, so that the torque is continuous while rows become dependent.
struct RankOptions {
  double rank_tolerance = 1e-8;
  double fade = 1e-6;
};

/// 0 at `rank_tolerance`, 1 at `fade`, 3s² − 2s³ between them.
double fadeWeight(double sigma, const RankOptions& options);

/// A rank-revealing factor of stacked rows, one stage a level, by Householder reflections with column pivoting
/// inside each level (Businger and Golub 1965).  Singular values are computed, by one-sided Jacobi rotations of the
/// small triangular factor (Drmač and Veselić 2008), only when the triangle cannot be shown to be far from the fade.
///
/// Vectors of R^n, torques and rows alike, run through the same chain of stages.  After a stage the leading
/// coordinates are held by it and no longer touched; those that remain are a basis of what is left for the levels
/// below.  Faded directions stay among the remaining ones, scaled by 1 − weight: a lower level's rows can hold the
/// rest, and nothing that is fully held above is ever reached.  Takes no memory after construction.
class PriorityFactor {
 public:
  struct Stage {
    int first = 0;                                                 ///< coordinates held by the stages before
    int held = 0;                                                  ///< directions that this stage holds exactly
    int rank = 0;                                                  ///< directions with σ > rank_tolerance
    bool deficient = false;                                        ///< rows were dependent, or a direction is faded
  };

  /// `column_capacity`: the most columns that any call brings; `dimension` of them are always allowed.
  PriorityFactor(int dimension, int column_capacity, int stage_capacity, RankOptions options);

  void reset() { stage_count_ = 0; }
  /// Appends a stage that holds the rows in `columns` (n × m: unit rows, transposed, already taken through all
  /// stages so far); `columns` is destroyed.
  const Stage& hold(ColumnsRef columns);
  void dropLastStage() { --stage_count_; }

  int stages() const { return stage_count_; }
  int dimension() const { return dimension_; }
  /// Coordinates held by all stages; those from here on are free.
  int held() const;

  /// Takes columns through one stage, or through all of them.
  void advance(int stage, ColumnsRef columns);
  void advance(ColumnsRef columns);
  /// Back to R^n of what is free; the held coordinates are overwritten.
  void embed(ColumnsRef columns);

 private:
  // A stage with its memory: reflections H_i = I − β_i v_i v_iᵀ, v_i zero above coordinate first + i.
  struct Memory {
    Stage stage;
    int reflections = 0;
    bool rotated = false;                                          // singular directions were computed
    Eigen::MatrixXd v;
    Eigen::VectorXd beta;
    RowMajorMatrix rotation;                                       // Uᵀ on the coordinates of the reflections
    Eigen::VectorXd keep;                                          // 1 − weight of these coordinates
  };

  void triangularise(Memory& memory, ColumnsRef columns);
  int pivotColumn(ColumnsRef columns, int row, int from);
  bool clearlyAboveFade(const Memory& memory, const ColumnsRef& columns);
  void rotateToSingularDirections(Memory& memory, const ColumnsRef& columns);
  void reflect(const Memory& memory, int i, ColumnsRef columns);
  void rotate(const Memory& memory, bool transposed, ColumnsRef columns);

  int dimension_;
  RankOptions options_;
  double negligible_;                                              // below this nothing is looked at any more
  int stage_count_ = 0;
  std::vector<Memory> memories_;
  Eigen::VectorXd left_;                                           // squared norm of what is left of each column
  Eigen::VectorXd reference_;                                      // the same when last computed afresh
  Eigen::MatrixXd inverse_;
  RowMajorMatrix triangle_;
  RowMajorMatrix buffer_;
  Eigen::RowVectorXd row_;
};

}  // namespace tactus::control
