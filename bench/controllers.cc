// A back end alone, on tick problems of the shape of the table exploration: an arm of 7 joints with four fingers of 4,
// 12 contacts; joint limits; 9 missing contacts, a surface to follow and finger postures; an arm posture.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "plugins/null-space/null_space.h"
#include "plugins/qp/solvers.h"

namespace tactus {
namespace {

constexpr int arm_joints = 7;
constexpr int fingers = 4;
constexpr int finger_joints = 4;
constexpr int dof = arm_joints + fingers * finger_joints;
constexpr int sequence_length = 64;

class ExplorationProblems {
 public:
  // Slowly changing ticks, as a moving hand makes them.
  std::vector<control::TickProblem> sequence() {
    Eigen::MatrixXd masses = Eigen::MatrixXd::Zero(dof, dof);
    masses.diagonal().head(arm_joints).setConstant(0.05);          // rotors
    masses.diagonal().tail(dof - arm_joints).setConstant(1e-4);
    for (int finger = 0; finger < fingers; ++finger)
      for (int joints = 1; joints <= finger_joints; ++joints) {
        const Eigen::MatrixXd J = linkRows(6, finger, joints);
        masses += 0.03 * J.transpose() * J;
      }
    const Eigen::MatrixXd J = 0.5 * armRows(12);
    masses += J.transpose() * J;

    control::TickProblem problem;
    problem.dof = dof;
    problem.mass_matrix = masses;
    control::TickTask hold("hold", 9, dof), shy("shy", 3, dof), limits("limits", dof, dof), close("close", 27, dof),
        sweep("sweep", 6, dof), rest("rest", 10, dof), arm("arm", arm_joints, dof);
    for (int c = 0; c < 9; ++c) hold.jacobian.row(c) = linkRows(1, c % 3, 2 + c / 3);
    for (int c = 0; c < 3; ++c) shy.jacobian.row(c) = linkRows(1, 3, 2 + c);
    limits.jacobian.setIdentity();
    for (int j = 0; j < dof; j += 2) limits.jacobian(j, j) = -1;
    for (int c = 0; c < 9; ++c) close.jacobian.middleRows(3 * c, 3) = linkRows(3, c % 3, 2 + c / 3);
    sweep.jacobian = armRows(6);
    for (int j = 0; j < 10; ++j) rest.jacobian(j, arm_joints + j) = 1;
    arm.jacobian.leftCols(arm_joints).setIdentity();
    shy.relation = limits.relation = control::Relation::inequality;
    hold.contact = shy.contact = true;
    problem.levels = {{1, {}, {hold, shy}}, {2, {}, {limits}}, {3, {}, {close, sweep, rest}}, {4, {}, {arm}}};
    for (control::TickLevel& level : problem.levels)
      for (control::TickTask& task : level.tasks) task.rows = task.capacity();
    const Eigen::VectorXd limit = Eigen::VectorXd::Constant(dof, 20);
    problem.torque_limits = control::TorqueLimits{-limit, limit, {}};

    std::vector<control::TickProblem> ticks;
    for (int k = 0; k < sequence_length; ++k) {
      for (control::TickLevel& level : problem.levels)
        for (control::TickTask& task : level.tasks) {
          for (int r = 0; r < task.rows; ++r)
            task.force[r] = task.name == "hold" ? 0.5 : 0.3 * std::sin(0.05 * k + 7.0 * r);
          if (task.name == "limits" || task.name == "shy") task.force.setZero();
          task.jacobian =
              task.jacobian.unaryExpr([this](double x) { return x == 0 ? x : x * (1 + 1e-3 * normal_(random_)); });
        }
      ticks.push_back(problem);
    }
    return ticks;
  }

 private:
  Eigen::MatrixXd gaussian(int rows, int columns) {
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [this] { return normal_(random_); });
  }
  Eigen::MatrixXd armRows(int rows) {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows, dof);
    J.leftCols(arm_joints) = 0.5 * gaussian(rows, arm_joints);
    return J;
  }
  Eigen::MatrixXd linkRows(int rows, int finger, int joints) {
    Eigen::MatrixXd J = armRows(rows);
    J.middleCols(arm_joints + finger * finger_joints, joints) = 0.05 * gaussian(rows, joints);
    return J;
  }

  std::mt19937 random_{1};
  std::normal_distribution<> normal_;
};

void run(benchmark::State& state, control::BackEnd& back_end) {
  const std::vector<control::TickProblem> ticks = ExplorationProblems().sequence();
  control::TickSolution solution;
  back_end.prepare(ticks[0], solution);
  std::size_t k = 0;
  int failures = 0;
  double held = 0;
  for (auto _ : state) {
    back_end.solve(ticks[k++ % ticks.size()], solution);
    failures += solution.status != control::Status::ok;
    held += solution.rows_held;
    benchmark::DoNotOptimize(solution.torque.data());
  }
  state.counters["failures"] = failures;
  state.counters["rows_held"] = benchmark::Counter(held, benchmark::Counter::kAvgIterations);
}

void nullSpace(benchmark::State& state, null_space::Cascade cascade, null_space::Inequalities inequalities) {
  null_space::NullSpaceOptions options;
  options.cascade = cascade;
  options.inequalities = inequalities;
  null_space::NullSpace back_end(options);
  run(state, back_end);
}

void weightedQp(benchmark::State& state, bool ipopt, qp::Objective objective) {
  qp::WeightedQpOptions options;
  options.objective = objective;
  qp::QpBackEnd back_end(options, qp::makeReferenceSolver(ipopt ? qp::makeIpoptSolver() : qp::makeNloptSolver()));
  run(state, back_end);
}

BENCHMARK_CAPTURE(nullSpace, augmented_exact, null_space::Cascade::augmented, null_space::Inequalities::exact);
BENCHMARK_CAPTURE(nullSpace, augmented_one_pass, null_space::Cascade::augmented, null_space::Inequalities::one_pass);
BENCHMARK_CAPTURE(nullSpace, successive_exact, null_space::Cascade::successive, null_space::Inequalities::exact);
BENCHMARK_CAPTURE(weightedQp, ipopt_acceleration, true, qp::Objective::acceleration);
BENCHMARK_CAPTURE(weightedQp, nlopt_acceleration, false, qp::Objective::acceleration);
BENCHMARK_CAPTURE(weightedQp, ipopt_torque, true, qp::Objective::torque);
BENCHMARK_CAPTURE(weightedQp, nlopt_torque, false, qp::Objective::torque);

}  // namespace
}  // namespace tactus
