#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "framework/control/tick_problem.h"

/// Random tick problems for the laws, and the few dense, slow and independent computations that judge the answers.
namespace tactus::test {

struct RandomProblemOptions {
  int min_dof = 9;
  int max_dof = 50;
  int min_levels = 2;
  int max_levels = 6;
  double inequality_share = 0.4;                                   ///< of the tasks
  double copy_share = 0.2;                                         ///< of the rows: a multiple of an earlier row
  double combination_share = 0.15;                                 ///< of the rows: a combination of two earlier rows
  double max_log10_condition = 6;                                  ///< of the mass matrix
  double max_log10_scale = 3;                                      ///< rows are scaled by 10^±this
  double common_direction = 1.5;                                   ///< size of a part that all rows of a problem share
  double acceleration_share = 0.2;                                 ///< of the tasks
  int max_tasks = 3;                                               ///< per level
  int max_rows = 4;                                                ///< per task that is no contact
  int max_contact_rows = 20;                                       ///< of all contacts
};

class ProblemSource {
 public:
  explicit ProblemSource(unsigned seed) : random_(seed) {}

  double uniform(double lower, double upper) { return std::uniform_real_distribution<>(lower, upper)(random_); }
  double normal() { return std::normal_distribution<>()(random_); }
  int integer(int lower, int upper) { return std::uniform_int_distribution<>(lower, upper)(random_); }
  bool chance(double share) { return uniform(0, 1) < share; }
  std::mt19937& engine() { return random_; }

  Eigen::MatrixXd gaussian(int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return normal(); });
  }

  /// Symmetric positive definite with log-uniform eigenvalues.
  Eigen::MatrixXd massMatrix(int dof, double log10_condition) {
    const Eigen::MatrixXd Q = gaussian(dof, dof).householderQr().householderQ();
    Eigen::VectorXd eigenvalues(dof);
    for (double& value : eigenvalues) value = std::pow(10, -uniform(0, log10_condition));
    const Eigen::MatrixXd M = Q * eigenvalues.asDiagonal() * Q.transpose();
    return 0.5 * (M + M.transpose());
  }

  control::TickProblem problem(const RandomProblemOptions& options) {
    control::TickProblem problem;
    problem.dof = integer(options.min_dof, options.max_dof);
    problem.mass_matrix = massMatrix(problem.dof, uniform(0, options.max_log10_condition));
    forget();
    common_ = options.common_direction * gaussian(1, problem.dof);
    const int levels = integer(options.min_levels, options.max_levels);
    for (int i = 0; i < levels; ++i) {
      control::TickLevel level;
      level.priority = 2 * i + 1;
      const int tasks = integer(1, options.max_tasks);
      for (int t = 0; t < tasks; ++t) {
        control::TickTask next = task("task" + std::to_string(i) + std::to_string(t), problem.dof, options);
        if (chance(options.inequality_share)) next.relation = control::Relation::inequality;
        level.tasks.push_back(std::move(next));
      }
      problem.levels.push_back(std::move(level));
    }
    return problem;
  }

  control::TickTask task(const std::string& name, int dof, const RandomProblemOptions& options) {
    return task(name, integer(1, options.max_rows), dof, options);
  }

  control::TickTask task(const std::string& name, int rows, int dof, const RandomProblemOptions& options) {
    control::TickTask task(name, rows, dof);
    task.rows = task.capacity();
    for (int r = 0; r < task.rows; ++r) {
      Eigen::RowVectorXd row = gaussian(1, dof);
      if (common_.size() == dof) row += uniform(-1, 1) * common_;
      if (!earlier_.empty() && chance(options.copy_share))
        row = earlier();
      else if (!earlier_.empty() && chance(options.combination_share))
        row = normal() * earlier() + normal() * earlier();
      earlier_.push_back(row);
      const double scale = std::pow(10, uniform(-options.max_log10_scale, options.max_log10_scale));
      task.jacobian.row(r) = scale * row;
      task.force[r] = normal() / scale;
      task.acceleration[r] = scale * normal();
    }
    task.has_acceleration = chance(options.acceleration_share);
    return task;
  }

  /// Level 1 holds contacts alone, equality and inequality ones; the others hold equality tasks, or as `options` say.
  control::TickProblem contactProblem(const RandomProblemOptions& options, double negative_share = 0,
                                      double friction_share = 0) {
    control::TickProblem problem = this->problem(options);
    problem.levels[0].tasks.clear();
    const int rows = integer(2, options.max_contact_rows);
    const int held = integer(1, rows - 1);
    for (const control::Relation relation : {control::Relation::equality, control::Relation::inequality}) {
      const bool equality = relation == control::Relation::equality;
      const bool cones = equality && held >= 3 && chance(friction_share);
      control::TickTask contacts =
          task(equality ? "held" : "shy", equality ? held : rows - held, problem.dof, options);
      contacts.has_acceleration = false;
      if (cones) {
        contacts = control::TickTask("held", held / 3 * 3, problem.dof);
        contacts.rows = contacts.capacity();
        contacts.jacobian = gaussian(contacts.rows, problem.dof);
        contacts.force = gaussian(contacts.rows, 1);
        for (int n = 0; n < contacts.rows; n += 3) contacts.force[n] = std::abs(contacts.force[n]);
        contacts.friction = uniform(0.2, 1);
      } else {
        contacts.force = contacts.force.cwiseAbs();
        if (chance(negative_share)) contacts.force[0] *= -1;
      }
      contacts.relation = relation;
      contacts.contact = true;
      problem.levels[0].tasks.push_back(contacts);
    }
    return problem;
  }

  /// Limits around zero that cut some of the torques.
  control::TorqueLimits limits(int dof, double size) {
    control::TorqueLimits limits;
    limits.lower = -size * gaussian(dof, 1).cwiseAbs();
    limits.upper = size * gaussian(dof, 1).cwiseAbs();
    return limits;
  }

  /// Forgets the rows that later tasks may repeat.
  void forget() {
    earlier_.clear();
    common_.resize(0);
  }

 private:
  const Eigen::RowVectorXd& earlier() { return earlier_[integer(0, static_cast<int>(earlier_.size()) - 1)]; }

  std::mt19937 random_;
  std::vector<Eigen::RowVectorXd> earlier_;                        // unscaled
  Eigen::RowVectorXd common_;
};

