#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "framework/control/priority_factor.h"
#include "framework/control/tick_problem.h"
#include "framework/control/tick_solution.h"

/// The priority x-ray of a tick: what each task wanted, what it was granted, and who took the rest.
///
/// In whitened coordinates (whitened_problem.h) the rows of a task span a space of directions in which it wants to say
/// how the robot accelerates.  Higher levels hold the span of their equality rows and of those inequality rows that are
/// at their bound.  A direction u of the task, ‖u‖ = 1, that makes the angle θ with what is held is lost to the share
/// cos²θ: wholly where it is held, by ¾ at 30°.  The directions told are the principal ones (Björck and Golub 1973):
/// the worst one, the worst one orthogonal to it, and so on.  They are attributed from the top: of what the levels above a
/// task leave of u, the task takes the share that its own rows, projected likewise, span.  Where rows of one level span
/// together what none does alone, their shares are raised to what the level takes.
namespace tactus::control {

struct XrayOptions {
  RankOptions rank;                                                ///< when a direction counts, and where it fades
  double least_share = 0.01;                                       ///< less is not told, neither lost nor taken
};

/// A higher task that holds a part of a lost direction.
struct Taker {
  int level = 0;                                                   ///< indices into the problem
  int task = 0;
  double share = 0;                                                ///< of the direction, 0 to 1; shares may overlap
};

struct LostDirection {
  double share = 0;                                                ///< held by higher levels, cos²θ
  /// Which combination of the task's rows, unit length, on the side to which its force asks: three rows of a position
  /// make it a direction in their axes.
  Eigen::VectorXd rows;
  Eigen::VectorXd joints;                                          ///< the torque along it, Jᵀ rows, unit length
  std::vector<Taker> takers;                                       ///< the one with the largest share first
};

/// A singular direction of the projected rows that the fade holds only in part.
struct FadedDirection {
  double sigma = 0;                                                ///< as RankOptions measures it
  double weight = 0;                                               ///< 0 = not held, 1 = held
};

struct TaskXray {
  int level = 0;                                                   ///< indices into the problem
  int task = 0;
  int rows = 0;
  int wanted = 0;                                                  ///< rank of its own rows
  int granted = 0;                                                 ///< rank of what higher levels leave of them
  std::vector<LostDirection> lost;                                 ///< the worst first
  std::vector<FadedDirection> faded;
  std::vector<int> active;                                         ///< inequality rows at their bound
  double asked = 0;                                                ///< ‖a‖, m/s² or rad/s²
  double residual = 0;                                             ///< ‖J M⁻¹ τ − a‖, over rows that ask for something
  Eigen::VectorXd torque;                                          ///< Jᵀ F, N m
  /// What a cascade's projection and its scaling left of it; none where the torque of the tick is no such sum.
  std::optional<Eigen::VectorXd> torque_left;
};

struct LevelXray {
  int priority = 1;
  int wanted = 0;                                                  ///< rank of its equality rows alone
  int granted = 0;                                                 ///< of what higher equality rows leave: level/P/rank
  int freedom_left = 0;                                            ///< dof − Σ granted so far: level/P/nullity
};

/// A joint whose torque stands at a limit.
struct LimitHit {
  int joint = 0;
  bool upper = false;
  double limit = 0;                                                ///< N m, b + g not included
};

struct Xray {
  bool usable = false;                          ///< false: the mass matrix or a row cannot be worked with; all is empty
  std::vector<LevelXray> levels;
  std::vector<TaskXray> tasks;                                     ///< those with rows in this tick, from the top
  std::vector<LimitHit> limits;
  double scale = 1;                                                ///< of the whole torque, into its limits
};

/// Looks at a problem and at what a back end answered to it; changes nothing.  Takes memory: not for every tick.
Xray xray(const TickProblem& problem, const TickSolution& solution, const XrayOptions& options = {});

/// How well a torque does what a task asks for: norms over the rows that ask for something, m/s² or rad/s².
struct TaskError {
  int level = 0, task = 0;                                         ///< indices into the problem
  double asked = 0;                                                ///< ‖a‖
  double residual = 0;                                             ///< ‖J M⁻¹ τ − a‖
};

/// Of all tasks with rows in this tick, from the top.
std::vector<TaskError> taskErrors(const TickProblem& problem, const Eigen::VectorXd& torque);

/// Joints whose torque stands at a limit, within 1e-6 of the distance of the two.
std::vector<LimitHit> limitsHit(const TickProblem& problem, const Eigen::VectorXd& torque);

}  // namespace tactus::control
