#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// One tick as plain data: what every back end eats, and what a tick problem file holds.
///
/// Dynamics (thesis 4.2.4): M q̈ + b + g + J_cᵀ f = τ, with f what the robot does to the world.  Torques here
/// are what is left after b + g: a back end works with the task torque alone.
///
/// Storage is sized once, when the stack is compiled; a tick only changes `rows` and the values.
namespace tactus::control {

/// What lower levels may not do to J M⁻¹ τ: change it (equality) or raise it (inequality).
enum class Relation { equality, inequality };

/// The rows that one task puts into a tick.  Its torque is Jᵀ F.
struct TickTask {
  std::string name;
  Relation relation = Relation::equality;
  int rows = 0;                                                    ///< valid rows, ≤ capacity
  Eigen::MatrixXd jacobian;                                        ///< capacity × dof
  Eigen::VectorXd force;                                           ///< capacity; F (N or N m)
  bool has_acceleration = false;                                   ///< the task asks for `acceleration` instead of J M⁻¹ τ°
  Eigen::VectorXd acceleration;                                    ///< capacity; J̇q̇ already taken off
  bool contact = false;                                            ///< rows are contacts with forces f, reference F
  double force_max = std::numeric_limits<double>::infinity();      ///< per contact, N
  std::optional<double> friction;                                  ///< μ; rows then come in threes: normal, t₁, t₂

  TickTask() = default;
  TickTask(std::string task_name, int capacity, int dof);
  int capacity() const { return static_cast<int>(jacobian.rows()); }
  auto J() const { return jacobian.topRows(rows); }
  auto F() const { return force.head(rows); }
};

struct TickLevel {
  int priority = 1;                                                ///< 1 is the highest
  std::optional<double> weight;                                    ///< for weighted back ends; else the declared ratio
  std::vector<TickTask> tasks;
};

/// Torques left for the tasks after b + g, N m.
struct TorqueLimits {
  Eigen::VectorXd lower;
  Eigen::VectorXd upper;
  std::optional<int> priority;
};

struct TickProblem {
  int dof = 0;
  Eigen::MatrixXd mass_matrix;                                     ///< dof × dof, symmetric positive definite
  std::optional<TorqueLimits> torque_limits;
  std::vector<TickLevel> levels;                                   ///< by rising priority number
  /// Every row that the levels can ever hold.
  int rowCapacity() const;
};

}  // namespace tactus::control
