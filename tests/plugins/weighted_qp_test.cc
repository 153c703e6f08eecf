// Laws 3 and 7 on random problems, the constraints of 5.3.5–5.3.10 on the answers, and statuses that are earned.
// Every answer is judged here by its own dense computation, not by the solver's or the back end's word.
#include <gtest/gtest.h>

#include <iostream>

#include "plugins/null-space/null_space.h"
#include "plugins/qp/solvers.h"
#include "tests/plugins/met_shapes.h"
#include "tests/plugins/random_problem.h"

namespace tactus::qp {
namespace {

using control::Relation;
using control::Status;
using control::TickProblem;
using control::TickSolution;
using control::TickTask;
using test::ProblemSource;
using test::RandomProblemOptions;

constexpr double solver_tolerance = 1e-4;                          // relative, in the M⁻¹ norm: laws 3 and 7
constexpr int problems_per_law = 1000;

enum class Solver { ipopt, nlopt, active_set };
constexpr Solver solvers[] = {Solver::ipopt, Solver::nlopt, Solver::active_set};
constexpr const char* names[] = {"ipopt", "nlopt", "active-set"};

std::unique_ptr<ProgrammeSolver> make(Solver solver, bool polish) {
  switch (solver) {
    case Solver::ipopt: return makeReferenceSolver(makeIpoptSolver(polish ? 1e-6 : 1e-13), polish);
    case Solver::nlopt: return makeReferenceSolver(makeNloptSolver(), polish);
    default: return makeActiveSetSolver();
  }
}

TickSolution solve(const TickProblem& problem, const WeightedQpOptions& options, Solver solver, bool polish = true) {
  QpBackEnd back_end(options, make(solver, polish));
  TickSolution solution;
  back_end.prepare(problem, solution);
  back_end.solve(problem, solution);
  return solution;
}

struct Met {
  int deficient = 0;
  int held = 0;
  int active = 0;                                                  // problems with a row at its bound

