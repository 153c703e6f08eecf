#pragma once

#include <vector>

#include "framework/control/constrained_least_squares.h"
#include "framework/control/tick_problem.h"
#include "framework/control/whitened_problem.h"

namespace tactus::qp {

enum class Objective {
  torque,                                                          ///< 5.3.5: cannot rank tasks
  acceleration
};
enum class Metric {
  identity,                                                        ///< the thesis
  inertia
};

struct WeightedQpOptions {
  Objective objective = Objective::acceleration;
  Metric metric = Metric::identity;
  double weight_ratio = 100;                                       ///< from a level to the next, where none is given
  double force_weight = 1;                                         ///< w_f
  double regularisation = 0.01;                                    ///< w_r over the least level weight
};

/// The weighted quadratic programme 5.3.5–5.3.10 of a tick, in whitened reduced variables x = (y, φ): τ_s = L y is the
/// torque of all tasks that are not contacts, φ_j = ‖J_j‖ f_j are contact forces measured, as y is, by what they do in
/// the M⁻¹ metric; τ = τ_s + J_cᵀ f.
///
///   torque:        w ‖τ_s − Σ τ°_i‖² + w_f ‖f − f_ref‖²,  w = 1/Σ(1/w_i): the sum over levels in closed form;
///   acceleration:  Σ w_i ‖J_i M⁻¹ τ_s − a_i‖² + w_f ‖f − f_ref‖² + w_r τ_sᵀ M⁻¹ τ_s,
///
/// J_i a level's equality rows and its inequality rows with F ≠ 0, a_i = J_i M⁻¹ τ°_i or the acceleration that a task
/// asks for.  In the metric `inertia` the torque objective's distance is that of M⁻¹, and every row j of the
/// acceleration objective is multiplied by (J_j M⁻¹ J_jᵀ)^-½, the root of the inertia that it meets (Khatib 1987): its
/// square is then an acceleration's energy, whatever units and whichever limb the row has.
///
/// Constraints: J M⁻¹ τ_s = 0 for equality contacts, ≤ 0 for inequality rows; torque limits;
/// 0 ≤ f ≤ f_max, and for contacts with friction |f_t₁| + |f_t₂| ≤ μ f_n, the pyramid inside the cone.
/// A contact whose reference is negative counts as an inequality row, with its force in τ°.
class WeightedQp {
 public:
  WeightedQp(const control::TickProblem& shape, const WeightedQpOptions& options);

  void build(const control::TickProblem& problem, const control::WhitenedProblem& whitened);

  const control::ConstrainedLeastSquares& programme() const { return programme_; }
  /// The row of the whitened problem behind an inequality row, or -1 for a limit.
  int inequalityOrigin(int row) const { return inequality_origins_[row]; }
  /// τ = L y + J_cᵀ f, and the forces of all contact rows in the order of the problem; returns their number.
  int answer(const control::TickProblem& problem, const control::WhitenedProblem& whitened, const Eigen::VectorXd& x,
             Eigen::VectorXd& torque, Eigen::VectorXd& forces) const;

  static int variableCapacity(const control::TickProblem& shape);
  static int inequalityCapacity(const control::TickProblem& shape);
  static int objectiveCapacity(const control::TickProblem& shape);

 private:
  enum class Role { task, force, backing_off, dropped };           // of a row
  static Role role(const control::TickTask& task, int row);

  void addObjective(const control::TickProblem& problem, const control::WhitenedProblem& whitened);
  void addTorqueObjective(const control::WhitenedProblem& whitened);
  void addAccelerationObjective(const control::TickProblem& problem, const control::WhitenedProblem& whitened);
  void addRowConstraints(const control::WhitenedProblem& whitened);
  void addTorqueLimits(const control::TickProblem& problem, const control::WhitenedProblem& whitened);
  void addForceBounds(const control::TickProblem& problem, const control::WhitenedProblem& whitened);
  Eigen::Ref<Eigen::RowVectorXd, 0, Eigen::InnerStride<>> newInequality(double bound, int origin);
  void normaliseLast();

  WeightedQpOptions options_;
  int dof_;
  int force_count_ = 0;
  control::ConstrainedLeastSquares programme_;
  std::vector<double> weights_;                                    // of levels
  std::vector<Role> roles_;                                        // of the whitened problem's rows
  std::vector<int> variables_;                                     // index into x of a row's force, or -1
  std::vector<int> inequality_origins_;
  double forceScale(const control::WhitenedProblem& whitened, int j) const;

  Eigen::MatrixXd own_;                                            // y°_i without the forces that are variables
  std::vector<bool> has_own_;
};

}  // namespace tactus::qp
