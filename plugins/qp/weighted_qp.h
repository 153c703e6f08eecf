#pragma once

#include <vector>

#include "framework/control/tick_problem.h"
#include "framework/control/whitened_problem.h"
#include "plugins/qp/programme.h"

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
  int friction_edges = 4;                                          ///< sides of the pyramid inside a friction cone
};

/// The weighted quadratic programme 5.3.5–5.3.10 of a tick, in reduced variables x = (y, φ): τ_s = L y is the torque
/// of all tasks that are not contacts, whitened; φ_j = ‖J_j‖ f_j are contact forces measured, as y is, by what they do
/// in the M⁻¹ metric; τ = τ_s + J_cᵀ f.  The thesis's torque objective in the metric `identity` takes y = τ_s instead:
/// there its Hessian is diagonal.
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
/// 0 ≤ f ≤ f_max, and for contacts with friction the pyramid with `friction_edges` edges inside the cone, its edges at
/// f_t = μ f_n (cos θ, sin θ), θ = 2πk/edges.
/// A contact whose reference is negative counts as an inequality row, with its force in τ°.
class WeightedQp {
 public:
  WeightedQp(const control::TickProblem& shape, const WeightedQpOptions& options);

  void build(const control::TickProblem& problem, const control::WhitenedProblem& whitened);

  const Programme& programme() const { return programme_; }
  /// The row of the whitened problem behind a row of the programme, or -1 for a limit.
  int origin(int row) const { return origins_[row]; }
  bool isEquality(int row) const { return programme_.lower[row] == programme_.upper[row]; }
  /// τ = L y + J_cᵀ f, and the forces of all contact rows in the order of the problem; returns their number.
  int answer(const control::TickProblem& problem, const control::WhitenedProblem& whitened, const Eigen::VectorXd& x,
             Eigen::VectorXd& torque, Eigen::VectorXd& forces) const;

  static int variableCapacity(const control::TickProblem& shape);
  static int rowCapacity(const control::TickProblem& shape, const WeightedQpOptions& options);
  static int objectiveCapacity(const control::TickProblem& shape);

 private:
  enum class Role { task, force, backing_off, dropped };           // of a row
  static Role role(const control::TickTask& task, int row);

  void addObjective(const control::TickProblem& problem, const control::WhitenedProblem& whitened);
  void addTorqueObjective(const control::WhitenedProblem& whitened);
  void addAccelerationObjective(const control::TickProblem& problem, const control::WhitenedProblem& whitened);
  void addEqualities(const control::WhitenedProblem& whitened);
  void addInequalities(const control::WhitenedProblem& whitened);
  void toCoordinates(const control::WhitenedProblem& whitened);
  void addTorqueLimits(const control::TickProblem& problem, const control::WhitenedProblem& whitened);
  void addForceBounds(const control::TickProblem& problem, const control::WhitenedProblem& whitened);
  int newRow(double lower, double upper, int origin);
  bool torqueCoordinates() const;
  double forceScale(const control::WhitenedProblem& whitened, int j) const;

  WeightedQpOptions options_;
  int dof_;
  int force_count_ = 0;
  Programme programme_;
  std::vector<double> weights_;                                    // of levels
  std::vector<Role> roles_;                                        // of the whitened problem's rows
  std::vector<int> variables_;                                     // index into x of a row's force, or -1
  std::vector<int> origins_;
  Eigen::MatrixXd own_;                                            // y°_i without the forces that are variables
  std::vector<bool> has_own_;
};

}  // namespace tactus::qp
