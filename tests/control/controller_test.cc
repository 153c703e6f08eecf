// One tick of the controller: what a task or a back end does wrong never reaches the robot, and is named.
//
// Strategy: a bob on a rod, one task that does what the test says, a back end that hands its torque on.

#include "framework/control/controller.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/runtime/pendulum.h"

namespace tactus::control {
namespace {

using Fill = std::function<void(TickTask&)>;

/// One row, filled by the test.
class Scripted final : public Task {
 public:
  Scripted(int capacity, Fill fill) : Task(Relation::equality, capacity), fill_(std::move(fill)) {}

 private:
  void doUpdate(const Tick&, TickTask& rows) override { fill_(rows); }
  Fill fill_;
};

/// τ = Σ JᵀF times a factor, which it reports as a scale.
class Scaled final : public BackEnd {
 public:
  explicit Scaled(double scale) : BackEnd({}), scale_(scale) {}

 private:
  void doPrepare(const TickProblem&) override {}
  void doSolve(const TickProblem& problem, TickSolution& solution) override {
    solution.torque.setZero(problem.dof);
    for (const TickTask& task : problem.levels[0].tasks) solution.torque += scale_ * task.J().transpose() * task.F();
    solution.scale = scale_;
  }
  double scale_;
};

std::unique_ptr<Controller> controllerOf(Fill fill, double scale = 1) {
  std::vector<Level> levels(1);
  levels[0].tasks.push_back({"idle", std::make_unique<Scripted>(1, [](TickTask& rows) { rows.rows = 0; })});
  levels[0].tasks.push_back({"pull", std::make_unique<Scripted>(1, std::move(fill))});
  return std::make_unique<Controller>(std::make_shared<dynamics::Model>(tactus::testing::pendulum()),
                                      std::vector<NamedSignal>{}, std::move(levels), std::make_unique<Scaled>(scale), 0.001,
                                      Eigen::Vector3d(0, 0, -9.81));
}

Fill forceOf(double force) {
  return [force](TickTask& rows) {
    rows.rows = 1;
    rows.jacobian(0, 0) = 1;
    rows.force[0] = force;
  };
}

Sensed aside() {
  Sensed sensed;
  sensed.time = 0.25;
  sensed.q = Eigen::VectorXd::Constant(1, 0.4);
  sensed.qd = Eigen::VectorXd::Zero(1);
  return sensed;
}

std::string errorOf(Fill fill) {
  try {
    controllerOf(std::move(fill))->tick(aside());
  } catch (const TickError& error) {
    return error.what();
  }
  return "";
}

TEST(Controller, AScaledTorqueIsLimited) {
  const auto controller = controllerOf(forceOf(3), 0.5);
  controller->tick(aside());
  EXPECT_TRUE(controller->record().limited);
  const auto free = controllerOf(forceOf(3));
  free->tick(aside());
  EXPECT_FALSE(free->record().limited);
}

TEST(Controller, ATorqueBeyondTheActuatorsIsLimited) {
  const auto controller = controllerOf(forceOf(1e5));
  EXPECT_EQ(controller->tick(aside())[0], 100);
  EXPECT_TRUE(controller->record().limited);
  EXPECT_FALSE(controller->record().fallback);
}

TEST(Controller, NumbersThatAreNoneFallBackToGravityAlone) {
  for (const double force : {std::nan(""), double{INFINITY}}) {
    const auto controller = controllerOf(forceOf(force));
    const double gravity = 2 * 9.81 * 0.5 * std::sin(0.4);
    EXPECT_NEAR(controller->tick(aside())[0], gravity, 1e-12);
    EXPECT_TRUE(controller->record().fallback);
    ASSERT_NE(controller->record().unusable_task, nullptr);
    EXPECT_EQ(*controller->record().unusable_task, "pull");
  }
  const auto controller = controllerOf(forceOf(1));
  controller->tick(aside());
  EXPECT_EQ(controller->record().unusable_task, nullptr);
}

TEST(Controller, WhatATaskThrowsNamesItAndTheTime) {
  EXPECT_EQ(errorOf([](TickTask&) { throw std::runtime_error("no such file"); }),
            "task 'pull' failed at t = 0.25 s: no such file");
  EXPECT_EQ(errorOf([](TickTask&) { throw 3; }),
            "task 'pull' failed at t = 0.25 s: it threw something that is not a std::exception");
}

TEST(Controller, ATaskKeepsItsStorage) {
  EXPECT_EQ(errorOf([](TickTask& rows) { rows.rows = 2; }),
            "task 'pull' failed at t = 0.25 s: it fills 2 rows, but announced at most 1");
  EXPECT_EQ(errorOf([](TickTask& rows) { rows.rows = -1; }),
            "task 'pull' failed at t = 0.25 s: it fills -1 rows, but announced at most 1");
  EXPECT_THAT(errorOf([](TickTask& rows) { rows.force.resize(7); }),
              ::testing::HasSubstr("it changed the size of its rows: jacobian must stay 1 × 1, force and acceleration 1"));
}

}  // namespace
}  // namespace tactus::control
