// Tasks, levels and back ends switched between ticks; back ends that fail or come late; senses that go.
//
// Strategy: a pendulum that does not move, so that every step in the torque comes from what the test does.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "framework/control/controller.h"
#include "tests/runtime/pendulum.h"

namespace tactus::control {
namespace {

using ::testing::HasSubstr;

constexpr double dt = 0.001, effort = 100, rate = 1;               // 0.1 N m a tick
const double weight_Nm = 2 * 9.81 * 0.5 * std::sin(0.4);

/// One row with a constant force.
class Push final : public Task {
 public:
  explicit Push(double force, Relation relation = Relation::equality) : Task(relation, 1), force_(force) {}
  int updates = 0;

 private:
  void doUpdate(const Tick&, TickTask& rows) override {
    ++updates;
    rows.rows = 1;
    rows.jacobian(0, 0) = 1;
    rows.force[0] = force_;
  }
  double force_;
};

/// τ = Σ weight JᵀF; says of itself what the test wants.
class Moody final : public BackEnd {
 public:
  Moody() : BackEnd({}) {}
  Status status = Status::ok;
  bool late = false;
  double factor = 1;
  int prepared = 0;
  Deadline seen() const { return deadline(); }

 private:
  void doPrepare(const TickProblem&) override { ++prepared; }
  void doSolve(const TickProblem& problem, TickSolution& solution) override {
    solution.torque.setZero(problem.dof);
    for (const TickLevel& level : problem.levels)
      for (const TickTask& task : level.tasks)
        solution.torque += factor * level.weight.value_or(1) / level.priority * task.J().transpose() * task.F();
    solution.status = status;
    solution.late = late;
  }
};

struct World {
  Moody* back_end = nullptr;
  Push* push = nullptr;
  std::unique_ptr<Controller> controller;
  Sensed sensed;
  double largest_step = 0;

  explicit World(ControllerOptions options = {.torque_rate = rate}, double force = 8) {
    std::vector<Level> levels(2);
    levels[0].tasks.push_back({"push", std::make_unique<Push>(force)});
    levels[0].tasks.push_back({"rest", std::make_unique<Push>(1)});
    levels[1].priority = 2;
    levels[1].tasks.push_back({"low", std::make_unique<Push>(2)});
    push = static_cast<Push*>(levels[0].tasks[0].task.get());
    auto moody = std::make_unique<Moody>();
    back_end = moody.get();
    controller = std::make_unique<Controller>(std::make_shared<dynamics::Model>(tactus::testing::pendulum()),
                                              std::vector<NamedSignal>{}, std::move(levels), std::move(moody), dt,
                                              Eigen::Vector3d(0, 0, -9.81), options);
    sensed.q = Eigen::VectorXd::Constant(1, 0.4);
    sensed.qd = Eigen::VectorXd::Zero(1);
  }
  /// The torque less the weight, after so many ticks.
  double tick(int count = 1) {
    double torque = 0;
    for (int k = 0; k < count; ++k) {
      const bool first = sensed.time == 0;
      const double before = torque_;
      torque_ = controller->tick(sensed)[0];
      if (!first) largest_step = std::max(largest_step, std::abs(torque_ - before));
      sensed.time += dt;
      torque = torque_ - weight_Nm;
    }
    return torque;
  }
  const TickRecord& record() const { return controller->record(); }

