// What only building shows: dependency order, cycles, refusals by factories, abilities that a back end lacks.

#include "dsl/compile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dsl/read_stack.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using testing::ElementsAre;

std::unique_ptr<control::Controller> compile(const std::string& text) {
  control::Registry registry = makeRegistry();
  const dsl::Stack stack = dsl::readStack(writeFile("stack.xml", text), registry, readOptions());
  return dsl::compile(stack, registry);
}

std::vector<std::string> errors(const std::string& text) {
  std::vector<std::string> found;
  try {
    compile(text);
  } catch (const dsl::InvalidStack& invalid) {
    for (const auto& diagnostic : invalid.diagnostics) {
      found.push_back(std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " +
                      diagnostic.code + " " + diagnostic.message);
      EXPECT_NE(diagnostic.source_line, "");
    }
  }
  return found;
}

std::string level(const std::string& tasks, const std::string& attributes = "") {
  return "<level priority=\"1\"" + attributes + ">\n" + tasks + "\n</level>";
}

TEST(Compile, SignalsRunInDependencyOrderWhateverTheirOrderInTheFile) {
  auto controller =
      compile(smallStack("<signals><test.probe name=\"c\" from=\"b.value\"/><test.probe name=\"b\" "
                         "from=\"a.value\"/><test.probe name=\"a\"/></signals>" +
                         level("<test.pull name=\"p\" from=\"c.value\"/>")));
  std::vector<std::string> order;
  for (const auto& named : controller->signals()) order.push_back(named.name);
  EXPECT_THAT(order, ElementsAre("a", "b", "c"));

  control::Sensed sensed;
  sensed.time = 5;
  sensed.q = sensed.qd = Eigen::VectorXd::Zero(7);
  controller->tick(sensed);
  EXPECT_EQ(controller->levels()[0].tasks[0].task->error(), 7);  // time + 1 + 1, all of this tick
}

TEST(Compile, ACircleOfSignalsIsSaidOnceWhereItCloses) {
  EXPECT_THAT(
      errors(smallStack(
          "<signals><test.probe name=\"a\" from=\"b.value\"/>\n<test.probe name=\"b\" from=\"a.value\"/></signals>" +
          level("<test.pull name=\"p\" from=\"a.value\"/>"))),
      ElementsAre("4:28 E039 signal 'a' reads itself, directly or through others"));
}

TEST(Compile, WhatAFactoryRefusesIsSaidAtItsAttribute) {
  EXPECT_THAT(errors(smallStack(level("<test.pull name=\"p\"\n stiffness=\"2000\"/>"))),
              ElementsAre("5:13 E061 no spring is that stiff"));
  EXPECT_THAT(errors(smallStack("<signals><test.probe name=\"a\" refuse=\"true\"/></signals>" +
                                level("<test.pull name=\"p\" from=\"a.value\"/>"))),
              ElementsAre("3:39 E061 this probe refuses"));
  EXPECT_THAT(errors(smallStack("<signals><test.probe name=\"a\"/></signals>" +
                                level("<test.pull name=\"p\" from=\"a.hollow\"/>"))),
              ElementsAre("4:27 E061 signal 'a' gives nothing behind its port 'hollow'"));
  EXPECT_THAT(errors(smallStack(level("<test.pull name=\"p\"/>"), "<controller backend=\"all\" tolerance=\"2\"/>")),
              ElementsAre("6:38 E061 that is no tolerance"));
}

TEST(Compile, ADefaultThatNamesWhatIsNotThereIsRefusedOnlyWhenItIsUsed) {
  const std::string signals = "<signals><contacts name=\"feel\" desired=\"fingers\"/></signals>";
  const auto stack = [&](const std::string& joints) {
    return "<stack format=\"1\"><robot model=\"lwr_allegro\"/>" + signals +
           level("<posture name=\"p\" joints=\"" + joints + "\"/>") + "<controller backend=\"all\"/></stack>";
  };
  EXPECT_THAT(errors(stack("arm")), testing::IsEmpty());
  EXPECT_THAT(errors(stack("free")), ElementsAre("2:1 E033 the stack has no signal 'touch'"));
}

TEST(Compile, WhatTheBackEndLacksIsSaidWhereItIsAskedFor) {
  const std::string none = "<controller backend=\"none\"/>";
  EXPECT_THAT(errors(smallStack(level("<test.pull name=\"p\"/>", " strict=\"true\""), none)),
              ElementsAre("3:29 E060 back end 'none' weighs levels against each other: it cannot keep one strictly; "
                          "it could be: null-space, all, first"));
  EXPECT_THAT(errors(smallStack(level("<test.guard name=\"p\"/>"), none)),
              ElementsAre("4:1 E060 <test.guard> is an inequality, and back end 'none' honours none; it could be: null-space, all"));
  EXPECT_THAT(errors(smallStack(level("<test.press name=\"p\" friction=\"0.3\"/>"), none)),
              ElementsAre("4:32 E060 back end 'none' honours no friction cones; it could be: all"));
  for (const char* tasks : {"<test.guard name=\"p\"/>", "<test.press name=\"p\" friction=\"0.3\"/>"})
    EXPECT_THAT(errors(smallStack(level(tasks, " strict=\"true\""))), testing::IsEmpty());
  EXPECT_THAT(errors(smallStack(level("<test.press name=\"p\"/>"), none)), testing::IsEmpty());
}

