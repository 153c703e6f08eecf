// Senses that lie: the finger of press.xml, simulated, with a plant that hands on wrong or late values.  Whatever
// comes, the torque is finite, within the actuators' limits and within the declared rate, and the run says what was wrong.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <random>

#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "framework/runtime/loop.h"
#include "framework/runtime/plugin_loader.h"
#include "framework/runtime/run_statistics.h"
#include "sim/simbody_plant.h"
#include "tasks/register_tasks.h"

namespace tactus::testing {
namespace {

using control::Sensed;
using ::testing::ElementsAre;

constexpr double rate = 50;                                        // 1/s, of the effort
const double nan = std::nan("");

/// What the inner plant senses, `delay` ticks late, and as `fault` leaves it.
class LyingPlant final : public runtime::Plant {
 public:
  LyingPlant(runtime::Plant& inner, std::function<void(Sensed&)> fault, std::size_t delay)
      : inner_(inner), fault_(std::move(fault)), delay_(delay) {
    lie();
  }
  const Sensed& sense() const override { return said_; }
  void advance(const Eigen::VectorXd& torque, double duration) override {
    inner_.advance(torque, duration);
    lie();
  }

 private:
  void lie() {
    past_.push_back(inner_.sense());
    if (past_.size() > delay_ + 1) past_.pop_front();
    said_ = past_.front();
    fault_(said_);
  }
  runtime::Plant& inner_;
  std::function<void(Sensed&)> fault_;
  std::size_t delay_;
  std::deque<Sensed> past_;
  Sensed said_;
};

class Watch final : public control::Observer {
 public:
  bool finite = true;
  double largest = 0, largest_step = 0;                            // of the effort limit
  long contacts_seen = 0;
  long switches = 0;                                               // of ranks of the first level
  long jerks = 0;                                                  // steps beyond 0.1 % of the limit, after 1 s

  void observe(const control::ObservedTick& tick) override {
    const Eigen::ArrayXd share = tick.torque.array() / tick.controller.model().effort().array();
    finite = finite && share.allFinite();
    largest = std::max(largest, share.abs().maxCoeff());
    const int rank = tick.controller.solution().levels[0].rank;
    if (last_.size() > 0) {
      const double step = (share - last_).abs().maxCoeff();
      largest_step = std::max(largest_step, step);
      if (tick.sensed.time > 1) jerks += step > 1e-3;
      if (tick.sensed.time > 1) switches += rank != last_rank_;
    }
    last_rank_ = rank;
    last_ = share;
    contacts_seen += !tick.sensed.contacts.empty();
  }

 private:
  Eigen::ArrayXd last_;
  int last_rank_ = 0;
};

struct Outcome {
  Watch watch;
  runtime::RunStatistics statistics{2000};
  Sensed end;                                                      // what was true
};

struct Case {
  std::function<void(Sensed&)> fault = [](Sensed&) {};
  std::size_t delay = 0;
  double mass_factor = 1;                                          // of the controller's model over the plant
  double duration = 1;
};

class BadSenses : public ::testing::TestWithParam<const char*> {
 protected:
  BadSenses() {
    dsl::addStructureElements(registry);
    tasks::registerBuiltIns(registry);
    runtime::PluginLoader(registry, {}, SHIPPED_PLUGINS).loadFolder(SHIPPED_PLUGINS);
    dsl::ReadOptions options;
    options.backend = std::string(GetParam()) == "null-space" ? "" : "qp";
    if (!options.backend.empty()) options.backend_options["solver"] = "nlopt";
    stack = dsl::readStack(TACTUS_SOURCE_DIR "/tests/apps/data/press.xml", registry, options);
    std::string error;
    const control::AttributeRow& row = *stack.controller.values.row().attribute("torque-rate");
    stack.controller.values.set("torque-rate", *control::parseValue(row, control::formatNumber(rate), error));
  }