/// Rows of one relation of a level, stacked.
inline Eigen::MatrixXd stackedRows(const control::TickProblem& problem, int level, control::Relation relation) {
  Eigen::MatrixXd rows(0, problem.dof);
  for (const control::TickTask& task : problem.levels[level].tasks) {
    if (task.relation != relation) continue;
    rows.conservativeResize(rows.rows() + task.rows, problem.dof);
    rows.bottomRows(task.rows) = task.J();
  }
  return rows;
}

/// Rows in whitened coordinates, each of unit length.
inline Eigen::MatrixXd unitRows(const control::TickProblem& problem, const Eigen::MatrixXd& rows) {
  const Eigen::LLT<Eigen::MatrixXd> cholesky(problem.mass_matrix);
  Eigen::MatrixXd A = cholesky.matrixL().solve(rows.transpose()).transpose();
  A.rowwise().normalize();
  return A;
}

inline double inverseMassNorm(const control::TickProblem& problem, const Eigen::VectorXd& torque) {
  return problem.mass_matrix.llt().matrixL().solve(torque).norm();
}

/// J M⁻¹ τ, each row divided by its own M⁻¹ norm.
inline Eigen::VectorXd unitAcceleration(const control::TickProblem& problem, const Eigen::MatrixXd& rows,
                                        const Eigen::VectorXd& torque) {
  return unitRows(problem, rows) * Eigen::VectorXd(problem.mass_matrix.llt().matrixL().solve(torque));
}

/// Ranks of the levels' equality rows projected into what the levels above leave, by singular values; and whether
/// every singular value keeps clear of the band in which a rank is faded or decided by rounding.
struct DenseRanks {
  std::vector<int> ranks;
  bool clear = true;
};
inline DenseRanks denseRanks(const control::TickProblem& problem, double below, double above) {
  DenseRanks result;
  Eigen::MatrixXd P = Eigen::MatrixXd::Identity(problem.dof, problem.dof);
  for (std::size_t i = 0; i < problem.levels.size(); ++i) {
    const Eigen::MatrixXd rows = stackedRows(problem, static_cast<int>(i), control::Relation::equality);
    int rank = 0;
    if (rows.rows() > 0) {
      const Eigen::MatrixXd projected = unitRows(problem, rows) * P;
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(projected, Eigen::ComputeThinV);
      for (int k = 0; k < svd.singularValues().size(); ++k) {
        const double sigma = svd.singularValues()[k];
        if (sigma > below && sigma < above) result.clear = false;
        if (sigma < above) continue;
        ++rank;
        P -= svd.matrixV().col(k) * svd.matrixV().col(k).transpose();
      }
    }
    result.ranks.push_back(rank);
  }
  return result;
}

/// The problem with levels 0 … count − 1 alone.
inline control::TickProblem topLevels(control::TickProblem problem, int count) {
  problem.levels.resize(count);
  return problem;
}

}  // namespace tactus::test
