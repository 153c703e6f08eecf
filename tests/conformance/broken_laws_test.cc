// The kit finds what is wrong, and nothing else: each element of plugins/lawless.cc breaks the one law that it is named
// after, and those that are good break none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "conformance/bench.h"
#include "conformance/conformance.h"

namespace tactus::conformance {
namespace {

using ::testing::HasSubstr;

class Lawless : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    workshop = new Workshop({LAWLESS});
    stack = new dsl::Stack(workshop->read(TACTUS_SOURCE_DIR "/tests/conformance/lawless.xml"));
  }
  static void TearDownTestSuite() {
    delete stack;
    delete workshop;
  }
  static Report check(const std::string& element) { return checkElements(workshop->registry(), {element}, stack); }

  /// The law that the element breaks, which must be the only one, and what is said of it.
  static std::pair<std::string, std::string> broken(const std::string& element) {
    std::pair<std::string, std::string> found;
    const Report report = check(element);
    EXPECT_FALSE(report.findings.empty()) << element;
    for (const Finding& finding : report.findings) {
      if (finding.outcome != Outcome::broken) continue;
      EXPECT_EQ(found.first, "") << element << " breaks more than one law:\n" << report.text();
      found = {finding.law, finding.message};
    }
    EXPECT_EQ(report.conforms(), found.first.empty());
    return found;
  }

  static Workshop* workshop;
  static dsl::Stack* stack;
};
Workshop* Lawless::workshop = nullptr;
dsl::Stack* Lawless::stack = nullptr;

#define EXPECT_BREAKS(element, law, message)                \
  {                                                         \
    const auto [broken_law, said] = broken(element);        \
    EXPECT_EQ(broken_law, law) << element;                  \
    EXPECT_THAT(said, HasSubstr(message)) << element;       \
  }

TEST_F(Lawless, GoodOnesBreakNone) {
  for (const char* element : {"lawless.good", "lawless.good-untold", "lawless.clock-good", "lawless.sum-good"})
    EXPECT_EQ(broken(element).first, "") << check(element).text();
}

TEST_F(Lawless, NothingIsLeftOutOfOneThatAsksForAccelerations) {
  for (const Finding& finding : check("lawless.good").findings)
    EXPECT_EQ(finding.outcome, Outcome::kept) << finding.law;
}

TEST_F(Lawless, Tasks) {
  EXPECT_BREAKS("lawless.jacobian", "jacobian", "joint 'a2': J says ");
  EXPECT_BREAKS("lawless.jacobian-untold", "jacobian", "for a unit motion that J does not see");
  EXPECT_BREAKS("lawless.bias", "bias", "differences of J say");
  EXPECT_BREAKS("lawless.frame", "frame", "the moved robot's joint torques differ by ");
  EXPECT_BREAKS("lawless.allocation", "allocation", "update 1 took memory");
  EXPECT_BREAKS("lawless.determinism", "determinism", "a second instance gave other numbers");
  EXPECT_BREAKS("lawless.state", "state", "its doArchive must name all that it carries");
  EXPECT_BREAKS("lawless.instance", "instance", "the licence server is on holiday");
  EXPECT_BREAKS("lawless.attributes", "attributes", "no instance reads the attribute 'idle'");
  EXPECT_BREAKS("lawless.schema", "schema", "attribute 'frame' has no description");
  EXPECT_BREAKS("lawless.schema-unit", "schema", "attribute 'target' is a number without a unit");
}

/// Rows that nobody can use are asked nothing else.
TEST_F(Lawless, Rows) {
  EXPECT_BREAKS("lawless.rows", "rows", "it fills 4 rows, but announced at most 3");
  EXPECT_BREAKS("lawless.rows-nan", "rows", "J or F is not finite");
}

TEST_F(Lawless, Signals) {
  EXPECT_BREAKS("lawless.clock-ports", "ports", "nothing stands behind the declared port 'now'");
  EXPECT_BREAKS("lawless.clock-ports-moving", "ports", "port 'now' moved to another address");
  EXPECT_BREAKS("lawless.clock-ports-nan", "ports", "port 'now' is not finite");
  EXPECT_BREAKS("lawless.clock-allocation", "allocation", "update 1 took memory 1 times");
  EXPECT_BREAKS("lawless.clock-determinism", "determinism", "a second instance");
  EXPECT_BREAKS("lawless.clock-state", "state", "restored in the middle of a run");
  EXPECT_BREAKS("lawless.clock-schema", "schema", "port 'now' has no description");
}

