#include "framework/runtime/run_statistics.h"

#include <gmock/gmock.h>
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

/// A pendulum's tick, observed again and again.
struct SameTick {
  std::unique_ptr<control::Controller> controller;
  control::Sensed sensed;
  explicit SameTick(double target) : controller(pendulumController(target)) {
    sensed.q = sensed.qd = Eigen::VectorXd::Zero(1);
    controller->tick(sensed);
  }
  control::ObservedTick with(double tick_us) const { return {sensed, sensed, *controller, sensed.q, tick_us}; }
};

TEST(RunStatistics, KeepsABoundedNumberOfTimesHoweverLongTheRun) {
  const SameTick tick(0.5);
  const long ticks = 2 * RunStatistics::most_times + 1000;
  RunStatistics statistics(1'000'000'000'000);
  for (long i = 0; i < ticks; ++i) statistics.observe(tick.with(static_cast<double>(i)));
  EXPECT_EQ(statistics.ticks(), ticks);
  const std::vector<double>& times = statistics.tickTimes();
  ASSERT_LE(static_cast<long>(times.size()), RunStatistics::most_times);
  ASSERT_GE(static_cast<long>(times.size()), RunStatistics::most_times / 4);
  EXPECT_LE(times.capacity(), 2u * RunStatistics::most_times);
  // Evenly from the whole run: every 4th.
  for (size_t i = 0; i < times.size(); ++i) ASSERT_EQ(times[i], 4.0 * static_cast<double>(i));
}

TEST(RunStatistics, NamesTheTaskWhoseNumbersFail) {
  const SameTick tick(std::nan(""));
  RunStatistics statistics(3);
  for (int i = 0; i < 3; ++i) statistics.observe(tick.with(1));
  EXPECT_EQ(statistics.fallbacks, 3);
  ASSERT_EQ(statistics.unusableTasks().size(), 1u);
  EXPECT_EQ(statistics.unusableTasks()[0].name, "lift");
  EXPECT_EQ(statistics.unusableTasks()[0].first_time, 0);
  EXPECT_EQ(statistics.unusableTasks()[0].ticks, 3);
}

TEST(RunStatistics, NamesWhatWasNotSensed) {
  SameTick tick(0.5);
  RunStatistics statistics(30);
  tick.sensed.q[0] = std::nan("");
  tick.sensed.time = 0.25;
  control::ContactRecord contact;
  contact.link = 1;
  contact.force_N = INFINITY;
  tick.sensed.contacts = {contact, contact};
  for (int i = 0; i < 30; ++i) {
    tick.controller->tick(tick.sensed);
    statistics.observe(tick.with(1));
  }
  ASSERT_EQ(statistics.lostJoints().size(), 1u);
  EXPECT_EQ(statistics.lostJoints()[0].name, "hinge");
  EXPECT_EQ(statistics.lostJoints()[0].first_time, 0.25);
  EXPECT_EQ(statistics.blind, 10) << "held for 20 ms";
  EXPECT_EQ(statistics.gravity, 10);
  EXPECT_EQ(statistics.fallbacks, 10);
  EXPECT_THAT(statistics.warnings(),
              ::testing::ElementsAre(
                  "joint 'hinge' was not sensed, first at t = 0.25 s: 30 ticks took its last good values, or bore the "
                  "weight alone",
                  "contacts of link 'bob' were no numbers, first at t = 0.25 s: 60 were ignored"));
}

TEST(RunStatistics, NamesTheFirstJointThatIsTooFast) {
  description::Robot fast = tactus::testing::pendulum();
  const auto warningsWith = [&](double limit) {
    fast.joints[0].velocity = limit;
    PendulumPlant plant;
    RunStatistics statistics(100);
    const std::atomic<bool> stop{false};
    runLoop(plant, *pendulumController(0.5, false, -1, fast), 0.1, {&statistics}, stop);
    return statistics.warnings();
  };
  const std::vector<std::string> warnings = warningsWith(0.5);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings[0],
              ::testing::AllOf(::testing::StartsWith("joint 'hinge' was faster than its velocity limit, first at t = "),
                               ::testing::EndsWith(" ticks")));
  EXPECT_THAT(warningsWith(50), ::testing::ElementsAre());
  EXPECT_THAT(warningsWith(0), ::testing::ElementsAre()) << "a limit that nobody knew";
}

TEST(RunStatistics, CountsWhoseTorqueWasApplied) {
  PendulumPlant plant;
  RunStatistics statistics(100);
  const std::atomic<bool> stop{false};
  runLoop(plant, *pendulumController(0.5, true, 90), 0.1, {&statistics}, stop);
  EXPECT_EQ(statistics.partial, 10) << "that back end fails, but leaves a torque";
  EXPECT_EQ(statistics.held + statistics.gravity + statistics.late + statistics.rate_limited, 0);
  EXPECT_THAT(statistics.warnings(),
              ::testing::ElementsAre(
                  "10 of 100 ticks fell back: their problem was infeasible, or the back end failed"));
}

}  // namespace
}  // namespace tactus::runtime
