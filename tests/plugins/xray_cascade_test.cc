// What the x-ray says that a cascade left of each task's torque adds up to the cascade's own answer, in all variants.
#include <gtest/gtest.h>

#include "framework/control/xray.h"
#include "plugins/null-space/null_space.h"
#include "tests/plugins/random_problem.h"

namespace tactus::null_space {
namespace {

TEST(XrayOfTheCascade, TorquesByTaskAddUpToTheAnswer) {
  test::ProblemSource source(11);
  test::RandomProblemOptions options;
  options.max_dof = 14;
  options.max_log10_condition = 2;
  options.max_log10_scale = 1;
  options.acceleration_share = 0;
  int found = 0, inequalities = 0;
  for (int k = 0; k < 80; ++k) {
    control::TickProblem problem = source.problem(options);
    if (!test::denseRanks(problem, 1e-9, 1e-5).clear) continue;
    if (source.chance(0.5)) problem.torque_limits = source.limits(problem.dof, 1);
    for (const Cascade cascade : {Cascade::augmented, Cascade::successive}) {
      for (const Inequalities way : {Inequalities::exact, Inequalities::one_pass}) {
        NullSpace back_end({.cascade = cascade, .inequalities = way});
        control::TickSolution solution;
        back_end.prepare(problem, solution);
        back_end.solve(problem, solution);
        if (solution.status != control::Status::ok) continue;
        const control::Xray xray = control::xray(problem, solution);
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(problem.dof);
        for (const control::TaskXray& task : xray.tasks) {
          ASSERT_TRUE(task.torque_left);
          sum += *task.torque_left;
        }
        EXPECT_LT((sum - solution.torque).norm(), 1e-5 * (solution.torque.norm() + 1e-12));
        ++found;
        inequalities += solution.rows_held > 0;
      }
    }
  }
  EXPECT_GT(found, 100);
  EXPECT_GT(inequalities, 50);
}

}  // namespace
}  // namespace tactus::null_space
