// A solve of the own back ends takes no memory: counted on random problems of one shape whose rows come and go.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "plugins/hqp/hqp.h"
#include "plugins/null-space/null_space.h"
#include "plugins/qp/solvers.h"
#include "conformance/allocation_count.h"
#include "tests/plugins/random_problem.h"

namespace tactus::null_space {
namespace {

TEST(Allocation, TheCountSeesBothKindsOfMemory) {
  const long before = conformance::allocationCount();
  const auto one = std::make_unique<int>(1);
  const Eigen::VectorXd two(50);
  EXPECT_GE(conformance::allocationCount(), before + 2);
}

TEST(Allocation, ASolveOfTheCascadeTakesNone) {
  test::ProblemSource source(31);
  for (const Cascade cascade : {Cascade::augmented, Cascade::successive, Cascade::consistent})
    for (const Inequalities inequalities : {Inequalities::exact, Inequalities::one_pass})
      for (int k = 0; k < 100; ++k) {
        // A wide fade, so that singular directions are computed too.
        const control::RankOptions rank = k % 2 ? control::RankOptions{} : control::RankOptions{0.05, 0.5};
        control::TickProblem problem = source.problem({.max_rows = 8});
        if (k % 3 == 0) problem.torque_limits = source.limits(problem.dof, 1);
        NullSpace back_end({.cascade = cascade,
                            .inequalities = inequalities,
                            .rank = rank,
                            .objective = {.damping = k % 4 < 2 ? 0.0 : 0.1}});
        control::TickSolution solution;
        back_end.prepare(problem, solution);
        const long before = conformance::allocationCount();
        back_end.solve(problem, solution);
        for (control::TickLevel& level : problem.levels)
          for (control::TickTask& task : level.tasks) task.rows /= 2;
        back_end.solve(problem, solution);
        problem.mass_matrix(0, 0) = -1;
        back_end.solve(problem, solution);
        ASSERT_EQ(conformance::allocationCount(), before);
        EXPECT_EQ(solution.status, control::Status::failed);
      }
}

void expectNoAllocation(const std::function<std::unique_ptr<control::BackEnd>()>& make, unsigned seed) {
  test::ProblemSource source(seed);
  for (int k = 0; k < 200; ++k) {
    control::TickProblem problem = source.contactProblem({.max_levels = 4, .max_rows = 6}, 0.2, 0.3);
    if (k % 2 == 0) problem.torque_limits = source.limits(problem.dof, 1);
    if (k % 4 == 0) problem.torque_limits->priority = problem.levels.back().priority;
    const std::unique_ptr<control::BackEnd> back_end = make();
    control::TickSolution solution;
    back_end->prepare(problem, solution);
    if (k % 5 == 0) back_end->setDeadline({.iterations = 3});
    const long before = conformance::allocationCount();
    back_end->solve(problem, solution);
    for (control::TickLevel& level : problem.levels)
      for (control::TickTask& task : level.tasks)
        if (!task.friction) task.rows = (task.rows + 1) / 2;
    back_end->solve(problem, solution);
    back_end->solve(problem, solution);
    ASSERT_EQ(conformance::allocationCount(), before) << k;
  }
}

TEST(Allocation, ASolveOfTheHierarchyTakesNone) {
  expectNoAllocation([] { return std::make_unique<hqp::Hqp>(); }, 32);
  expectNoAllocation([] { return std::make_unique<hqp::Hqp>(hqp::HqpOptions{.objective = {.damping = 0.1}}); }, 32);
}

TEST(Allocation, ASolveByTheActiveSetTakesNone) {
  for (const qp::Objective objective : {qp::Objective::torque, qp::Objective::acceleration})
    expectNoAllocation(
        [=] {
          return std::make_unique<qp::QpBackEnd>(qp::WeightedQpOptions{.objective = objective},
                                                 qp::makeActiveSetSolver());
        },
        33);
}

}  // namespace
}  // namespace tactus::null_space
