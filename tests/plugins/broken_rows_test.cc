// The measure `broken-rows`: figures by hand for a back end that projects nothing; on random rows, against a dense
// computation, for cascades that project by Algorithm 3 and exactly.

#include "tasks/broken_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "dsl/read_robot.h"
#include "framework/control/controller.h"
#include "framework/description/scene.h"
#include "plugins/null-space/null_space.h"
#include "tasks/register_tasks.h"
#include "tests/plugins/random_problem.h"
#include "tests/runtime/pendulum.h"

namespace tactus::tasks {
namespace {

using namespace control;
using null_space::Cascade;
using null_space::Inequalities;
using null_space::NullSpace;

class Scripted final : public Task {
 public:
  using Fill = std::function<void(TickTask&)>;
  Scripted(Relation relation, int capacity, Fill fill) : Task(relation, capacity), fill_(std::move(fill)) {}

 private:
  void doUpdate(const Tick&, TickTask& rows) override { fill_(rows); }
  Fill fill_;
};

/// An arm with two levels: `stop`, an inequality, and `push` below it.
struct Arm {
  using Maker = MeasureContext::BackEndMaker;
  Arm(Maker make, Scripted::Fill stop, Scripted::Fill push)
      : robot(read()), model(std::make_shared<dynamics::Model>(robot)) {
    registerBuiltIns(registry);
    values = makeValues(*registry.elements().find("broken-rows"), {{"name", "broken"}});
    std::vector<Level> levels(2);
    levels[0].priority = 1;
    levels[0].tasks.push_back({"stop", std::make_unique<Scripted>(Relation::inequality, 5, std::move(stop))});
    levels[1].priority = 2;
    levels[1].tasks.push_back({"push", std::make_unique<Scripted>(Relation::equality, 7, std::move(push))});
    controller = std::make_unique<Controller>(model, std::vector<NamedSignal>{}, std::move(levels), make(), 0.001,
                                              Eigen::Vector3d(0, 0, -9.81));
    const BuildContext context(values, robot, *model, 0.001, {});
    measure = registry.makeMeasure(MeasureContext(context, *controller, scene, sensed.q, make));
    sensed.q = Eigen::VectorXd::Constant(7, 0.3);
    sensed.qd = Eigen::VectorXd::Zero(7);
  }

  void tick() {
    const Eigen::VectorXd& torque = controller->tick(sensed);
    sensed.time += 0.001;
    measure->observe({sensed, sensed, *controller, torque, 1, {}});
  }
  std::map<std::string, double> figures() const {
    std::vector<Metric> metrics;
    measure->metrics(metrics);
    std::map<std::string, double> figures;
    for (const Metric& metric : metrics) figures[metric.name] = metric.value;
    return figures;
  }
  double column(const std::string& name) const {
    std::vector<LogColumn> columns;
    measure->columns(columns);
    for (const LogColumn& column : columns)
      if (column.name == name) return *column.value;
    ADD_FAILURE() << name;
    return 0;
  }

