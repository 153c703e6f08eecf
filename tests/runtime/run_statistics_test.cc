#include "framework/runtime/run_statistics.h"

#include <gtest/gtest.h>

#include "framework/runtime/loop.h"
#include "tests/runtime/pendulum.h"

namespace tactus::runtime {
namespace {

using tactus::testing::pendulumController;
using tactus::testing::PendulumPlant;

TEST(RunStatistics, CountsWhatTheBackEndSays) {
  PendulumPlant plant;
  RunStatistics statistics(100);
  const std::atomic<bool> stop{false};
  runLoop(plant, *pendulumController(0.5, true, 90), 0.1, {&statistics}, stop);
  EXPECT_EQ(statistics.ticks(), 100);
  EXPECT_EQ(statistics.fallbacks, 10);
  EXPECT_EQ(statistics.infeasible, 0);
  EXPECT_EQ(statistics.lost_rank, 25);
  EXPECT_TRUE(statistics.has_kkt);
  EXPECT_DOUBLE_EQ(statistics.kkt_max.stationarity, 100e-9);
}

TEST(RunStatistics, WithoutKktThereIsNone) {
  PendulumPlant plant;
  RunStatistics statistics(10);
  const std::atomic<bool> stop{false};
  runLoop(plant, *pendulumController(0.5), 0.01, {&statistics}, stop);
  EXPECT_FALSE(statistics.has_kkt);
}

TEST(RunStatistics, TorqueLimitsAreCounted) {
  PendulumPlant plant;
  RunStatistics statistics(10);
  const std::atomic<bool> stop{false};
  runLoop(plant, *pendulumController(1000), 0.01, {&statistics}, stop);  // a spring that asks for 20 kN m
  EXPECT_EQ(statistics.limited, 10);
}

}  // namespace
}  // namespace tactus::runtime
