#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "framework/control/tick_problem.h"

/// What a back end answers, and what it did: plain data, sized once by `prepare`.
namespace tactus::control {

enum class Status { ok, infeasible, failed };

/// An inequality row that is held at its bound.
struct ActiveRow {
  int level = 0;                                                   ///< index into TickProblem::levels
  int task = 0;                                                    ///< index into TickLevel::tasks
  int row = 0;
};

struct LevelReport {
  int priority = 1;
  int rank = 0;                                                    ///< of the level's rows projected into what upper levels left
  int nullity = 0;                                                 ///< dof − Σ ranks so far
  double residual = 0;                                             ///< ‖J M⁻¹ τ − a‖
  std::vector<ActiveRow> active;
};

/// Karush–Kuhn–Tucker residuals of a quadratic programme, computed outside its solver; relative, dimensionless.
struct KktResidual {
  double stationarity = 0;
  double primal = 0;                                               ///< worst violation of a constraint
  double complementarity = 0;
};

struct TickSolution {
  Status status = Status::ok;
  std::string message;                                             ///< empty when ok
  Eigen::VectorXd torque;                                          ///< dof; b + g not included
  Eigen::VectorXd contact_forces;                                  ///< rows of contact tasks in order; first n_contact_forces valid
  int n_contact_forces = 0;
  std::vector<LevelReport> levels;
  double scale = 1;                                                ///< uniform scaling into the torque limits, 1 = none
  bool late = false;                                               ///< the deadline came before the answer; status is `failed`
  bool has_kkt = false;
  KktResidual kkt;
  int iterations = 0;
  // What the inequality handling met in this tick; law tests count them.
  int rows_held = 0;                                               ///< inequality rows held at their bound
  int rows_released = 0;                                           ///< rows held on the way and let go again
  int rank_deficient_levels = 0;                                   ///< levels whose rows were dependent or faded
};

}  // namespace tactus::control
