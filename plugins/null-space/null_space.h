#pragma once

#include <memory>

#include "framework/control/back_end.h"
#include "framework/control/priority_factor.h"
#include "framework/control/whitened_problem.h"
#include "plugins/null-space/projection.h"

namespace tactus::null_space {

enum class Cascade {
  successive,                                                      ///< Algorithm 4: strict for level 1 only
  augmented,                                                       ///< strict for all levels
  consistent                                                       ///< and each level reaches what the others leave it
};

struct NullSpaceOptions {
  Cascade cascade = Cascade::augmented;
  Inequalities inequalities = Inequalities::exact;
  control::RankOptions rank = {};                                  ///< `consistent` divides by σ: give it a larger fade
  control::ObjectiveOptions objective = {};                        ///< of `consistent`
  /// Off, rows once held are never let go: a wrong projection, for the tests that must notice it.
  bool release_rows = true;
};

/// Null-space cascade of task torques (4.2.5–4.2.12, Algorithms 3 and 4).  With τ°_i = Σ JᵀF of level i,
///
///   augmented:   τ = Σ_i P_{<i}(τ°_i), each level projected alone onto the rows of all higher levels;
///   successive:  τ ← τ°_i + P_i(τ), from the lowest level up;
///   consistent:  τ ← τ + P_{<i}(d_i), from the top, d_i = N_{<i} J_iᵀ (J_i M⁻¹ N_{<i} J_iᵀ)⁺ (a_i − J_i M⁻¹ τ), where
///                J_i stacks the level's equality rows and its inequality rows with F ≠ 0 and a_i = J_i M⁻¹ τ°_i, or
///                the acceleration that a task asks for (dynamically consistent, as Sentis and Khatib 2005).
///
/// P projects onto E M⁻¹ t = 0, I M⁻¹ t ≤ 0 for the equality rows E and inequality rows I of these levels.  The back
/// end has no torque limits of its own: where the problem has them, the torque is scaled uniformly into them.
/// `solve` takes no memory.
///
/// Reported ranks are those of a level's equality rows projected into what all higher levels leave, in both cascades.
class NullSpace final : public control::BackEnd {
 public:
  explicit NullSpace(const NullSpaceOptions& options);
  ~NullSpace() override;

 private:
  void doPrepare(const control::TickProblem& shape) override;
  void doSolve(const control::TickProblem& problem, control::TickSolution& solution) override;

  struct Workspace;
  void augmented(control::TickSolution& solution);
  void successive(control::TickSolution& solution);
  void consistent(const control::TickProblem& problem, control::TickSolution& solution);
  void project(control::PriorityFactor& factor, int first_inequality, int inequalities,
               control::TickSolution& solution);

  NullSpaceOptions options_;
  std::unique_ptr<Workspace> work_;
};

}  // namespace tactus::null_space
