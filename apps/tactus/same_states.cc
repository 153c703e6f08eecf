#include "apps/tactus/same_states.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>

namespace tactus::app {
namespace {

using Eigen::VectorXd;

/// Largest of two residuals; not-a-number is the worst of all.
double worse(double a, double b) { return std::isnan(b) || b > a ? b : a; }

double norm(const Eigen::LLT<Eigen::MatrixXd>& mass, const VectorXd& torque) {
  return mass.matrixL().solve(torque).norm();
}

}  // namespace

void ProblemSampler::observe(const control::ObservedTick& tick) {
  if (ticks_++ % every_ != 0) return;
  problems_.push_back(tick.controller.problem());
  times_.push_back(tick.sensed.time);
}

Answers solveAll(control::BackEnd& back_end, const std::vector<control::TickProblem>& problems) {
  using Clock = std::chrono::steady_clock;
  Answers answers;
  if (problems.empty()) return answers;
  control::TickSolution solution;
  back_end.prepare(problems.front(), solution);
  for (const control::TickProblem& problem : problems) {
    const auto start = Clock::now();
    back_end.solve(problem, solution);
    answers.solve_us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - start).count());
    answers.solutions.push_back(solution);
    if (solution.status != control::Status::ok) {
      ++answers.unsolved;
      answers.torques.emplace_back();
      continue;
    }
    answers.torques.push_back(solution.torque);
    answers.violation_max = worse(answers.violation_max, relativeViolation(problem, solution));
    if (!solution.has_kkt) continue;
    answers.has_kkt = true;
    answers.kkt_max.stationarity = worse(answers.kkt_max.stationarity, solution.kkt.stationarity);
    answers.kkt_max.primal = worse(answers.kkt_max.primal, solution.kkt.primal);
    answers.kkt_max.complementarity = worse(answers.kkt_max.complementarity, solution.kkt.complementarity);
  }
  return answers;
}

double relativeViolation(const control::TickProblem& problem, const control::TickSolution& solution) {
  if (solution.has_kkt) return solution.kkt.primal;
  if (problem.levels.empty()) return 0;
  const Eigen::LLT<Eigen::MatrixXd> mass(problem.mass_matrix);
  const double scale = norm(mass, solution.torque);
  if (scale == 0) return 0;
  VectorXd lower = solution.torque;
  for (const control::TickTask& task : problem.levels.front().tasks) {
    lower -= solution.scale * (task.J().transpose() * task.F());
  }
  const VectorXd acceleration = mass.solve(lower);
  double worst = 0;
  for (const control::TickTask& task : problem.levels.front().tasks) {
    for (int row = 0; row < task.rows; ++row) {
      const VectorXd j = task.jacobian.row(row).transpose();
      const double length = norm(mass, j);
      if (length == 0) continue;
      const double change = j.dot(acceleration) / (length * scale);
      worst = worse(worst, task.relation == control::Relation::equality ? std::abs(change) : std::max(0.0, change));
    }
  }
  return worst;
}

double leastTorque(const control::TickProblem& problem) {
  constexpr double share = 1e-9;                                   // of what the actuators could do
  if (!problem.torque_limits) return 0;
  const VectorXd range = 0.5 * (problem.torque_limits->upper - problem.torque_limits->lower);
  const double length = norm(Eigen::LLT<Eigen::MatrixXd>(problem.mass_matrix), range);
  return std::isfinite(length) ? share * length : 0;
}

TorqueDifference compareTorques(const std::vector<control::TickProblem>& problems, const Answers& reference,
                                const Answers& other) {
  TorqueDifference difference;
  for (size_t i = 0; i < problems.size(); ++i) {
    const VectorXd& a = reference.torques[i];
    const VectorXd& b = other.torques[i];
    if (a.size() == 0 || b.size() == 0) continue;
    const Eigen::LLT<Eigen::MatrixXd> mass(problems[i].mass_matrix);
    const double distance = norm(mass, b - a), length = norm(mass, a);
    const double relative = distance == 0 ? 0 : distance / std::max(length, leastTorque(problems[i]));
    difference.mean += distance;
    difference.max = worse(difference.max, distance);
    difference.relative_mean += relative;
    difference.relative_max = worse(difference.relative_max, relative);
    ++difference.compared;
  }
  if (difference.compared > 0) {
    difference.mean /= static_cast<double>(difference.compared);
    difference.relative_mean /= static_cast<double>(difference.compared);
  }
  return difference;
}

}  // namespace tactus::app
