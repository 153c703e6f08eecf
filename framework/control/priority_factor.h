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

/// For those who divide by σ, as `consistent` cascades and hierarchical programmes do.
inline constexpr RankOptions dividing_rank{1e-5, 1e-3};

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
  using VectorRef = Eigen::Ref<Eigen::VectorXd, 0, Eigen::InnerStride<>>;

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
  /// stages so far); of `columns`, coordinates held before stay as they are, the others are left in the stage's own and
  /// in its own order.
  const Stage& hold(ColumnsRef columns);
  void dropLastStage() { --stage_count_; }

  // Least squares in the directions of the last stage, right after `hold`; `columns` as it left them.  The directions
  // that it holds are its coordinates z₁; ‖W (columnsᵀ z − b)‖² = ‖S (z₁ − z₁*)‖² + what no z can change, S regular.

  /// z (dimension) minimises ‖W (columnsᵀ z − b)‖ and is 0 outside of the stage; a faded direction gets the share of its
  /// fade.  b and the diagonal of W > 0: one number a column, in the order in which the columns came; W counts by
  /// its proportions, its largest as 1.
  void leastSquares(const ConstColumnsRef& columns, const Eigen::Ref<const Eigen::VectorXd>& b,
                    const Eigen::Ref<const Eigen::VectorXd>& W, VectorRef z);
  /// Rows g z₁ in the stage's coordinates become rows of u₁ = S z₁: g ← S⁻ᵀ g in the held coordinates.
  void toMetric(const ConstColumnsRef& columns, ColumnsRef rows) const;
  /// z₁ = S⁻¹ u₁, in place in the held coordinates.
  void fromMetric(const ConstColumnsRef& columns, VectorRef u) const;

  int stages() const { return stage_count_; }
  const Stage& stage(int i) const { return memories_[i].stage; }
  const Stage& lastStage() const { return stage(stage_count_ - 1); }
  /// Of the columns of the last `hold`, the one that came to place `i`.
  int column(int i) const { return order_[i]; }
  int dimension() const { return dimension_; }
  /// Coordinates held by all stages; those from here on are free.
  int held() const;

  /// Takes columns through one stage, or through all of them.
  void advance(int stage, ColumnsRef columns);
  void advance(ColumnsRef columns);
  /// Back to R^n of what is free; the held coordinates are overwritten.
  void embed(ColumnsRef columns);
  /// The coordinates of one stage alone, an orthogonal change that fades nothing; and back.
  void turn(int stage, ColumnsRef columns);
  void turnBack(int stage, ColumnsRef columns);
  /// What `advance` does to columns after `turn`.
  void fade(int stage, ColumnsRef columns) { fadeDirections(memories_[stage], columns); }
  /// Back through one stage, with faded directions scaled as `advance` scales them: rows that were advanced and
  /// coordinates that are brought back so belong together.
  void bringBack(int stage, ColumnsRef columns);

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
  void fadeDirections(const Memory& memory, ColumnsRef columns);
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
  // Of the last stage, for least squares.
  Eigen::VectorXi order_;                                          // which column came where
  Eigen::VectorXd sigma_;                                          // falling, where singular directions were computed
  Eigen::MatrixXd tall_;                                           // QR where rows are dependent: its triangle T
  Eigen::VectorXd target_;
  Eigen::VectorXd row_weights_;
};

}  // namespace tactus::control
