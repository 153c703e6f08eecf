// Laws 1, 2 and 6 of the cascade on random problems, rank-deficient ones included; the exact projection against brute
// force; continuity; degenerate problems.  The laws count what they met and fail when too little was met.
// Law 3, which compares with the weighted QP, stands in weighted_qp_test.cc; memory in allocation_test.cc.
#include "plugins/null-space/null_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "tests/plugins/met_shapes.h"
#include "tests/plugins/random_problem.h"

namespace tactus::null_space {
namespace {

using control::Relation;
using control::Status;
using control::TickLevel;
using control::TickProblem;
using control::TickSolution;
using control::TickTask;
using test::ProblemSource;
using test::RandomProblemOptions;

constexpr double law_tolerance = 1e-9;                             // relative to ‖row‖ ‖τ‖ in the M⁻¹ metric
constexpr int problems_per_law = 1000;

// Many rows in few joints, which press in similar directions: rows that are held on the way must be released.
RandomProblemOptions crowded() { return {.max_dof = 20, .inequality_share = 0.6, .copy_share = 0.1, .max_rows = 6}; }

// In turn: any tasks, crowded ones, and up to 20 contact rows above any tasks.
TickProblem anyProblem(ProblemSource& source, int turn) {
  if (turn % 3 == 2) return source.contactProblem({}, 0.2);
  return source.problem(turn % 3 == 1 ? crowded() : RandomProblemOptions{});
}

TickSolution solve(const TickProblem& problem, const NullSpaceOptions& options) {
  NullSpace back_end(options);
  TickSolution solution;
  back_end.prepare(problem, solution);
  back_end.solve(problem, solution);
  return solution;
}

// Far enough from the default fade (1e-8 … 1e-6) that no direction is faded and no rank is decided by rounding.
bool noFade(const TickProblem& problem) { return test::denseRanks(problem, 1e-9, 1e-5).clear; }

struct Met {
  int problems = 0;
  int deficient = 0;
  int held = 0;
  int released = 0;
  test::MetShapes shapes;

