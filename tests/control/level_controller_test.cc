// A controller owns a level: it runs before its tasks, switches them, and goes with them where it fails.
//
// Strategy: a bob on a rod; two tasks that pull with a force of their own, and a controller that lets each pull in turn.

#include "framework/control/level_controller.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/runtime/pendulum.h"

namespace tactus::control {
namespace {

class Pull final : public Task {
 public:
  explicit Pull(const double& force) : Task(Relation::equality, 1), force_(force) {}

 private:
  void doUpdate(const Tick&, TickTask& rows) override {
    rows.rows = 1;
    rows.jacobian(0, 0) = 1;
    rows.force[0] = force_;
  }
  const double& force_;
};

/// Its task pulls with as many N m as ticks went by; from `fails_at` on it throws.
class Turns final : public LevelController {
 public:
  double force = 0, first = 1, second = 0;
  int fails_at = 1000;
  int ticks = 0;

 private:
  void doUpdate(const Tick&) override {
    if (ticks == fails_at) throw std::runtime_error("lost the thread");
    force = ++ticks;
  }
};

struct World {
  explicit World(OnFault on_fault = OnFault::fall_back, const ActiveWhen& level_when = {}) {
    auto owner = std::make_unique<Turns>();
    turns = owner.get();
    ActiveWhen first, second;
    first.ramp = second.ramp = 0;
    first.on = &turns->first;
    second.on = &turns->second;
    std::vector<Level> levels(1);
    levels[0].activation = Activation(level_when);
    levels[0].tasks.push_back({"turns.a", std::make_unique<Pull>(turns->force), Activation(first)});
    levels[0].tasks.push_back({"turns.b", std::make_unique<Pull>(turns->force), Activation(second)});
    levels[0].owner = {"turns", std::move(owner)};
    ControllerOptions options;
    options.on_fault = on_fault;
    options.ramp = 0;
    controller = std::make_unique<Controller>(
        std::make_shared<dynamics::Model>(tactus::testing::pendulum()), std::vector<NamedSignal>{}, std::move(levels),
        std::make_unique<tactus::testing::SumOfTasks>(), 0.001, Eigen::Vector3d::Zero(), options);
    sensed.q = sensed.qd = Eigen::VectorXd::Zero(1);
  }
  double tick() {
    const double torque = controller->tick(sensed)[0];
    sensed.time += 0.001;
    return torque;
  }

  Turns* turns;
  std::unique_ptr<Controller> controller;
  Sensed sensed;
};

TEST(LevelController, RunsBeforeItsTasks) {
  World world;
  EXPECT_EQ(world.tick(), 1);
  EXPECT_EQ(world.tick(), 2);
}

TEST(LevelController, SwitchesItsTasks) {
  World world;
  world.tick();
  world.turns->second = 1;
  EXPECT_EQ(world.tick(), 4);                                      // both pull with 2
  world.turns->first = 0;
  EXPECT_EQ(world.tick(), 3);
}

TEST(LevelController, RestsWithItsLevel) {
  ActiveWhen later;
  later.from = 0.003;
  later.ramp = 0;
  World world(OnFault::fall_back, later);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(world.tick(), 0);
  EXPECT_EQ(world.turns->ticks, 0);
  EXPECT_EQ(world.tick(), 1);
}

TEST(LevelController, ThatThrowsIsNamed) {
  World world;
  world.turns->fails_at = 1;
  world.tick();
  try {
    world.tick();
    FAIL();
  } catch (const TickError& error) {
    EXPECT_STREQ(error.what(), "controller 'turns' failed at t = 0.001 s: lost the thread");
    EXPECT_EQ(error.part, TickError::Part::controller);
  }
}

TEST(LevelController, ThatThrowsIsSwitchedOffWithItsTasksWhereTheStackSaysSo) {
  World world(OnFault::switch_off);
  world.turns->fails_at = 1;
  world.tick();
  EXPECT_EQ(world.tick(), 0);
  EXPECT_EQ(world.tick(), 0);
  ASSERT_EQ(world.controller->switchedOff().size(), 2u);
  EXPECT_EQ(world.controller->switchedOff()[0].task, "turns.a");
  EXPECT_EQ(world.controller->switchedOff()[0].reason, "controller 'turns': lost the thread");
  EXPECT_TRUE(world.controller->switchedOff()[0].threw);
}

}  // namespace
}  // namespace tactus::control
