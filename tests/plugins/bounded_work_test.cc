// Law 9 of the cascades and of the weighted QP: whatever the problem and however short the deadline, the torque is finite
// and within the limits.  The hierarchy's stands in hqp_test.cc.
#include <gtest/gtest.h>

#include <functional>
#include <iostream>
#include <memory>

#include "plugins/null-space/null_space.h"
#include "plugins/qp/solvers.h"
#include "tests/plugins/met_shapes.h"
#include "tests/plugins/random_problem.h"

namespace tactus {
namespace {

using control::Status;
using test::ProblemSource;

/// `most_failed`: weights of up to six levels, masses of condition 1e6 and units 1e6 apart leave some weighted
/// programmes without a digit; those must say so.  Most of them leave their limits by a tenth of the torque: in the
/// coordinates in which the programme is round a limit is smaller than what the solver takes for rounding, and an
/// answer refined against the programme as it was given is no better.  The metric `inertia` sees no units: of a
/// thousand it leaves 35.
void expectBoundedWork(const std::function<std::unique_ptr<control::BackEnd>()>& make, unsigned seed, int most_failed) {
  ProblemSource source(seed);
  test::MetShapes shapes;
  int ok = 0, infeasible = 0, late = 0, failed = 0;
  for (int k = 0; k < 1000; ++k) {
    control::TickProblem problem = source.contactProblem({.inequality_share = 0.4, .max_rows = 7}, 0.2, 0.3);
    shapes.add(problem);
    problem.torque_limits = source.limits(problem.dof, 1);
    if (source.chance(0.2)) {                                      // limits that leave out 0
      problem.torque_limits->lower.array() += 2;
      problem.torque_limits->upper.array() += 2;
    }
    const std::unique_ptr<control::BackEnd> back_end = make();
    control::TickSolution solution;
    back_end->prepare(problem, solution);
    if (source.chance(0.3)) back_end->setDeadline({.iterations = source.integer(0, 3)});
    if (k % 50 == 0) back_end->setDeadline({.seconds = 0});
    back_end->solve(problem, solution);
    ASSERT_TRUE(solution.torque.allFinite());
    const double rounding = 1e-9 * solution.torque.norm();
    EXPECT_LE((solution.torque - problem.torque_limits->upper).maxCoeff(), rounding);
    EXPECT_LE((problem.torque_limits->lower - solution.torque).maxCoeff(), rounding);
    EXPECT_EQ(solution.message.empty(), solution.status == Status::ok);
    ok += solution.status == Status::ok;
    infeasible += solution.status == Status::infeasible;
    late += solution.late;
    failed += solution.status == Status::failed && !solution.late;
  }
  std::cout << ok << " ok, " << infeasible << " infeasible, " << late << " late, " << failed << " failed\n";
  EXPECT_GE(ok, 300);
  EXPECT_GE(late, 20);
  EXPECT_LE(failed, most_failed);
  shapes.expectWide();
}

TEST(BoundedWork, OfTheCascades) {
  using null_space::Cascade;
  for (const Cascade cascade : {Cascade::augmented, Cascade::successive, Cascade::consistent})
    expectBoundedWork([=] { return std::make_unique<null_space::NullSpace>(
                                null_space::NullSpaceOptions{.cascade = cascade}); }, 71, 0);
}

TEST(BoundedWork, OfTheWeightedProgramme) {
  for (const qp::Objective objective : {qp::Objective::torque, qp::Objective::acceleration})
    expectBoundedWork([=] { return std::make_unique<qp::QpBackEnd>(qp::WeightedQpOptions{.objective = objective},
                                                                   qp::makeActiveSetSolver()); }, 72, 320);
}

}  // namespace
}  // namespace tactus
