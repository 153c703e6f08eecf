#pragma once

#include <Eigen/Eigenvalues>

#include "framework/control/back_end.h"

/// The back end `damped.cascade`: level by level, a damped pseudo-inverse in what the levels above leave.
///
/// In whitened coordinates, M = L Lᵀ, y = L⁻¹τ, the acceleration of a level's rows is A y with A = J L⁻ᵀ, and it asks
/// for a = A L⁻¹Σ JᵀF (or for `acceleration`, where a task gives it).  From the highest level down, with N the
/// projector onto what is left and y what has been settled (Siciliano & Slotine 1991, on accelerations), B = A N has
/// right singular vectors v_k and singular values σ_k:
///
///   y ← y + Bᵀ(B Bᵀ + μ² I)⁻¹(a − A y) = y + Σ v_k v_kᵀBᵀ(a − A y) / (σ_k² + μ²),   μ = λ ‖A‖_F
///   N ← N − Σ v_k v_kᵀ over σ_k > τ ‖A‖_F
///
/// The damped inverse (Nakamura & Hanafusa 1986) adds at most ‖a − A y‖/(2μ) also in a singular configuration, where a
/// true inverse would ask for a boundless torque; the price is that a level reaches only σ²/(σ² + μ²) of what it asks
/// for in each direction.  The projector is not damped (Chiaverini 1997): one made of damped inverses leaves μ²/(σ² +
/// μ²) of each direction to the levels below, which divide by it and take all of it.  So the levels are strict, in the
/// directions above τ.
///
/// It honours neither inequalities nor friction; torque limits are met by scaling the whole torque.
class Cascade final : public tactus::control::BackEnd {
 public:
  /// λ and τ, both relative to ‖A‖_F.
  Cascade(double damping, double rank_tolerance);

 private:
  void doPrepare(const tactus::control::TickProblem& shape) override;
  void doSolve(const tactus::control::TickProblem& problem, tactus::control::TickSolution& solution) override;
  /// A and a of a level; the number of its rows.
  int gather(const tactus::control::TickLevel& level);

  double damping_, rank_tolerance_;
  // All memory of a tick, taken by doPrepare.
  Eigen::MatrixXd L_, N_, gram_;                                   // dof × dof
  Eigen::MatrixXd A_, B_;                                          // rows × dof
  Eigen::VectorXd a_, missing_;                                    // rows
  Eigen::VectorXd y_, own_, pull_;                                 // dof
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> directions_;      // of BᵀB = Σ σ_k² v_k v_kᵀ
};
