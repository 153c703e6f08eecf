#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "framework/control/registry.h"
#include "framework/control/whitened_problem.h"

namespace tactus::tasks {

/// The measure `broken-rows`: how often, and how hard, lower levels press on rows of inequality tasks, which they must
/// not (thesis 4.2.9).
///
/// A tick whose level i has inequality rows J_i is solved again without the levels below it, by a back end like the
/// controller's.  With τ the answer of the tick and τ_i that one, both without b + g and before they are scaled
/// into limits,
///
///   δ = J_i M⁻¹ (τ − τ_i);  a row is broken where δ > 1e-6 ‖J_i‖ (‖τ‖ + ‖τ_i‖), norms in the M⁻¹ metric,
///
/// by the force δ / (J_i M⁻¹ J_iᵀ) that lower levels put along it: N, or N m of a joint's row.  Figures, `<name>_…`:
///
/// | figure      | definition                                                                                       |
/// |-------------|--------------------------------------------------------------------------------------------------|
/// | share       | of the ticks with a row to judge, those with a broken one                                        |
/// | TASK_share  | of the rows of an inequality task, over all ticks, those that are broken                         |
/// | TASK_mean   | mean force of those that are                                                                     |
/// | TASK_max    | greatest                                                                                         |
///
/// A task that had no row to judge has none of its figures (NaN); one without a broken row has mean and max 0.  Columns:
/// `rows`, how many are broken now, and `TASK`, the greatest force.  Ticks that fell back are not judged.
class BrokenRows final : public control::Measure {
 public:
  explicit BrokenRows(const control::MeasureContext& context);
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;
  void metrics(std::vector<control::Metric>& metrics) const override;

 private:
  /// Of an inequality task.
  struct Figures {
    std::string task;
    double now = 0;                                                ///< N or N m, greatest of this tick
    long rows = 0, broken = 0;                                     ///< over all ticks
    double force_sum = 0, force_max = 0;                           ///< N or N m, of the broken ones
    void archive(control::Archive& archive);
  };

  void doObserve(const control::ObservedTick& tick) override;
  void doArchive(control::Archive& archive) override;
  void judge(const control::TickProblem& problem, int level);
  Figures& figuresOf(const std::string& task);
  /// L⁻¹ τ before scaling; false where there is none.
  static bool unscaled(const control::WhitenedProblem& whitened, const control::TickSolution& solution, Eigen::VectorXd& y);

  std::unique_ptr<control::BackEnd> back_end_;
  control::TickProblem above_;                                     // the tick's problem without its lower levels
  control::TickSolution answer_;
  control::WhitenedProblem whitened_;
  Eigen::VectorXd y_, y_above_;                                    // L⁻¹ τ, L⁻¹ τ_i
  std::vector<Figures> tasks_;
  long ticks_ = 0, broken_ticks_ = 0;                              // that had a row to judge
  double rows_now_ = 0;
};

}  // namespace tactus::tasks
