// A state machine by itself: guards, their times, the order of ways out, what is told at which place.

#include "tasks/phases.h"

#include <gtest/gtest.h>

#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

using control::ElementValues;

/// Phases made by hand: what the reader would have put together.
class PhasesWorld : public TaskWorld {
 public:
  void phase(const std::string& name, const std::vector<Attributes>& ways) {
    ElementValues values = control::makeValues(*registry.elements().find("phase"), {{"name", name}});
    for (const Attributes& way : ways)
      values.children.push_back(control::makeValues(*registry.elements().find("next"), way));
    values_.children.push_back(values);
  }

  void build(Attributes attributes = {}) {
    attributes.insert({"name", "do"});
    const std::vector<ElementValues> children = values_.children;
    values_ = control::makeValues(*registry.elements().find("phases"), attributes);
    values_.children = children;
    machine = registry.makeSignal(control::BuildContext(
        values_, robot, model, dt,
        [this](const std::string&, const std::string& reference, const std::string&) -> const void* {
          return reference == "a.x" ? &a : &b;
        }));
  }

  /// The phase after an update at that time, by its number.
  double at(double time) {
    sensed.time = time;
    machine->update(tick());
    return value("index");
  }
  double value(const std::string& name) const { return *static_cast<const double*>(machine->port(name)); }

  double a = 0, b = 0;
  std::unique_ptr<control::Signal> machine;

 private:
  ElementValues values_;
};

TEST(Phases, APhaseLastsUntilItsGuardHasHeldForItsTime) {
  PhasesWorld world;
  world.phase("approach", {{{"to", "sweep"}, {"when", "a.x"}, {"above", "2"}, {"for", "0.1"}}});
  world.phase("sweep", {});
  world.build();
  EXPECT_EQ(world.at(0), 1);
  EXPECT_EQ(world.value("approach"), 1);
  EXPECT_EQ(world.value("sweep"), 0);
  world.a = 3;
  EXPECT_EQ(world.at(0.01), 1);
  world.a = 2;                                                     // not above: the time begins anew
  EXPECT_EQ(world.at(0.1), 1);
  world.a = 2.5;
  EXPECT_EQ(world.at(0.2), 1);
  EXPECT_EQ(world.at(0.299), 1);
  EXPECT_EQ(world.at(0.3), 2);
  EXPECT_EQ(world.value("approach"), 0);
  EXPECT_EQ(world.value("sweep"), 1);
  EXPECT_EQ(world.value("time"), 0);
  EXPECT_EQ(world.at(0.4), 2);
  EXPECT_NEAR(world.value("time"), 0.1, 1e-12);
}

TEST(Phases, TheFirstWayWhoseGuardHoldsIsTaken) {
  PhasesWorld world;
  world.phase("one", {{{"to", "two"}, {"when", "a.x"}, {"below", "-1"}}, {{"to", "three"}, {"after", "1"}}});
  world.phase("two", {{{"to", "one"}, {"when", "b.x"}}});          // above 0.5
  world.phase("three", {});
  world.build();
  EXPECT_EQ(world.at(0.5), 1);
  world.a = -2;
  EXPECT_EQ(world.at(0.6), 2);
  world.b = 0.5;
  EXPECT_EQ(world.at(0.7), 2);
  world.b = 0.6;
  world.a = 0;
  EXPECT_EQ(world.at(0.8), 1);
  EXPECT_EQ(world.at(1.7), 1) << "time counts from the entry";
  EXPECT_EQ(world.at(1.8), 3);
  EXPECT_EQ(world.at(100), 3);
}

TEST(Phases, NaNIsNoReasonToGo) {
  PhasesWorld world;
  world.phase("one", {{{"to", "two"}, {"when", "a.x"}, {"below", "1"}}});
  world.phase("two", {});
  world.build();
  world.a = NAN;
  EXPECT_EQ(world.at(1), 1);
}

TEST(Phases, BeginWhereTheyAreToldAndCountWhatTheyDid) {
  PhasesWorld world;
  world.phase("one", {{{"to", "two"}, {"after", "1"}}});
  world.phase("two", {{{"to", "one"}, {"after", "1"}}});
  world.build({{"start", "two"}});
  for (int k = 0; k <= 350; ++k) world.at(0.01 * k);
  std::vector<control::Metric> metrics;
  world.machine->metrics(metrics);
  ASSERT_EQ(metrics.size(), 3u);
  EXPECT_EQ(metrics[0].name, "phase_changes");
  EXPECT_EQ(metrics[0].value, 3);
  EXPECT_EQ(metrics[1].name, "phase_one_s");
  EXPECT_NEAR(metrics[1].value, 1.5, 0.03);
  EXPECT_NEAR(metrics[2].value, 2, 0.03);
}

TEST(Phases, WhatCannotBeBuilt) {
  const auto refusal = [](const std::string& name, const Attributes& way, const Attributes& of_machine = {}) {
    PhasesWorld world;
    world.phase("one", {way});
    world.phase(name, {});
    try {
      world.build(of_machine);
    } catch (const control::ElementError& error) {
      return error.attribute + ": " + error.what();
    }
    return std::string("built");
  };
  EXPECT_EQ(refusal("two", {{"to", "two"}, {"after", "1"}}), "built");
  EXPECT_EQ(refusal("two", {{"to", "three"}, {"after", "1"}}), "to: there is no phase 'three'");
  EXPECT_EQ(refusal("one", {{"to", "one"}, {"after", "1"}}), "name: there is a phase 'one' already");
  EXPECT_EQ(refusal("time", {{"to", "one"}, {"after", "1"}}), "name: 'time' is a port of every <phases>");
  EXPECT_EQ(refusal("two", {{"to", "two"}, {"after", "1"}}, {{"start", "zero"}}), "start: there is no phase 'zero'");
}

}  // namespace
}  // namespace tactus::test