 private:
  double torque_ = 0;
};

TEST(Switching, ATaskFadesOutAndInOverItsRampAndIsNotAskedWhileAway) {
  World world;
  EXPECT_NEAR(world.tick(10), 10, 1e-9);                           // 8 + 1 + 2/2
  world.controller->setActive("push", false);
  EXPECT_NEAR(world.tick(50), 6, 0.1);
  EXPECT_NEAR(world.tick(200), 2, 1e-9);
  const int updates = world.push->updates;
  world.tick(10);
  EXPECT_EQ(world.push->updates, updates);
  world.controller->setActive("push", true);
  EXPECT_NEAR(world.tick(400), 10, 1e-9);
  EXPECT_LE(world.largest_step, rate * effort * dt + 1e-9);
  EXPECT_GT(world.largest_step, 0.05);
}

TEST(Switching, ALevelSwitchesWithAllItsTasks) {
  World world;
  world.tick(10);
  world.controller->setActive(1, false);
  EXPECT_NEAR(world.tick(400), 1, 1e-9);
  world.controller->setActive(1, true);
  EXPECT_NEAR(world.tick(400), 10, 1e-9);
  EXPECT_LE(world.largest_step, rate * effort * dt + 1e-9);
}

TEST(Switching, WithoutARateTheRampAloneBoundsTheStep) {
  World world({.ramp = 0.05});
  world.tick(10);
  world.controller->setPriority("push", 2);                        // 8 becomes 4
  EXPECT_NEAR(world.tick(100), 6, 1e-9);
  EXPECT_NEAR(world.largest_step, 4 * dt / 0.05, 1e-9);
  EXPECT_FALSE(world.record().rate_limited);
}

TEST(Switching, WeightsPrioritiesAndBackEndsGoOver) {
  World world({.torque_rate = rate, .ramp = 0.02});
  world.tick(10);
  world.controller->setWeight(2, 5);
  EXPECT_NEAR(world.tick(400), 14, 1e-9);
  world.controller->setPriority("low", 1);
  EXPECT_NEAR(world.tick(400), 11, 1e-9);
  EXPECT_EQ(world.controller->levels()[0].tasks.size(), 3u);
  EXPECT_EQ(world.controller->levels()[1].tasks.size(), 0u);
  world.controller->setPriority("low", 2);
  EXPECT_NEAR(world.tick(400), 14, 1e-9);
  auto other = std::make_unique<Moody>();
  other->factor = -1;
  world.controller->setBackEnd(std::move(other));
  world.tick();
  EXPECT_TRUE(world.record().rate_limited);
  EXPECT_NEAR(world.tick(400), -14, 1e-9);
  EXPECT_FALSE(world.record().rate_limited);
  EXPECT_LE(world.largest_step, rate * effort * dt + 1e-9);
}

TEST(Switching, RefusesWhatIsNotThere) {
  World world;
  const auto refusal = [](auto call) {
    try {
      call();
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Controller& controller = *world.controller;
  EXPECT_EQ(refusal([&] { controller.setActive("pull", true); }), "there is no task 'pull': there are push, rest, low");
  EXPECT_EQ(refusal([&] { controller.setActive(3, true); }), "there is no level of priority 3: there are 1, 2");
  EXPECT_EQ(refusal([&] { controller.setPriority("push", 7); }), "there is no level of priority 7: there are 1, 2");
  EXPECT_EQ(refusal([&] { controller.setWeight(1, 0); }), "the weight of a level is finite and > 0, not 0");
  EXPECT_EQ(refusal([&] { controller.setBackEnd(nullptr); }), "a controller needs a back end");
  std::vector<Level> levels(1);
  levels[0].tasks.push_back({"guard", std::make_unique<Push>(1, Relation::inequality)});
  Controller guarded(std::make_shared<dynamics::Model>(tactus::testing::pendulum()), {}, std::move(levels),
                     std::make_unique<Moody>(), dt, Eigen::Vector3d::Zero());
  EXPECT_EQ(refusal([&] { guarded.setBackEnd(std::make_unique<Moody>()); }),
            "task 'guard' is an inequality, and the back end honours none");
}

TEST(Deadline, ReachesEveryBackEnd) {
  World world({.deadline = {.iterations = 7, .seconds = 1e-3}});
  EXPECT_EQ(world.back_end->seen().iterations, 7);
  EXPECT_EQ(world.back_end->seen().seconds, 1e-3);
  auto other = std::make_unique<Moody>();
  Moody* seen = other.get();
  world.controller->setBackEnd(std::move(other));
  EXPECT_EQ(seen->seen().iterations, 7);
}

TEST(Failure, ALateBackEndsSettledLevelsAreApplied) {
  World world(ControllerOptions{});
  world.tick(10);
  world.back_end->status = Status::failed;
  world.back_end->late = true;
  world.back_end->factor = 0.5;
  EXPECT_NEAR(world.tick(), 5, 1e-9);
  EXPECT_EQ(world.record().source, TorqueSource::partial);
  EXPECT_TRUE(world.record().late);
  EXPECT_TRUE(world.record().fallback);
  EXPECT_EQ(world.record().unusable_task, nullptr);
}

TEST(Failure, WithoutATorqueTheLastSolvedOneIsHeldThenTheWeightAlone) {
  World world({.ramp = 0.05, .hold = 0.02});
  EXPECT_NEAR(world.tick(10), 10, 1e-9);
  world.back_end->status = Status::failed;
  world.back_end->factor = std::nan("");
  for (int k = 0; k < 20; ++k) {
    EXPECT_NEAR(world.tick(), 10, 1e-9);
    EXPECT_EQ(world.record().source, TorqueSource::held);
  }
  world.largest_step = 0;
  world.tick();
  EXPECT_EQ(world.record().source, TorqueSource::gravity);
  EXPECT_NEAR(world.tick(60), 0, 1e-9);
  world.back_end->status = Status::ok;
  world.back_end->factor = 1;
  world.tick();
  EXPECT_EQ(world.record().source, TorqueSource::solved);
  EXPECT_FALSE(world.record().fallback);
  EXPECT_NEAR(world.tick(60), 10, 1e-9);
  EXPECT_NEAR(world.largest_step, 10 * dt / 0.05, 1e-9);
}

TEST(Failure, ATorqueFromATaskThatGivesNoNumbersIsNotTrusted) {
  World world(ControllerOptions{}, INFINITY);
  world.back_end->status = Status::failed;
  world.back_end->factor = 0;                                      // 0 · ∞ is no number
  EXPECT_NEAR(world.tick(), 0, 1e-9);
  EXPECT_EQ(world.record().source, TorqueSource::gravity) << "nothing was solved before";
  ASSERT_NE(world.record().unusable_task, nullptr);
  EXPECT_EQ(*world.record().unusable_task, "push");
}

TEST(Senses, AJointThatIsLostForTooLongLeavesTheWeightAlone) {
  World world({.ramp = 0.05, .hold = 0.02});
  world.tick(10);
  world.sensed.q[0] = std::nan("");
  for (int k = 0; k < 20; ++k) {
    EXPECT_NEAR(world.tick(), 10, 1e-9) << "the last good value stands in";
    EXPECT_EQ(world.record().sensing.joints_held, 1);
    EXPECT_EQ(world.record().source, TorqueSource::solved);
  }
  const int updates = world.push->updates;
  EXPECT_NEAR(world.tick(60), 0, 1e-9) << "gravity at the last good state";
  EXPECT_EQ(world.record().source, TorqueSource::gravity);
  EXPECT_EQ(world.push->updates, updates) << "no task works with a state that is not known";
  EXPECT_TRUE(world.record().sensing.blind);
  world.sensed.q[0] = 0.4;
  EXPECT_NEAR(world.tick(60), 10, 1e-9);
  EXPECT_NEAR(world.largest_step, 10 * dt / 0.05, 1e-9);
}

TEST(Senses, WithoutAnyStateThereIsNoTorque) {
  World world(ControllerOptions{});
  world.sensed.q.resize(0);
  EXPECT_EQ(world.controller->tick(world.sensed)[0], 0);
  EXPECT_TRUE(world.record().fallback);
}

}  // namespace
}  // namespace tactus::control
