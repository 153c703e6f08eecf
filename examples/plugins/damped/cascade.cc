#include "cascade.h"

#include <Eigen/Cholesky>

#include <algorithm>

#include "framework/control/torque_scaling.h"

using namespace tactus::control;

Cascade::Cascade(double damping, double rank_tolerance)
    : BackEnd({.strict_levels = true}), damping_(damping), rank_tolerance_(rank_tolerance) {}

void Cascade::doPrepare(const TickProblem& shape) {
  int rows = 0;
  for (const TickLevel& level : shape.levels) {
    int count = 0;
    for (const TickTask& task : level.tasks) count += task.capacity();
    rows = std::max(rows, count);
  }
  for (Eigen::MatrixXd* matrix : {&L_, &N_, &gram_}) matrix->setZero(shape.dof, shape.dof);
  for (Eigen::MatrixXd* matrix : {&A_, &B_}) matrix->setZero(rows, shape.dof);
  for (Eigen::VectorXd* vector : {&a_, &missing_}) vector->setZero(rows);
  for (Eigen::VectorXd* vector : {&y_, &own_, &pull_}) vector->setZero(shape.dof);
  directions_ = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(shape.dof);
}

int Cascade::gather(const TickLevel& level) {
  own_.setZero();
  for (const TickTask& task : level.tasks) own_.noalias() += task.J().transpose() * task.F();
  L_.triangularView<Eigen::Lower>().solveInPlace(own_);            // L⁻¹ Σ JᵀF
  int rows = 0;
  for (const TickTask& task : level.tasks) {
    auto A = A_.middleRows(rows, task.rows);
    A = task.J();
    L_.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(A);  // J L⁻ᵀ
    auto a = a_.segment(rows, task.rows);
    if (task.has_acceleration) a = task.acceleration.head(task.rows);
    else a.noalias() = A * own_;
    rows += task.rows;
  }
  return rows;
}

void Cascade::doSolve(const TickProblem& problem, TickSolution& solution) {
  solution.status = Status::ok;
  solution.message.clear();
  solution.scale = 1;
  solution.torque.setZero();
  L_ = problem.mass_matrix;
  if (Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(L_).info() != Eigen::Success) {
    solution.status = Status::failed;
    solution.message = "the mass matrix is not positive definite";
    return;
  }
  y_.setZero();
  N_.setIdentity();
  int left = problem.dof;
  for (std::size_t i = 0; i < problem.levels.size(); ++i) {
    const int rows = gather(problem.levels[i]);
    const auto A = A_.topRows(rows);
    auto B = B_.topRows(rows);
    auto missing = missing_.head(rows);
    const double norm = A.norm();
    B.noalias() = A * N_;
    missing = a_.head(rows);
    missing.noalias() -= A * y_;
    pull_.noalias() = B.transpose() * missing;
    gram_.noalias() = B.transpose() * B;
    directions_.compute(gram_);

    int rank = 0;
    for (int k = 0; k < problem.dof; ++k) {
      const auto v = directions_.eigenvectors().col(k);
      const double square = std::max(directions_.eigenvalues()[k], 0.0);
      const double held = rank_tolerance_ * norm;
      if (square <= held * held) continue;                         // of these the pull is nothing but rounding
      y_ += v * (v.dot(pull_) / (square + damping_ * damping_ * norm * norm));
      N_.noalias() -= v * v.transpose();
      ++rank;
    }
    LevelReport& report = solution.levels[i];
    report.rank = rank;
    report.nullity = left -= rank;
    missing = a_.head(rows);
    missing.noalias() -= A * y_;
    report.residual = missing.norm();
    report.active.clear();
  }
  solution.torque.noalias() = L_.triangularView<Eigen::Lower>() * y_;
  if (!problem.torque_limits) return;
  const TorqueScaling scaling = scaleIntoLimits(*problem.torque_limits, solution.torque);
  solution.scale = scaling.scale;
  if (!scaling.possible) {
    solution.status = Status::infeasible;
    solution.message = "no multiple of the torque lies within the torque limits";
  }
}