  void add(const TickSolution& solution) {
    deficient += solution.rank_deficient_levels > 0;
    held += solution.rows_held;
    active += solution.rows_held > 0;
  }
};

TEST(WeightedQp, Law3TheExactCascadeIsTheTorqueProgrammeInTheInertiaMetric) {
  for (const Solver solver : solvers) {
    ProblemSource source(11);
    Met met;
    test::MetShapes shapes;
    for (int problems = 0; problems < problems_per_law;) {
      const TickProblem problem = source.contactProblem({.max_levels = 2, .inequality_share = 0, .max_rows = 6});
      if (!test::denseRanks(problem, 1e-9, 1e-5).clear) continue;
      ++problems;
      shapes.add(problem);
      null_space::NullSpace cascade({});
      TickSolution expected;
      cascade.prepare(problem, expected);
      cascade.solve(problem, expected);
      const WeightedQpOptions options{.objective = Objective::torque,
                                      .metric = Metric::inertia,
                                      .force_weight = std::pow(10, source.uniform(-2, 1))};
      const TickSolution solution = solve(problem, options, solver);
      EXPECT_EQ(solution.status, Status::ok) << solution.message;
      met.add(solution);
      EXPECT_LE(test::inverseMassNorm(problem, solution.torque - expected.torque),
                (solver == Solver::active_set ? 1e-8 : solver_tolerance) *
                    test::inverseMassNorm(problem, expected.torque))
          << names[static_cast<int>(solver)] << " " << solution.kkt.stationarity;
    }
    EXPECT_GE(met.deficient, 100);
    EXPECT_GE(met.held, 150);
    shapes.expectWide(0.2, 2);
  }
}

RandomProblemOptions ordinary() {
  return {.inequality_share = 0.3, .max_log10_condition = 4, .max_log10_scale = 1};
}

WeightedQpOptions randomOptions(ProblemSource& source) {
  WeightedQpOptions options;
  options.objective = source.chance(0.3) ? Objective::torque : Objective::acceleration;
  options.metric = source.chance(0.5) ? Metric::inertia : Metric::identity;
  options.force_weight = std::pow(10, source.uniform(-2, 1));
  options.weight_ratio = std::pow(10, source.uniform(0, 2));
  return options;
}

TickProblem limitedProblem(ProblemSource& source, const RandomProblemOptions& shape) {
  TickProblem problem = source.contactProblem(shape, 0.2, 0.3);
  if (source.chance(0.5)) problem.torque_limits = source.limits(problem.dof, 3);
  for (TickTask& task : problem.levels[0].tasks)
    if (source.chance(0.3)) task.force_max = source.uniform(0.1, 2);
  return problem;
}

// How many problems are tried; how many of them a solver may give up, saying so, and in how many the answers may differ.
struct Most {
  int problems = problems_per_law;
  int own_failed = 0;
  int reference_failed = 0;                                        // of each of Ipopt and NLopt
  int differ = 0;
};

// Law 7 twice: the solvers' own numbers on problems of moderate condition, and polished ones on hard problems.
void expectAgreement(unsigned seed, const RandomProblemOptions& shape, bool polish, const Most& most) {
  ProblemSource source(seed);
  Met met;
  test::MetShapes shapes;
  int limited = 0, own_failed = 0, differ = 0, reference_failed[] = {0, 0};
  double worst = 0;
  for (int problems = 0; problems < most.problems; ++problems) {
    const TickProblem problem = limitedProblem(source, shape);
    const WeightedQpOptions options = randomOptions(source);
    const TickSolution own = solve(problem, options, Solver::active_set);
    shapes.add(problem);
    if (own.status == Status::failed) {
      ++own_failed;
      EXPECT_FALSE(own.message.empty());
      continue;
    }
    ASSERT_EQ(own.status, Status::ok) << own.message;
    met.add(own);
    limited += problem.torque_limits.has_value();
    const double size = test::inverseMassNorm(problem, own.torque);
    double difference = 0;
    for (const Solver solver : {Solver::ipopt, Solver::nlopt}) {
      const TickSolution other = solve(problem, options, solver, polish);
      ASSERT_NE(other.status, Status::infeasible);
      if (other.status == Status::ok)
        difference = std::max(difference, test::inverseMassNorm(problem, own.torque - other.torque));
      else
        ++reference_failed[static_cast<int>(solver)];
    }
    if (difference > solver_tolerance * size)
      ++differ;
    else if (size > 0)
      worst = std::max(worst, difference / size);
  }
  std::cout << "Ipopt and NLopt differ from active-set by at most " << worst << ", in " << differ
            << " problems by more; " << own_failed << " not solved by active-set, " << reference_failed[0]
            << " by Ipopt, " << reference_failed[1] << " by NLopt; " << met.held << " rows at their bounds in " << met.active << " problems, " << met.deficient
            << " rank-deficient, " << limited << " with limits\n";
  EXPECT_LE(own_failed, most.own_failed);
  EXPECT_LE(differ, most.differ);
  for (const int failed : reference_failed) EXPECT_LE(failed, most.reference_failed);
  EXPECT_GE(met.deficient, 100);
  EXPECT_GE(met.active, 100);
  EXPECT_GE(limited, 100);
  shapes.expectWide(0.2, shape.max_levels);
}

// Without polish the reference solvers' own numbers lose their digits in a problem of a hundred, and their KKT residual
// says so.
TEST(WeightedQp, Law7TheSolversAgree) {
  RandomProblemOptions moderate = ordinary();
  moderate.max_log10_condition = 2;
  moderate.max_log10_scale = 0.3;
  expectAgreement(12, moderate, false, {.own_failed = 2, .reference_failed = 20});
}

// Up to four levels all is solved.
TEST(WeightedQp, Law7HoldsOnHardProblemsWithPolish) {
  RandomProblemOptions hard = ordinary();
  hard.max_levels = 4;
  expectAgreement(13, hard, true, {});
}

// With six levels and weights a hundred apart the last level counts 1e-10, and rows of other units in masses of
// condition 1e4 leave it few digits or none.
TEST(WeightedQp, Law7OfFiveAndSixLevelsHoldsButForAFewWithoutDigits) {
  RandomProblemOptions deep = ordinary();
  deep.min_levels = 5;
  expectAgreement(19, deep, true, {.problems = 300, .own_failed = 10, .reference_failed = 10, .differ = 3});
}

// Active-set once said `ok` of this one, 60 % off.  Five levels at a ratio of 63 and a residual of 800 in the strong rows:
// its stationarity, measured where a step's length is what it costs, is 4e-6, and the weakest direction magnifies that
// beyond the answer.
TEST(WeightedQp, AnAnswerWithoutDigitsInItsWeakDirectionsIsNotOk) {
  ProblemSource source(13);
  for (int k = 0; k < 131; ++k) {
    limitedProblem(source, ordinary());
    randomOptions(source);
  }
  const TickProblem problem = limitedProblem(source, ordinary());
  const WeightedQpOptions options = randomOptions(source);
  const TickSolution own = solve(problem, options, Solver::active_set);
  const TickSolution other = solve(problem, options, Solver::ipopt);
  ASSERT_EQ(other.status, Status::ok);
  if (own.status == Status::ok) {
    EXPECT_LE(test::inverseMassNorm(problem, own.torque - other.torque),
              solver_tolerance * test::inverseMassNorm(problem, own.torque));
  }
}

TEST(WeightedQp, AnswersKeepEveryConstraint) {
  for (const Solver solver : solvers) {
    ProblemSource source(14);
    test::MetShapes shapes;
    int cones = 0;
    for (int problems = 0; problems < 150; ++problems) {
      const TickProblem problem = limitedProblem(source, ordinary());
      shapes.add(problem);
      const TickSolution solution = solve(problem, randomOptions(source), solver);
      ASSERT_EQ(solution.status, Status::ok) << solution.message;
      // τ_s is what is left of the torque without the contact forces.
      Eigen::VectorXd rest = solution.torque;
      int force = 0;
      double size = test::inverseMassNorm(problem, solution.torque);
      for (const TickTask& task : problem.levels[0].tasks)
        for (int r = 0; r < task.rows; ++r, ++force) {
          if (!task.friction && task.force[r] < 0) continue;       // backing off: its torque belongs to τ_s
          const Eigen::VectorXd push = solution.contact_forces[force] * task.jacobian.row(r).transpose();
          rest -= push;
          size += test::inverseMassNorm(problem, push);
          if (task.friction && r % 3 != 0) continue;
          EXPECT_GE(solution.contact_forces[force], -1e-6 * size);
          EXPECT_LE(solution.contact_forces[force], task.force_max + 1e-6 * size);
          if (!task.friction) continue;
          ++cones;
          EXPECT_LE(std::hypot(solution.contact_forces[force + 1], solution.contact_forces[force + 2]),
                    *task.friction * solution.contact_forces[force] + 1e-6 * size);
        }
      EXPECT_EQ(force, solution.n_contact_forces);
      for (std::size_t i = 0; i < problem.levels.size(); ++i)
        for (const TickTask& task : problem.levels[i].tasks) {
          if (task.relation == Relation::equality && !task.contact) continue;
          const Eigen::VectorXd a = test::unitAcceleration(problem, task.J(), rest);
          for (int r = 0; r < task.rows; ++r) {
            EXPECT_LE(a[r], 1e-6 * size);
            if (task.relation == Relation::equality && (task.friction || task.force[r] >= 0)) {
              EXPECT_GE(a[r], -1e-6 * size);
            }
          }
        }
      if (!problem.torque_limits) continue;
      EXPECT_LE((solution.torque - problem.torque_limits->upper).maxCoeff(), 1e-6 * size);
      EXPECT_LE((problem.torque_limits->lower - solution.torque).maxCoeff(), 1e-6 * size);
    }
    EXPECT_GE(cones, 10);
    shapes.expectWide();
  }
}

// Without inequalities the acceleration objective is an ordinary least-squares problem.
TEST(WeightedQp, AccelerationObjectiveIsTheStatedSum) {
  ProblemSource source(15);
  for (int problems = 0; problems < 100; ++problems) {
    RandomProblemOptions shape = ordinary();
    shape.max_levels = 4;
    shape.inequality_share = 0;
    shape.max_log10_condition = 2;
    TickProblem problem = source.problem(shape);
    if (source.chance(0.5)) problem.levels[1].weight = 0.3;
    WeightedQpOptions options;
    if (problems % 2) options.metric = Metric::inertia;
    const Eigen::LDLT<Eigen::MatrixXd> M(problem.mass_matrix);
    const Eigen::MatrixXd inverse = M.solve(Eigen::MatrixXd::Identity(problem.dof, problem.dof));
    double weight = 1;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(problem.dof, problem.dof);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(problem.dof);
    double least = 1;
    for (std::size_t i = 0; i < problem.levels.size(); ++i) {
      if (i > 0) weight /= options.weight_ratio;
      weight = problem.levels[i].weight.value_or(weight);
      least = std::min(least, weight);
      Eigen::VectorXd own = Eigen::VectorXd::Zero(problem.dof);
      for (const TickTask& task : problem.levels[i].tasks) own += task.J().transpose() * task.F();
      for (const TickTask& task : problem.levels[i].tasks) {
        const Eigen::MatrixXd A = task.J() * inverse;
        const Eigen::VectorXd a = task.has_acceleration ? Eigen::VectorXd(task.acceleration) : Eigen::VectorXd(A * own);
        Eigen::MatrixXd weights = weight * Eigen::MatrixXd::Identity(task.rows, task.rows);
        if (options.metric == Metric::inertia)
          weights.diagonal().array() /= (A * task.J().transpose()).diagonal().array();
        H += A.transpose() * weights * A;
        g += A.transpose() * weights * a;
      }
    }
    H += options.regularisation * least * inverse;
    const TickSolution solution = solve(problem, options, Solver::nlopt);
    // The gradient vanishes, in units of what its terms are.
    EXPECT_LE((H * solution.torque - g).norm(), 1e-7 * g.norm());
  }
}

// A task in millimetres is the same task.
TEST(WeightedQp, TheInertiaMetricDoesNotSeeUnits) {
  ProblemSource source(18);
  int seen_by_identity = 0;
  for (int problems = 0; problems < 100; ++problems) {
    RandomProblemOptions shape = ordinary();
    shape.max_levels = 4;
    shape.max_log10_condition = 2;
    const TickProblem problem = source.problem(shape);
    TickProblem scaled = problem;
    for (control::TickLevel& level : scaled.levels)
      for (TickTask& task : level.tasks)
        for (int r = 0; r < task.rows; ++r) {
          const double unit = std::pow(10, source.uniform(-1, 1));
          task.jacobian.row(r) *= unit;
          task.force[r] /= unit;
          task.acceleration[r] *= unit;
        }
    const auto change = [&](Metric metric) {
      const WeightedQpOptions options{.metric = metric};
      const Eigen::VectorXd torque = solve(problem, options, Solver::nlopt).torque;
      return test::inverseMassNorm(problem, solve(scaled, options, Solver::nlopt).torque - torque) /
             test::inverseMassNorm(problem, torque);
    };
    EXPECT_LE(change(Metric::inertia), 1e-6);
    seen_by_identity += change(Metric::identity) > 1e-2;
  }
  EXPECT_GE(seen_by_identity, 50);
}

TEST(WeightedQp, WeightsRankTasksInTheAccelerationObjectiveOnly) {
  TickProblem problem;
  problem.dof = 2;
  problem.mass_matrix.setIdentity(2, 2);
  TickTask up("up", 1, 2), down("down", 1, 2);
  up.rows = down.rows = 1;
  up.jacobian << 1, 0;
  up.force << 1;
  down.jacobian << 1, 0;
  down.force << -1;
  problem.levels = {{1, 1.0, {up}}, {2, 0.01, {down}}};
  // (1·1 − 0.01·1)/(1.01 + w_r)
  EXPECT_NEAR(solve(problem, {}, Solver::ipopt).torque[0], 0.99 / 1.0101, 1e-9);
  EXPECT_NEAR(solve(problem, {.objective = Objective::torque}, Solver::ipopt).torque[0], 0, 1e-9);
}

TEST(WeightedQp, AContactThatBacksOffIsAnInequalityWithItsForceInTheTask) {
  TickProblem problem;
  problem.dof = 2;
  problem.mass_matrix.setIdentity(2, 2);
  TickTask contact("contact", 1, 2), push("push", 2, 2);
  contact.contact = true;
  contact.rows = 1;
  contact.jacobian << 1, 0;
  contact.force << -2;
  push.rows = 2;
  push.jacobian.setIdentity();
  push.force << 3, 1;
  problem.levels = {{1, {}, {contact}}, {2, {}, {push}}};
  const WeightedQpOptions torque{.objective = Objective::torque};
  for (const Solver solver : solvers) {
    const TickSolution pressed = solve(problem, torque, solver);    // −2 + 3 would press
    EXPECT_LE((pressed.torque - Eigen::Vector2d(0, 1)).norm(), 1e-9);
    EXPECT_EQ(pressed.rows_held, 1);
    ASSERT_EQ(pressed.levels[0].active.size(), 1u);
    EXPECT_EQ(pressed.contact_forces[0], -2);
    problem.levels[1].tasks[0].force[0] = 0.5;
    EXPECT_LE((solve(problem, torque, solver).torque - Eigen::Vector2d(-1.5, 1)).norm(), 1e-8);
    problem.levels[1].tasks[0].force[0] = 3;
  }
}

TEST(WeightedQp, ContradictionsAreSaidAndLeaveAFiniteTorqueWithinLimits) {
  ProblemSource source(16);
  for (const Solver solver : solvers)
    for (int k = 0; k < 20; ++k) {
      TickProblem problem = source.contactProblem(ordinary());
      // Every joint held by an equality contact, and limits that leave out zero beyond what the forces may do.
      TickTask all("all", problem.dof, problem.dof);
      all.contact = true;
      all.rows = problem.dof;
      all.jacobian.setIdentity();
      all.force_max = 1;
      problem.levels[0].tasks = {all};
      problem.torque_limits = control::TorqueLimits{Eigen::VectorXd::Constant(problem.dof, 2),
                                                    Eigen::VectorXd::Constant(problem.dof, 3), {}};
      const TickSolution solution = solve(problem, {}, solver);
      EXPECT_EQ(solution.status, Status::infeasible);
      EXPECT_EQ(solution.message, "torque limits, force bounds and rows contradict each other");
      EXPECT_TRUE((solution.torque.array() >= 2).all() && (solution.torque.array() <= 3).all());
    }
}

TEST(WeightedQp, ASolverThatLiesIsNotTrusted) {
  class Liar final : public QpSolver {
    SolverReport doSolve(const LeastDistanceProgramme&, Eigen::VectorXd& v) override {
      v.setConstant(1e3);
      return {"success", 1};
    }
  };
  ProblemSource source(17);
  const TickProblem problem = source.contactProblem(ordinary());
  QpBackEnd back_end({}, makeReferenceSolver(std::make_unique<Liar>(), false));
  TickSolution solution;
  back_end.prepare(problem, solution);
  back_end.solve(problem, solution);
  EXPECT_EQ(solution.status, Status::failed);
  EXPECT_EQ(solution.message, "the solver's answer is not optimal (success)");
  EXPECT_TRUE(solution.torque.allFinite());
}

TEST(WeightedQp, NumbersWhoseSquaresOverflowAreRefused) {
  ProblemSource source(20);
  for (const Solver solver : solvers)
    for (int k = 0; k < 20; ++k) {
      TickProblem problem = source.contactProblem(ordinary());
      problem.torque_limits = source.limits(problem.dof, 1);
      problem.levels.back().tasks[0].has_acceleration = true;
      problem.levels.back().tasks[0].acceleration.setConstant(10);
      problem.levels.back().weight = 1e308;
      const TickSolution solution = solve(problem, {}, solver);
      EXPECT_EQ(solution.status, Status::failed);
      EXPECT_EQ(solution.message, "weights, units and masses together make numbers that are too large to work with");
      EXPECT_TRUE((solution.torque.array() <= problem.torque_limits->upper.array()).all());
      EXPECT_TRUE((solution.torque.array() >= problem.torque_limits->lower.array()).all());
    }
}

TEST(WeightedQp, DegenerateProblemsStayFinite) {
  for (const Solver solver : solvers)
    for (const Objective objective : {Objective::torque, Objective::acceleration}) {
      const WeightedQpOptions options{.objective = objective};
      TickProblem problem;
      problem.dof = 3;
      problem.mass_matrix.setIdentity(3, 3);
      EXPECT_LE(solve(problem, options, solver).torque.norm(), 1e-12);  // no levels

      problem.levels = {{1, {}, {}}, {2, {}, {TickTask("none", 0, 3), TickTask("unused", 4, 3)}}};
      EXPECT_LE(solve(problem, options, solver).torque.norm(), 1e-12);  // no rows

      TickTask zero("zero", 2, 3);
      zero.contact = true;
      zero.rows = 2;
      zero.force << 1, 1;
      TickTask opposed("opposed", 5, 3);
      opposed.relation = Relation::inequality;
      opposed.rows = 5;
      opposed.jacobian << 1, 0, 0, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0;
      TickTask push("push", 3, 3);
      push.rows = 3;
      push.jacobian.setIdentity();
      push.force << 1, 2, 3;
      problem.levels = {{1, {}, {zero, opposed}}, {2, 1.0, {push}}};
      const TickSolution held = solve(problem, options, solver);
      EXPECT_EQ(held.status, Status::ok) << held.message;
      EXPECT_LE(held.torque.head(2).norm(), 1e-9);
      EXPECT_NEAR(held.torque[2], 3, 0.05);

      problem.levels[1].tasks[0].force[1] = std::numeric_limits<double>::infinity();
      const TickSolution broken = solve(problem, options, solver);
      EXPECT_EQ(broken.status, Status::failed);
      EXPECT_TRUE(broken.torque.allFinite());
    }
}

}  // namespace
}  // namespace tactus::qp