  /// Runs, and holds the outcome against what is promised always.
  Outcome run(const Case& wrong) {
    sim::SimbodyPlant plant(stack.robot, stack.scene(1), stack.start_q);
    dsl::Stack believed = stack;
    for (description::Link& link : believed.robot.links) {
      link.mass *= wrong.mass_factor;
      link.inertia *= wrong.mass_factor;
    }
    const auto controller = dsl::compile(believed, registry);
    LyingPlant lying(plant, wrong.fault, wrong.delay);
    Outcome outcome;
    const std::atomic<bool> stop{false};
    const runtime::LoopResult result =
        runtime::runLoop(lying, *controller, wrong.duration, {&outcome.watch, &outcome.statistics}, stop);
    EXPECT_EQ(result.ending, runtime::Ending::done) << result.message;
    EXPECT_TRUE(outcome.watch.finite);
    EXPECT_LE(outcome.watch.largest, 1);
    EXPECT_LE(outcome.watch.largest_step, rate * 0.001 + 1e-12);
    outcome.end = plant.sense();
    return outcome;
  }

  static double force(const Sensed& sensed) {
    double sum = 0;
    for (const control::ContactRecord& contact : sensed.contacts) sum += contact.force_N;
    return sum;
  }

  control::Registry registry;
  dsl::Stack stack;
};

bool within(const Sensed& sensed, double from, double until) {
  return sensed.time > from - 5e-4 && sensed.time < until - 5e-4;
}

TEST_P(BadSenses, GoodOnesAreNotRemarkedUpon) {
  const Outcome outcome = run({.duration = 2});
  EXPECT_THAT(outcome.statistics.warnings(), ElementsAre());
  EXPECT_GT(outcome.watch.contacts_seen, 500);
  EXPECT_NEAR(force(outcome.end), 0.5, 0.1);
}

TEST_P(BadSenses, AJointThatIsLostForAMomentIsHeld) {
  for (const bool velocity : {false, true}) {
    const Outcome outcome = run({.fault = [=](Sensed& sensed) {
                                   if (within(sensed, 0.3, 0.31)) (velocity ? sensed.qd : sensed.q)[1] = nan;
                                 },
                                 .duration = 2});
    EXPECT_EQ(outcome.statistics.fallbacks, 0);
    EXPECT_THAT(outcome.statistics.warnings(),
                ElementsAre("joint 'knee' was not sensed, first at t = 0.3 s: 10 ticks took its last good values, or "
                            "bore the weight alone"));
    EXPECT_NEAR(force(outcome.end), 0.5, 0.1) << "the finger presses as if nothing had been";
  }
}

TEST_P(BadSenses, AJointThatStaysLostLeavesTheWeightAlone) {
  const Outcome outcome = run({.fault = [](Sensed& sensed) {
    if (sensed.time > 0.2995) sensed.q[1] = INFINITY;
  }});
  EXPECT_EQ(outcome.statistics.blind, 680) << "after 20 ms";
  EXPECT_EQ(outcome.statistics.gravity, 680);
  EXPECT_EQ(outcome.statistics.lostJoints().size(), 1u);
}

TEST_P(BadSenses, StatesThatAreAbsentAreHeldAndRecoverFrom) {
  const Outcome outcome = run({.fault = [](Sensed& sensed) {
                                 if (within(sensed, 0.3, 0.4)) sensed.q.resize(0);
                               },
                               .duration = 2});
  EXPECT_EQ(outcome.statistics.blind, 80);
  EXPECT_EQ(outcome.statistics.lostJoints().size(), 3u);
  EXPECT_NEAR(force(outcome.end), 0.5, 0.1);
}

TEST_P(BadSenses, WithoutAnyStateFromTheStartNothingIsDone) {
  const Outcome outcome = run({.fault = [](Sensed& sensed) { sensed.qd.resize(0); }, .duration = 0.1});
  EXPECT_EQ(outcome.watch.largest, 0);
  EXPECT_EQ(outcome.statistics.blind, 100);
}

TEST_P(BadSenses, ContactsThatAreNoNumbersAreIgnoredAndCounted) {
  for (int kind = 0; kind < 3; ++kind) {
    long broken = 0;
    const Outcome outcome = run({.fault = [&](Sensed& sensed) {
                                   for (control::ContactRecord& contact : sensed.contacts) {
                                     if (!within(sensed, 1, 1.1)) continue;
                                     if (kind == 0) contact.force_N = nan;
                                     if (kind == 1) contact.point_W.x() = nan;
                                     if (kind == 2) contact.normal_W.setConstant(nan);
                                     ++broken;
                                   }
                                 },
                                 .duration = 2});
    ASSERT_GT(broken, 10);
    EXPECT_THAT(outcome.statistics.warnings(),
                ElementsAre(::testing::StartsWith("contacts of link 'distal' were no numbers, first at t = 1")));
    EXPECT_EQ(outcome.statistics.ignoredContacts()[0].ticks, broken);
  }
}

TEST_P(BadSenses, APatchThatFallsSilentLooksLikeNoContact) {
  const Outcome outcome = run({.fault = [](Sensed& sensed) {
                                 if (sensed.time > 1) sensed.contacts.clear();
                               },
                               .duration = 2});
  EXPECT_GT(outcome.watch.contacts_seen, 100);
  EXPECT_THAT(outcome.statistics.warnings(), ElementsAre());
}

TEST_P(BadSenses, AContactThatComesAndGoesEveryTickDoesNotMakeTheTorqueChatter) {
  const auto flicker = [ticks = 0](Sensed& sensed) mutable {
    if (sensed.time > 1 && ++ticks % 2) sensed.contacts.clear();
  };
  const Outcome steady = run({.fault = flicker, .duration = 2});
  EXPECT_EQ(steady.watch.switches, 0) << "the signal's hold, 5 ms, keeps the contact";
  EXPECT_EQ(steady.watch.jerks, 0);
  // Without hysteresis it would.
  std::string error;
  const control::AttributeRow& hold = *stack.signals[0].values.row().attribute("hold");
  stack.signals[0].values.set("hold", *control::parseValue(hold, "0", error));
  const Outcome chattering = run({.fault = flicker, .duration = 2});
  EXPECT_GT(chattering.watch.switches, 500);
}

TEST_P(BadSenses, AModelOfTheWrongMassStaysWithinLimits) {
  for (const double factor : {0.7, 1.3}) {
    const Outcome outcome = run({.mass_factor = factor, .duration = 2});
    EXPECT_EQ(outcome.statistics.fallbacks, 0);
    EXPECT_TRUE(outcome.end.qd.allFinite());
  }
}

TEST_P(BadSenses, AStateThatComesLateStaysStable) {
  const Outcome outcome = run({.delay = 2, .duration = 2});
  EXPECT_NEAR(force(outcome.end), 0.5, 0.1);
  EXPECT_LT(outcome.end.qd.norm(), 0.1);
}

TEST_P(BadSenses, WhateverComesTheTorqueIsFit) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const auto lies = [&](Sensed& sensed) {
      const double kinds[] = {nan, INFINITY, -INFINITY, 1e300, 0};
      const auto value = [&] { return kinds[random() % 5]; };
      if (random() % 20 == 0) (random() % 2 ? sensed.q : sensed.qd)[static_cast<Eigen::Index>(random() % 3)] = value();
      if (random() % 200 == 0) sensed.q.resize(static_cast<Eigen::Index>(random() % 5));
      if (random() % 50 == 0) sensed.time = value();
      if (random() % 5 == 0) sensed.contacts.emplace_back();
      for (control::ContactRecord& contact : sensed.contacts) {
        if (random() % 5 == 0) contact.normal_W[static_cast<Eigen::Index>(random() % 3)] = value();
        if (random() % 5 == 0) contact.force_N = value();
        if (random() % 20 == 0) contact.link = static_cast<int>(random() % 10) - 3;
      }
    };
    const Outcome outcome = run({.fault = lies, .delay = seed % 3, .mass_factor = 0.7 + 0.1 * seed});
    EXPECT_GT(outcome.statistics.warnings().size(), 3u);
  }
}

INSTANTIATE_TEST_SUITE_P(BackEnds, BadSenses, ::testing::Values("null-space", "qp"), [](const auto& info) {
  return std::string(info.param) == "qp" ? "Qp" : "NullSpace";
});

}  // namespace
}  // namespace tactus::testing