TEST(Compile, ABackEndMayKeepItsFirstLevelAloneStrictly) {
  const std::string first = "<controller backend=\"first\"/>", pull = "<test.pull name=\"";
  EXPECT_THAT(errors(smallStack("<level priority=\"2\" strict=\"true\">" + pull + "p\"/></level>", first)), testing::IsEmpty());
  EXPECT_THAT(errors(smallStack("<level priority=\"1\" strict=\"true\">" + pull + "p\"/></level>\n<level priority=\"2\" strict=\"true\">" +
                                    pull + "q\"/></level>", first)),
              ElementsAre("4:29 E060 back end 'first' cannot keep this level strictly: it is only strict at the top; "
                          "it could be: null-space, all"));
}

TEST(Compile, HandsOnRateGravityLevelsAndNames) {
  auto controller =
      compile(smallStack("<scene gravity=\"0 0 0\"/><level priority=\"2\" weight=\"4\"><test.pull name=\"p\"/></level>"
                         "<level priority=\"5\"><test.pull name=\"q\"/><test.guard name=\"r\"/></level>",
                         "<controller backend=\"all\" rate=\"250\"/>"));
  EXPECT_EQ(controller->period(), 0.004);
  ASSERT_EQ(controller->levels().size(), 2u);
  EXPECT_EQ(controller->levels()[0].priority, 2);
  EXPECT_EQ(controller->levels()[0].weight, 4);
  EXPECT_EQ(controller->levels()[1].tasks[1].name, "r");
  control::Sensed sensed;
  sensed.q = sensed.qd = Eigen::VectorXd::Constant(7, 0.3);
  sensed.qd.setZero();
  EXPECT_LT(controller->tick(sensed).norm(), 1e-12);  // no gravity, no torque
}

TEST(Compile, TasksAndLevelsComeAndGoAsTheirConditionsSay) {
  // The probe's value is the time, so its port is on from 0.5 s.
  auto controller = compile(smallStack(
      "<signals><test.probe name=\"clock\"/></signals>"
      "<level priority=\"1\"><test.pull name=\"always\"/><test.pull name=\"never\" active=\"false\"/>"
      "<test.pull name=\"late\" active=\"clock.value\" active-ramp=\"0\"/></level>"
      "<level priority=\"2\" active-from=\"0.2\" active-until=\"0.4\"><test.pull name=\"mid\"/></level>",
      "<controller backend=\"all\" ramp=\"0.05\"/>"));
  control::Sensed sensed;
  sensed.q = sensed.qd = Eigen::VectorXd::Zero(7);
  const auto sharesAfter = [&](int first, int last) {
    for (int k = first; k <= last; ++k) {
      sensed.time = 0.001 * k;
      controller->tick(sensed);
    }
    std::vector<double> shares;
    for (const char* task : {"always", "never", "late"}) shares.push_back(controller->activationOf(task).share());
    shares.push_back(controller->levels()[1].activation.share());
    return shares;
  };
  EXPECT_THAT(sharesAfter(0, 100), ElementsAre(1, 0, 0, 0));
  EXPECT_THAT(sharesAfter(101, 300), ElementsAre(1, 0, 0, 1));
  EXPECT_THAT(sharesAfter(301, 600), ElementsAre(1, 0, 1, 0));
  controller->setActive("never", true);
  sharesAfter(601, 610);
  EXPECT_NEAR(controller->activationOf("never").share(), 10 * 0.001 / 0.05, 1e-9);
}

TEST(Compile, HandsOnWhatTheControllerDeclares) {
  const auto given = compile(smallStack(level("<test.pull name=\"p\"/>"),
                                        "<controller backend=\"all\" torque-rate=\"30\" ramp=\"0.3\" hold=\"0.01\" "
                                        "deadline-iterations=\"5\" deadline-us=\"250\"/>"))->options();
  EXPECT_EQ(given.torque_rate, 30);
  EXPECT_EQ(given.ramp, 0.3);
  EXPECT_EQ(given.hold, 0.01);
  EXPECT_EQ(given.deadline.iterations, 5);
  EXPECT_NEAR(given.deadline.seconds, 250e-6, 1e-18);
}

TEST(Compile, AllRefusalsAreGathered) {
  EXPECT_EQ(
      errors(smallStack(level("<test.pull name=\"p\" stiffness=\"2000\"/><test.pull name=\"q\" stiffness=\"3000\"/>")))
          .size(),
      2u);
}

}  // namespace
}  // namespace tactus::dsl_test
