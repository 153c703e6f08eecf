#include "framework/runtime/loop.h"

#include <gtest/gtest.h>

#include "framework/runtime/file_error.h"
#include "tests/runtime/pendulum.h"

namespace tactus::runtime {
namespace {

using tactus::testing::pendulumController;
using tactus::testing::PendulumPlant;

/// Remembers what it saw, and may raise the stop flag.
class Witness final : public control::Observer {
 public:
  void observe(const control::ObservedTick& tick) override {
    times.push_back(tick.sensed.time);
    tick_us_negative |= tick.tick_us < 0;
    if (static_cast<long>(times.size()) == stop_after) stop = true;
  }
  std::vector<double> times;
  bool tick_us_negative = false;
  long stop_after = -1;
  std::atomic<bool> stop{false};
};

TEST(Loop, RunsOneTickEachPeriod) {
  PendulumPlant plant;
  Witness witness;
  const LoopResult result = runLoop(plant, *pendulumController(0.5), 0.1, {&witness}, witness.stop);
  EXPECT_EQ(result.ending, Ending::done);
  EXPECT_EQ(result.ticks, 100);
  EXPECT_DOUBLE_EQ(result.simulated, 0.1);
  ASSERT_EQ(witness.times.size(), 100u);
  EXPECT_EQ(witness.times.front(), 0);
  EXPECT_NEAR(witness.times.back(), 0.099, 1e-12);
  EXPECT_NEAR(plant.sense().time, 0.1, 1e-12);
  EXPECT_FALSE(witness.tick_us_negative);
}

TEST(Loop, ClosesTheLoop) {
  PendulumPlant plant;
  Witness witness;
  // Gravity is compensated, so that the spring alone decides: it settles at its target.
  runLoop(plant, *pendulumController(0.5), 5, {}, witness.stop);
  EXPECT_NEAR(plant.sense().q[0], 0.5, 1e-6);
}

TEST(Loop, StopFlagEndsTheRun) {
  PendulumPlant plant;
  Witness witness;
  witness.stop_after = 7;
  const LoopResult result = runLoop(plant, *pendulumController(0.5), 1, {&witness}, witness.stop);
  EXPECT_EQ(result.ending, Ending::interrupted);
  EXPECT_EQ(result.ticks, 7);
  EXPECT_EQ(witness.times.size(), 7u);
}

TEST(Loop, PlantErrorEndsTheRunWithItsMessage) {
  PendulumPlant plant;
  plant.breaks_at = 0.0495;
  Witness witness;
  const LoopResult result = runLoop(plant, *pendulumController(0.5), 1, {&witness}, witness.stop);
  EXPECT_EQ(result.ending, Ending::plant_error);
  EXPECT_EQ(result.message, "the rod broke");
  EXPECT_THROW(std::rethrow_exception(result.error), PlantError);
  EXPECT_EQ(result.ticks, 50);
  EXPECT_EQ(witness.times.size(), 51u);  // the tick before the break was seen
}

TEST(Loop, AFileThatCannotBeWrittenEndsTheRunWithItsMessage) {
  class FullDisk final : public control::Observer {
    void observe(const control::ObservedTick& tick) override {
      if (tick.sensed.time > 0.0095) throw FileError("log.csv", "no space");
    }
  };
  PendulumPlant plant;
  FullDisk disk;
  const std::atomic<bool> stop{false};
  const LoopResult result = runLoop(plant, *pendulumController(0.5), 1, {&disk}, stop);
  EXPECT_EQ(result.ending, Ending::file_error);
  EXPECT_EQ(result.message, "log.csv: no space");
  EXPECT_EQ(result.ticks, 10);
}

TEST(Loop, WhatObserversThrowGoesThrough) {
  class Thrower final : public control::Observer {
    void observe(const control::ObservedTick&) override { throw std::runtime_error("disk full"); }
  };
  PendulumPlant plant;
  Thrower thrower;
  const std::atomic<bool> stop{false};
  EXPECT_THROW(runLoop(plant, *pendulumController(0.5), 1, {&thrower}, stop), std::runtime_error);
}

}  // namespace
}  // namespace tactus::runtime