TEST_F(Lawless, Shapes) {
  EXPECT_TRUE(check("lawless.ball-good").conforms()) << check("lawless.ball-good").text();
  EXPECT_BREAKS("lawless.ball-distance-bound", "bounding", "out of its bounding sphere");
  EXPECT_BREAKS("lawless.ball-convexity", "convex", "above the mean");
  EXPECT_BREAKS("lawless.ball-support", "support", "off the surface");
  EXPECT_BREAKS("lawless.ball-allocation", "allocation", "distances take memory");
  EXPECT_BREAKS("lawless.ball-determinism", "determinism", "asked again, it answers otherwise");
  EXPECT_THAT(check("lawless.ball-gradient").text(), HasSubstr("broken: gradient: gradient and differences are 2 apart"));
  EXPECT_THAT(check("lawless.ball-distance").text(), HasSubstr("broken: lipschitz: the distance changes by more"));
}

TEST_F(Lawless, Sensors) {
  EXPECT_TRUE(check("lawless.scale-good").conforms()) << check("lawless.scale-good").text();
  EXPECT_BREAKS("lawless.scale-felt", "felt", "a reading is infinite");
  EXPECT_BREAKS("lawless.scale-allocation", "allocation", "tick 1 took memory 1 times");
  EXPECT_BREAKS("lawless.scale-determinism", "determinism", "felt something else");
  EXPECT_BREAKS("lawless.scale-state", "state", "restored in the middle of a run");
  EXPECT_THAT(check("lawless.scale-felt-joints").text(), HasSubstr("broken: felt: it changed the number of joints"));
}

TEST_F(Lawless, Controllers) {
  EXPECT_TRUE(check("lawless.owner-good").conforms()) << check("lawless.owner-good").text();
  EXPECT_BREAKS("lawless.owner-tasks", "tasks", "it owns no task");
  EXPECT_BREAKS("lawless.owner-allocation", "allocation", "update 1 took memory");
  EXPECT_BREAKS("lawless.owner-determinism", "determinism", "a second instance");
  EXPECT_BREAKS("lawless.owner-state", "state", "restored in the middle of a run");
  EXPECT_BREAKS("lawless.owner-jacobian", "jacobian", "differences of its displacement say");
  EXPECT_BREAKS("lawless.owner-frame", "frame", "the moved robot's joint torques differ");
}

TEST_F(Lawless, Measures) {
  EXPECT_TRUE(check("lawless.gauge-good").conforms()) << check("lawless.gauge-good").text();
  EXPECT_BREAKS("lawless.gauge-figures-none", "figures", "it has no figure and no column");
  EXPECT_BREAKS("lawless.gauge-figures-renamed", "figures", "its figure 'sum_N' becomes 'force'");
  EXPECT_BREAKS("lawless.gauge-figures", "figures", "its figure 'inverse' is infinite");
  EXPECT_BREAKS("lawless.gauge-allocation", "allocation", "took memory 1 times");
  EXPECT_BREAKS("lawless.gauge-determinism", "determinism", "a second instance said something else");
  EXPECT_BREAKS("lawless.gauge-state", "state", "");
}

TEST_F(Lawless, Recorders) {
  EXPECT_TRUE(check("lawless.tally-good").conforms()) << check("lawless.tally-good").text();
  EXPECT_BREAKS("lawless.tally-files", "files", "it left no file in the run folder");
  EXPECT_BREAKS("lawless.tally-files-throws", "files", "recorder 'specimen' failed at t = 0 s: no pencil");
  EXPECT_BREAKS("lawless.tally-determinism", "determinism", "no wall-clock time goes into results");
}

TEST_F(Lawless, BackEnds) {
  EXPECT_BREAKS("lawless.sum-torque", "torque", "its torque is beyond them");
  EXPECT_BREAKS("lawless.sum-torque-nan", "torque", "it solved none of 80 ticks");
  EXPECT_BREAKS("lawless.sum-determinism", "determinism", "a second instance gave another torque");
}

TEST_F(Lawless, WhatCannotBeMadeFromDefaultsAsksForAStack) {
  control::Registry registry = workshop->registry();
  control::ElementRow row;
  row.name = "lawless.needy";
  row.description = "Needs a file.";
  row.attributes = {{.name = "map", .type = control::ValueType::file, .required = true, .description = "A file."}};
  registry.addTask(row, [](const control::BuildContext&) { return nullptr; });
  const Report report = checkElements(registry, {"lawless.needy"});
  EXPECT_FALSE(report.conforms());
  EXPECT_THAT(report.text(), HasSubstr("<lawless.needy> requires 'map', and nothing tells what may stand there; give a "
                                       "stack that holds one (--stack FILE)"));
}

}  // namespace
}  // namespace tactus::conformance