  static description::Robot read() {
    std::vector<dsl::Diagnostic> warnings;
    return dsl::readRobot(TACTUS_SOURCE_DIR "/models/lwr_4plus.urdf", warnings);
  }
  description::Robot robot;
  std::shared_ptr<dynamics::Model> model;
  description::Scene scene;
  Registry registry;
  ElementValues values;
  std::unique_ptr<Controller> controller;
  std::unique_ptr<Measure> measure;
  Sensed sensed;
};

// A torque of lower levels on the joint of the row itself is the force along it, whatever the inertia.
TEST(BrokenRows, OfOneJointByHand) {
  double push = 0;
  int stops = 1;
  Arm arm([] { return std::make_unique<tactus::testing::SumOfTasks>(); },
          [&](TickTask& rows) {
            rows.rows = stops;
            rows.jacobian.setZero();
            rows.jacobian(0, 3) = 1;
            rows.force[0] = -0.1;                                  // its own: no lower level's
          },
          [&](TickTask& rows) {
            rows.rows = 1;
            rows.jacobian.setZero();
            rows.jacobian(0, 3) = 2;
            rows.force[0] = push / 2;
          });
  EXPECT_TRUE(std::isnan(arm.figures()["share"]));
  EXPECT_TRUE(std::isnan(arm.figures()["stop_max"]));
  push = -0.4;
  arm.tick();
  EXPECT_EQ(arm.figures()["share"], 0) << "away from it";
  EXPECT_EQ(arm.figures()["stop_mean"], 0);
  push = 0.7;
  arm.tick();
  EXPECT_EQ(arm.column("rows"), 1);
  EXPECT_NEAR(arm.column("stop"), 0.7, 1e-12);
  push = 0.2;
  arm.tick();
  stops = 0;
  arm.tick();
  EXPECT_EQ(arm.column("rows"), 0);
  EXPECT_EQ(arm.column("stop"), 0);
  EXPECT_NEAR(arm.figures()["share"], 2.0 / 3, 1e-15) << "a tick without a row is not judged";
  EXPECT_NEAR(arm.figures()["stop_share"], 2.0 / 3, 1e-15);
  EXPECT_NEAR(arm.figures()["stop_mean"], 0.45, 1e-12);
  EXPECT_NEAR(arm.figures()["stop_max"], 0.7, 1e-12);
}

class Projections : public ::testing::TestWithParam<Cascade> {};

/// Random rows at random torques, some beyond the actuators' limits; the worst force against dense inverses.
std::map<std::string, double> onRandomRows(const null_space::NullSpaceOptions& options) {
  test::ProblemSource source(7);
  Arm arm([options] { return std::make_unique<NullSpace>(options); },
          [&](TickTask& rows) {
            rows.rows = source.integer(0, 5);
            rows.jacobian.topRows(rows.rows) = source.gaussian(rows.rows, 7);
            rows.force.setZero();
          },
          [&](TickTask& rows) {
            rows.rows = source.integer(1, 7);
            rows.jacobian.topRows(rows.rows) = source.gaussian(rows.rows, 7);
            rows.force = std::pow(10, source.uniform(-1, 3)) * source.gaussian(7, 1);
          });
  double worst = 0;
  long rows = 0, broken = 0;
  for (int k = 0; k < 400; ++k) {
    arm.tick();
    const TickProblem& problem = arm.controller->problem();
    const TickTask& stop = problem.levels[0].tasks[0];
    if (stop.rows == 0) continue;
    const Eigen::MatrixXd inverse = problem.mass_matrix.inverse();
    const TickSolution& solution = arm.controller->solution();
    // `stop` has no torque of its own: all of it comes from below.
    const Eigen::VectorXd tau = solution.torque / solution.scale;
    for (int i = 0; i < stop.rows; ++i) {
      const Eigen::RowVectorXd J = stop.jacobian.row(i);
      const double delta = J * inverse * tau, inertia = J * inverse * J.transpose();
      ++rows;
      if (delta <= 1e-6 * std::sqrt(inertia * tau.dot(inverse * tau))) continue;
      ++broken;
      worst = std::max(worst, delta / inertia);
    }
  }
  std::map<std::string, double> figures = arm.figures();
  EXPECT_NEAR(figures["stop_share"], static_cast<double>(broken) / static_cast<double>(rows), 1e-12);
  EXPECT_NEAR(figures["stop_max"], worst, 1e-9 * (1 + worst));
  return figures;
}

TEST_P(Projections, KeepAllRowsWhereTheyAreExactAndBreakSomeInOnePass) {
  const std::map<std::string, double> exact = onRandomRows({.cascade = GetParam()});
  EXPECT_EQ(exact.at("share"), 0);
  EXPECT_EQ(exact.at("stop_max"), 0);
  const std::map<std::string, double> one_pass =
      onRandomRows({.cascade = GetParam(), .inequalities = Inequalities::one_pass});
  EXPECT_GT(one_pass.at("share"), 0.05);
  EXPECT_LT(one_pass.at("share"), 0.9);
  EXPECT_GT(one_pass.at("stop_mean"), 0);
  EXPECT_GT(one_pass.at("stop_max"), one_pass.at("stop_mean"));
}

INSTANTIATE_TEST_SUITE_P(Cascades, Projections, ::testing::Values(Cascade::augmented, Cascade::successive));

}  // namespace
}  // namespace tactus::tasks
