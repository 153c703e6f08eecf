// A back end that the table's defaults make is the one that its options struct makes: the same torques to the bit, on
// random problems.

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "framework/control/registry.h"
#include "framework/runtime/plugin_loader.h"
#include "plugins/hqp/hqp.h"
#include "plugins/null-space/null_space.h"
#include "plugins/qp/solvers.h"
#include "tests/plugins/random_problem.h"

namespace tactus::test {
namespace {

using Make = std::function<std::unique_ptr<control::BackEnd>()>;

Eigen::VectorXd torqueOf(control::BackEnd& back_end, const control::TickProblem& problem) {
  control::TickSolution solution;
  back_end.prepare(problem, solution);
  back_end.solve(problem, solution);
  return solution.torque;
}

std::unique_ptr<control::BackEnd> byTable(const std::string& name, const std::map<std::string, std::string>& options) {
  control::Registry registry;
  runtime::PluginLoader(registry, {}, SHIPPED_PLUGINS).loadFolder(SHIPPED_PLUGINS);
  return registry.makeBackEnd(control::makeValues(*registry.elements().findBackEnd(name), options));
}

/// How many of the problems the two solve alike.
int alike(const std::string& name, const std::map<std::string, std::string>& options, const Make& make) {
  ProblemSource source(17);
  int count = 0;
  for (int k = 0; k < 20; ++k) {
    const control::TickProblem problem = source.contactProblem({.max_dof = 20, .max_levels = 3}, 0, 0.5);
    const auto table = byTable(name, options), own = make();
    count += torqueOf(*table, problem) == torqueOf(*own, problem);
  }
  return count;
}

TEST(Defaults, OfTheNullSpaceCascade) {
  const Make make = [] { return std::make_unique<null_space::NullSpace>(null_space::NullSpaceOptions()); };
  EXPECT_EQ(alike("null-space", {}, make), 20);
}

TEST(Defaults, OfTheHierarchicalProgramme) {
  EXPECT_EQ(alike("hqp", {}, [] { return std::make_unique<hqp::Hqp>(hqp::HqpOptions()); }), 20);
}

TEST(Defaults, OfTheWeightedProgramme) {
  const auto make = [](const qp::WeightedQpOptions& options) {
    return [=] { return std::make_unique<qp::QpBackEnd>(options, qp::makeActiveSetSolver()); };
  };
  EXPECT_EQ(alike("qp", {{"solver", "active-set"}}, make({})), 20);
  // Each option matters to these problems: another value gives other torques.
  using Set = void (*)(qp::WeightedQpOptions&);
  for (const Set set : {Set([](qp::WeightedQpOptions& options) { options.objective = qp::Objective::torque; }),
                        Set([](qp::WeightedQpOptions& options) { options.metric = qp::Metric::inertia; }),
                        Set([](qp::WeightedQpOptions& options) { options.weight_ratio *= 1.01; }),
                        Set([](qp::WeightedQpOptions& options) { options.force_weight *= 1.01; }),
                        Set([](qp::WeightedQpOptions& options) { options.regularisation *= 1.01; }),
                        Set([](qp::WeightedQpOptions& options) { options.friction_edges += 1; })}) {
    qp::WeightedQpOptions other;
    set(other);
    EXPECT_LT(alike("qp", {{"solver", "active-set"}}, make(other)), 20)
        << other.weight_ratio << " " << other.force_weight << " " << other.regularisation << " "
        << other.friction_edges;
  }
}

}  // namespace
}  // namespace tactus::test