  void add(const TickProblem& problem, const TickSolution& solution) {
    ++problems;
    shapes.add(problem);
    deficient += solution.rank_deficient_levels > 0;
    held += solution.rows_held;
    released += solution.rows_released;
  }
};

// Largest change that the levels below i make to the unit rows of level i; signed for inequality rows.
double worstChange(const TickProblem& problem, const NullSpaceOptions& options, int i, Relation relation,
                   const Eigen::VectorXd& torque) {
  const Eigen::MatrixXd rows = test::stackedRows(problem, i, relation);
  if (rows.rows() == 0) return 0;
  const Eigen::VectorXd alone = solve(test::topLevels(problem, i + 1), options).torque;
  const Eigen::VectorXd change = test::unitAcceleration(problem, rows, torque - alone);
  const double size = test::inverseMassNorm(problem, torque) + test::inverseMassNorm(problem, alone);
  return (relation == Relation::equality ? change.cwiseAbs().maxCoeff() : change.maxCoeff()) / size;
}

TEST(NullSpace, Law1And2HoldForAllLevelsInTheAugmentedCascade) {
  ProblemSource source(1);
  Met met;
  while (met.problems < problems_per_law) {
    const TickProblem problem = anyProblem(source, met.problems);
    if (!noFade(problem)) continue;
    const NullSpaceOptions options;
    const TickSolution solution = solve(problem, options);
    ASSERT_EQ(solution.status, Status::ok) << solution.message;
    ASSERT_TRUE(solution.torque.allFinite());
    met.add(problem, solution);
    for (int i = 0; i < static_cast<int>(problem.levels.size()); ++i) {
      EXPECT_LE(worstChange(problem, options, i, Relation::equality, solution.torque), law_tolerance);
      EXPECT_LE(worstChange(problem, options, i, Relation::inequality, solution.torque), law_tolerance);
    }
  }
  std::cout << "met: " << met.deficient << " rank-deficient problems, " << met.held << " rows held, " << met.released
            << " rows released in " << met.problems << " problems\n";
  EXPECT_GE(met.deficient, problems_per_law / 2);
  EXPECT_GE(met.held, problems_per_law);
  EXPECT_GE(met.released, 50);
  met.shapes.expectWide(0.06);
}

TEST(NullSpace, Law1And2HoldForLevel1InTheSuccessiveCascadeAndNotBelow) {
  ProblemSource source(2);
  Met met;
  int disturbed = 0;
  while (met.problems < problems_per_law) {
    const TickProblem problem = anyProblem(source, met.problems);
    if (!noFade(problem)) continue;
    const NullSpaceOptions options{.cascade = Cascade::successive};
    const TickSolution solution = solve(problem, options);
    ASSERT_EQ(solution.status, Status::ok) << solution.message;
    met.add(problem, solution);
    EXPECT_LE(worstChange(problem, options, 0, Relation::equality, solution.torque), law_tolerance);
    EXPECT_LE(worstChange(problem, options, 0, Relation::inequality, solution.torque), law_tolerance);
    for (int i = 1; i + 1 < static_cast<int>(problem.levels.size()); ++i)
      disturbed += worstChange(problem, options, i, Relation::equality, solution.torque) > 1e-3;
  }
  EXPECT_GE(met.deficient, problems_per_law / 2);
  EXPECT_GE(met.held, problems_per_law / 2);
  EXPECT_GE(met.released, 20);
  met.shapes.expectWide(0.06);
  EXPECT_GE(disturbed, 100) << "the successive cascade is strict for level 1 only; lower levels must show it";
}

TEST(NullSpace, Law2IsBrokenAtTimesByOnePassAndLaw1Is) {
  ProblemSource source(3);
  RandomProblemOptions shape;                                      // the thesis's size: 16 joints, contacts only
  shape.min_dof = shape.max_dof = 16;
  shape.min_levels = shape.max_levels = 2;
  shape.max_log10_condition = 2;
  shape.max_tasks = 4;
  shape.copy_share = shape.combination_share = shape.common_direction = 0;
  int problems = 0;
  int broken = 0;
  while (problems < problems_per_law) {
    const TickProblem problem = source.problem(shape);
    if (test::stackedRows(problem, 0, Relation::inequality).rows() < 2 || !noFade(problem)) continue;
    ++problems;
    const NullSpaceOptions options{.inequalities = Inequalities::one_pass};
    const TickSolution solution = solve(problem, options);
    EXPECT_LE(worstChange(problem, options, 0, Relation::equality, solution.torque), law_tolerance);
    broken += worstChange(problem, options, 0, Relation::inequality, solution.torque) > 1e-6;
  }
  const double share = static_cast<double>(broken) / problems;
  RecordProperty("one_pass_violation_share", std::to_string(share));
  std::cout << "one-pass leaves a row violated in " << 100 * share << " % of " << problems << " problems\n";
  EXPECT_GT(share, 0.1);
  EXPECT_LT(share, 0.7);
}

TEST(NullSpace, Law6TheOrderOfTasksAndRowsChangesNothing) {
  for (const Cascade cascade : {Cascade::augmented, Cascade::successive})
    for (const Inequalities inequalities : {Inequalities::exact, Inequalities::one_pass}) {
      ProblemSource source(4);
      Met met;
      while (met.problems < problems_per_law) {
        const TickProblem problem = anyProblem(source, met.problems);
        if (!noFade(problem)) continue;
        const NullSpaceOptions options{.cascade = cascade, .inequalities = inequalities};
        // Where Algorithm 3 finds a row that the torque hardly presses on, rounding decides.
        if (inequalities == Inequalities::one_pass) {
          bool close = false;
          for (std::size_t i = 0; i < problem.levels.size(); ++i) {
            const Eigen::MatrixXd rows = test::stackedRows(problem, static_cast<int>(i), Relation::inequality);
            for (std::size_t k = 0; k < problem.levels.size() && rows.rows() > 0; ++k) {
              Eigen::VectorXd own = Eigen::VectorXd::Zero(problem.dof);
              for (const TickTask& task : problem.levels[k].tasks) own += task.J().transpose() * task.F();
              const Eigen::VectorXd press = test::unitAcceleration(problem, rows, own);
              close |= press.cwiseAbs().minCoeff() < 1e-9 * test::inverseMassNorm(problem, own);
            }
          }
          if (close) continue;
        }
        TickProblem shuffled = problem;
        for (TickLevel& level : shuffled.levels) std::shuffle(level.tasks.begin(), level.tasks.end(), source.engine());
        const TickSolution a = solve(problem, options);
        const TickSolution b = solve(shuffled, options);
        met.add(problem, a);
        const double difference = test::inverseMassNorm(problem, a.torque - b.torque);
        EXPECT_LE(difference, law_tolerance * test::inverseMassNorm(problem, a.torque));
        for (std::size_t i = 0; i < a.levels.size(); ++i) EXPECT_EQ(a.levels[i].rank, b.levels[i].rank);
      }
      EXPECT_GE(met.deficient, problems_per_law / 2);
      EXPECT_GE(met.held, problems_per_law / 2);
      met.shapes.expectWide(0.06);
    }
}

TEST(NullSpace, RanksAndNullitiesAreThoseOfTheProjectedRows) {
  ProblemSource source(5);
  int problems = 0;
  while (problems < problems_per_law) {
    const TickProblem problem = anyProblem(source, problems);
    const test::DenseRanks dense = test::denseRanks(problem, 1e-9, 1e-5);
    if (!dense.clear) continue;
    ++problems;
    for (const Cascade cascade : {Cascade::augmented, Cascade::successive}) {
      const TickSolution solution = solve(problem, {.cascade = cascade});
      int nullity = problem.dof;
      for (std::size_t i = 0; i < solution.levels.size(); ++i) {
        nullity -= dense.ranks[i];
        EXPECT_EQ(solution.levels[i].rank, dense.ranks[i]);
        EXPECT_EQ(solution.levels[i].nullity, nullity);
      }
    }
  }
}

TEST(NullSpace, ResidualIsTheAccelerationMissedByTheLevel) {
  ProblemSource source(6);
  for (int k = 0; k < 50; ++k) {
    TickProblem problem = source.problem({.inequality_share = 0});
    const TickSolution solution = solve(problem, {});
    const Eigen::LLT<Eigen::MatrixXd> M(problem.mass_matrix);
    for (std::size_t i = 0; i < problem.levels.size(); ++i) {
      Eigen::VectorXd own = Eigen::VectorXd::Zero(problem.dof);
      for (const TickTask& task : problem.levels[i].tasks) own += task.J().transpose() * task.F();
      double sum = 0;
      double size = 0;
      for (const TickTask& task : problem.levels[i].tasks) {
        const Eigen::VectorXd wanted =
            task.has_acceleration ? Eigen::VectorXd(task.acceleration.head(task.rows)) : task.J() * M.solve(own);
        sum += (task.J() * M.solve(solution.torque) - wanted).squaredNorm();
        size += (task.J() * M.solve(solution.torque)).squaredNorm() + wanted.squaredNorm();
      }
      EXPECT_NEAR(solution.levels[i].residual, std::sqrt(sum), 1e-8 * std::sqrt(size));
    }
  }
}

// One equality level, one inequality level of up to six rows, one torque below: every subset of rows held as
// equalities is tried, and the nearest point that keeps all rows wins.
struct SmallProblem {
  TickProblem problem;
  Eigen::VectorXd expected;                                        // the projected torque of the last level
};

SmallProblem smallProblem(ProblemSource& source) {
  SmallProblem small;
  TickProblem& problem = small.problem;
  problem.dof = source.integer(4, 9);
  problem.mass_matrix = source.massMatrix(problem.dof, 2);
  TickTask held("held", source.integer(1, 2), problem.dof);
  held.rows = held.capacity();
  held.jacobian = source.gaussian(held.rows, problem.dof);
  TickTask bounded("bounded", source.integer(1, 6), problem.dof);
  bounded.relation = Relation::inequality;
  bounded.rows = bounded.capacity();
  // Rows that lie nearly in three dimensions get in each other's way.
  bounded.jacobian = 5 * source.gaussian(bounded.rows, 3) * source.gaussian(3, problem.dof) +
                     source.gaussian(bounded.rows, problem.dof);
  if (bounded.rows > 3) bounded.jacobian.row(3) = 2 * bounded.jacobian.row(0) + bounded.jacobian.row(1);
  TickTask push("push", problem.dof, problem.dof);
  push.rows = problem.dof;
  push.jacobian.setIdentity();
  push.force = source.gaussian(problem.dof, 1);
  problem.levels = {{1, {}, {held, bounded}}, {2, {}, {push}}};

  const Eigen::MatrixXd E = test::unitRows(problem, held.jacobian);
  const Eigen::MatrixXd I = test::unitRows(problem, bounded.jacobian);
  const Eigen::VectorXd y = problem.mass_matrix.llt().matrixL().solve(push.force);
  double nearest = std::numeric_limits<double>::infinity();
  Eigen::VectorXd best;
  for (int subset = 0; subset < 1 << bounded.rows; ++subset) {
    Eigen::MatrixXd rows = E;
    for (int j = 0; j < bounded.rows; ++j)
      if (subset >> j & 1) {
        rows.conservativeResize(rows.rows() + 1, problem.dof);
        rows.bottomRows(1) = I.row(j);
      }
    const Eigen::VectorXd point = y - rows.completeOrthogonalDecomposition().solve(rows * y);
    if ((I * point).maxCoeff() > 1e-10 * y.norm() || (point - y).norm() >= nearest) continue;
    nearest = (point - y).norm();
    best = point;
  }
  small.expected = problem.mass_matrix.llt().matrixL() * best;
  return small;
}

TEST(NullSpace, ExactProjectionIsTheNearestTorqueThatKeepsEveryRow) {
  ProblemSource source(7);
  Met met;
  for (int k = 0; k < 500; ++k) {
    const SmallProblem small = smallProblem(source);
    const TickSolution solution = solve(small.problem, {});
    met.add(small.problem, solution);
    EXPECT_LE(test::inverseMassNorm(small.problem, solution.torque - small.expected),
              1e-9 * test::inverseMassNorm(small.problem, small.problem.levels[1].tasks[0].force));
  }
  EXPECT_GE(met.held, 300);
  EXPECT_GE(met.released, 30);
}

TEST(NullSpace, WithoutReleasingRowsTheProjectionIsWrong) {
  ProblemSource source(7);
  int wrong = 0;
  int law_2_kept = 0;
  for (int k = 0; k < 500; ++k) {
    const SmallProblem small = smallProblem(source);
    const NullSpaceOptions options{.release_rows = false};
    const TickSolution solution = solve(small.problem, options);
    EXPECT_EQ(solution.rows_released, 0);
    wrong += test::inverseMassNorm(small.problem, solution.torque - small.expected) >
             1e-6 * test::inverseMassNorm(small.problem, small.problem.levels[1].tasks[0].force);
    law_2_kept += worstChange(small.problem, options, 0, Relation::inequality, solution.torque) <= law_tolerance;
  }
  EXPECT_GE(wrong, 20) << "taking the release step out must show";
  EXPECT_GE(law_2_kept, 450) << "it only over-constrains";
}

// Two contacts on one link whose rows turn into each other and out again: without a fade the torque jumps.
TickProblem nearlyParallelRows(double angle) {
  TickProblem problem;
  problem.dof = 3;
  problem.mass_matrix = Eigen::Matrix3d::Identity();
  TickTask contacts("contacts", 2, 3);
  contacts.rows = 2;
  contacts.jacobian << 1, 0, 0, std::cos(angle), std::sin(angle), 0;
  TickTask push("push", 3, 3);
  push.rows = 3;
  push.jacobian.setIdentity();
  push.force << 1, 2, 3;
  problem.levels = {{1, {}, {contacts}}, {2, {}, {push}}};
  return problem;
}

double largestStep(const NullSpaceOptions& options, double step) {
  double largest = 0;
  Eigen::VectorXd before = solve(nearlyParallelRows(0), options).torque;
  for (double angle = step; angle < 0.3; angle += step) {
    const Eigen::VectorXd now = solve(nearlyParallelRows(angle), options).torque;
    largest = std::max(largest, (now - before).norm());
    before = now;
  }
  return largest;
}

TEST(NullSpace, TheTorqueIsContinuousAcrossASingularityThatIsFaded) {
  const NullSpaceOptions faded{.rank = {.rank_tolerance = 0.01, .fade = 0.1}};
  const NullSpaceOptions cut{.rank = {.rank_tolerance = 0.05, .fade = 0.05}};
  // ‖push‖ times the steepest slope of the smoothstep, 1.5/(fade − tolerance), and dσ/dangle ≤ 1/√2.
  const double slope = std::sqrt(14) * 1.5 / 0.09 / std::sqrt(2);
  // … and twice ‖push‖ for the directions, which turn with the angle.
  for (const double step : {1e-3, 1e-4}) EXPECT_LE(largestStep(faded, step), (1.1 * slope + 2 * std::sqrt(14)) * step);
  EXPECT_GE(largestStep(cut, 1e-4), 1);
}

TEST(NullSpace, FadingALowerLevelNeverReachesLevel1) {
  ProblemSource source(8);
  int faded = 0;
  for (int k = 0; k < 200; ++k) {
    TickProblem problem = source.problem({.min_levels = 4, .inequality_share = 0.2, .max_log10_condition = 2});
    const NullSpaceOptions options{.rank = {.rank_tolerance = 0.05, .fade = 0.6}};
    // Level 1 a single row, σ = 1, so that it alone is not faded.
    problem.levels[0].tasks.resize(1);
    TickTask& top = problem.levels[0].tasks[0];
    top.relation = Relation::equality;
    top.rows = 1;
    const TickSolution solution = solve(problem, options);
    ASSERT_EQ(solution.status, Status::ok);
    faded += solution.rank_deficient_levels > 0;
    EXPECT_LE(worstChange(problem, options, 0, Relation::equality, solution.torque), law_tolerance);
  }
  EXPECT_GE(faded, 100);
}

TEST(NullSpace, ScalesTheTorqueUniformlyIntoTheLimits) {
  TickProblem problem = nearlyParallelRows(1);
  const Eigen::VectorXd free = solve(problem, {}).torque;
  problem.torque_limits = control::TorqueLimits{Eigen::VectorXd::Constant(3, -1), Eigen::VectorXd::Constant(3, 1), {}};
  const TickSolution limited = solve(problem, {});
  EXPECT_EQ(limited.status, Status::ok);
  EXPECT_NEAR(limited.scale, 1 / free.cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE((limited.torque - limited.scale * free).norm(), 1e-12);

  problem.torque_limits->lower.setConstant(5);                     // gravity alone is too much
  problem.torque_limits->upper.setConstant(6);
  const TickSolution impossible = solve(problem, {});
  EXPECT_EQ(impossible.status, Status::infeasible);
  EXPECT_EQ(impossible.message, "no multiple of the torque lies within the torque limits");
  EXPECT_TRUE((impossible.torque.array() >= 5).all() && (impossible.torque.array() <= 6).all());
}

TEST(NullSpace, ATorqueThatOverflowsIsNone) {
  ProblemSource source(10);
  int failed = 0;
  for (const Cascade cascade : {Cascade::augmented, Cascade::successive, Cascade::consistent})
    for (int k = 0; k < 100; ++k) {
      TickProblem problem = source.contactProblem({.max_dof = 12});
      TickTask& task = problem.levels.back().tasks[0];
      task.relation = Relation::equality;
      for (double& force : task.force) force *= std::pow(10, source.uniform(100, 305));
      task.jacobian *= std::pow(10, source.uniform(-160, 160));
      if (k % 2) problem.torque_limits = source.limits(problem.dof, 1);
      const TickSolution solution = solve(problem, {.cascade = cascade});
      EXPECT_TRUE(solution.torque.allFinite());
      failed += solution.status == Status::failed;
      EXPECT_EQ(solution.message.empty(), solution.status == Status::ok);
    }
  EXPECT_GE(failed, 50);
}

TEST(NullSpace, DegenerateProblemsStayFinite) {
  const NullSpaceOptions all[] = {{},
                                  {.cascade = Cascade::successive},
                                  {.inequalities = Inequalities::one_pass},
                                  {.cascade = Cascade::successive, .inequalities = Inequalities::one_pass}};
  ProblemSource source(9);
  for (const NullSpaceOptions& options : all) {
    TickProblem problem;
    problem.dof = 3;
    problem.mass_matrix.setIdentity(3, 3);
    EXPECT_EQ(solve(problem, options).torque, Eigen::VectorXd::Zero(3));  // no levels

    problem.levels = {{1, {}, {}}, {2, {}, {TickTask("none", 0, 3), TickTask("unused", 4, 3)}}};
    EXPECT_EQ(solve(problem, options).torque, Eigen::VectorXd::Zero(3));  // no rows

    TickTask zero("zero", 2, 3);
    zero.rows = 2;
    zero.force << 1, 1;
    TickTask push("push", 3, 3);
    push.rows = 3;
    push.jacobian.setIdentity();
    push.force << 1, 2, 3;
    problem.levels = {{1, {}, {zero}}, {2, {}, {push}}};
    EXPECT_EQ(solve(problem, options).torque, push.force);                // rows without effect hold nothing

    TickTask opposed("opposed", 6, 3);
    opposed.relation = Relation::inequality;
    opposed.rows = 6;
    opposed.jacobian << 1, 0, 0, -1, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, -1, 0;
    problem.levels = {{1, {}, {opposed}}, {2, {}, {push}}};
    const TickSolution held = solve(problem, options);
    EXPECT_EQ(held.status, Status::ok);
    EXPECT_LE((held.torque - Eigen::Vector3d(0, 0, 3)).norm(), 1e-12);    // opposed rows leave no way

    problem.levels[1].tasks[0].force[1] = std::numeric_limits<double>::quiet_NaN();
    const TickSolution broken = solve(problem, options);
    EXPECT_EQ(broken.status, Status::failed);
    EXPECT_TRUE(broken.torque.allFinite());

    problem.levels[1].tasks[0].force[1] = 2;
    problem.mass_matrix(2, 2) = -1;
    const TickSolution indefinite = solve(problem, options);
    EXPECT_EQ(indefinite.status, Status::failed);
    EXPECT_EQ(indefinite.message, "the mass matrix is not positive definite, or a Jacobian or force is not finite");
    EXPECT_TRUE(indefinite.torque.allFinite());
  }
}

}  // namespace
}  // namespace tactus::null_space
