#include <gmock/gmock.h>

#include <algorithm>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(CheckCommand, GoodStack) {
  const Outcome outcome = tactus({"check", data("press.xml")});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out, data("press.xml") + ": ok\n");
}

TEST(CheckCommand, GoodStackAsJson) {
  const Outcome outcome = tactus({"check", data("press.xml"), "--json"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_TRUE(outcome.json()["errors"].empty());
}

TEST(CheckCommand, MisspelledAttributeIsLocated) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "stiffness=", "stifness=");
  const Outcome outcome = tactus({"check", "--json", stack});
  EXPECT_EQ(outcome.exit_code, 3);
  const nlohmann::json error = outcome.json()["errors"].at(0);
  EXPECT_EQ(error["file"], stack);
  const std::string content = contentOf(stack);
  const size_t at = content.find("stifness"), line_start = content.rfind('\n', at) + 1;
  const auto line = std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
  EXPECT_EQ(error["line"], line);
  EXPECT_EQ(error["column"], at - line_start + 1);
  EXPECT_EQ(error["code"], "E012");
  EXPECT_EQ(error["suggestion"], "stiffness");
  EXPECT_THAT(error["message"].get<std::string>(), HasSubstr("stifness"));

  const Outcome talk = tactus({"check", stack});
  EXPECT_EQ(talk.exit_code, 3);
  EXPECT_EQ(talk.out, "");
  EXPECT_THAT(talk.err, StartsWith(stack + ":" + std::to_string(line) + ":" + std::to_string(at - line_start + 1) +
                                   ": error[E012]: <posture> has no attribute 'stifness'\n"));
  EXPECT_THAT(talk.err, HasSubstr("^^^^^^^^ did you mean 'stiffness'?"));
}

TEST(CheckCommand, EveryFileIsChecked) {
  const TemporaryFolder first, second;
  const std::string a = changedStack(first, "stiffness=\"1\"", "stiffness=\"nan\"");
  const std::string b = changedStack(second, "distal", "dital");
  const Outcome outcome = tactus({"check", "--json", a, data("press.xml"), b});
  EXPECT_EQ(outcome.exit_code, 3);
  const nlohmann::json errors = outcome.json()["errors"];
  ASSERT_EQ(errors.size(), 2u);
  EXPECT_EQ(errors[0]["file"], a);
  EXPECT_EQ(errors[1]["file"], b);
  EXPECT_EQ(errors[1]["suggestion"], "distal");
}

TEST(CheckCommand, MissingFileIsNoInvalidStack) {
  const Outcome outcome = tactus({"check", "/nowhere/stack.xml", "--json"});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.json()["errors"][0]["message"].get<std::string>(),
              HasSubstr("cannot be opened"));
}

TEST(CheckCommand, MissingModelIsAnInvalidStack) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"check", changedStack(folder, "finger.urdf", "toe.urdf")});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("toe.urdf"));
}

TEST(CheckCommand, ARobotWithACoupledJointIsAnInvalidStack) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "press", "press");
  std::string robot = contentOf(folder.file("finger.urdf"));
  const std::string driven = "<parent link=\"proximal\"/>";
  robot.insert(robot.find(driven), "<mimic joint=\"hip\"/>");
  folder.write("finger.urdf", robot);
  for (const char* command : {"check", "run"}) {
    const Outcome outcome = tactus({command, stack});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("finger.urdf:21:3: error[E054]: joint 'knee' follows joint 'hip': a stack runs "
                                       "robots whose joints are revolute, continuous, prismatic or fixed and move on "
                                       "their own\n"));
  }
}

TEST(CheckCommand, MissingPluginIsExitFour) {
  const TemporaryFolder folder;
  const Outcome outcome =
      tactus({"check", changedStack(folder, "<robot", "<plugin name=\"acme\"/>\n  <robot"), "--json"});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.json()["errors"][0]["message"].get<std::string>(),
              AllOf(HasSubstr("plugin 'acme' was not found"), HasSubstr("acme.so: no such file")));
}

TEST(CheckCommand, SettingsReachTheParameters) {
  EXPECT_EQ(tactus({"check", data("press.xml"), "--set", "press=0.8"}).exit_code, 0);
  EXPECT_EQ(tactus({"check", data("press.xml"), "--set", "pres=0.8"}).exit_code, 3);
  EXPECT_EQ(tactus({"check", data("press.xml"), "--set", "press"}).exit_code, 2);
}

TEST(CheckCommand, AnotherBackEndIsCheckedInstead) {
  EXPECT_EQ(tactus({"check", data("press.xml"), "--backend", "qp/nlopt"}).exit_code, 0);
  const Outcome outcome = tactus({"check", data("press.xml"), "--backend", "magic"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("there is no back end 'magic'; back ends: hqp, null-space, qp"));
}

TEST(CheckCommand, WhatRunCannotDoIsNoGoodStack) {
  const auto says = [](const std::string& from, const std::string& to) {
    const TemporaryFolder folder;
    const Outcome outcome = tactus({"check", changedStack(folder, from, to)});
    EXPECT_EQ(outcome.exit_code, 3) << to;
    return outcome.err;
  };
  EXPECT_THAT(says("rate=\"1000\"", "rate=\"3000\""),
              HasSubstr(":14:42: error[E055]: at 3000 Hz a tick is not a whole number of the plant's steps of 0.00025 s: "
                        "the nearest rates are 2000 and 4000 Hz"));
  EXPECT_THAT(says("rate=\"1000\"", "rate=\"8000\""), HasSubstr("the highest rate is 4000 Hz"));
  EXPECT_THAT(says("rate=\"1000\"", "rate=\"0.5\""), HasSubstr("expected a number ≥ 1 (Hz)"));
  EXPECT_THAT(says("duration=\"1\"", "duration=\"1e9\""), HasSubstr("expected a number > 0 and ≤ 1e+06 (s)"));
  EXPECT_THAT(says("duration=\"1\"", "duration=\"0.0001\""),
              HasSubstr(":15:18: error[E014]: attribute 'duration': 1e-04 s is shorter than one tick of 0.001 s"));
}

TEST(CheckCommand, TorqueLimitsAtALevelAndForceBoundsNeedABackEndThatHasThem) {
  const TemporaryFolder first, second;
  const std::string limits = changedStack(first, "<controller ", "<controller torque-limits-priority=\"2\" ");
  EXPECT_THAT(tactus({"check", limits, "--backend", "null-space"}).err,
              HasSubstr("back end 'null-space' cannot put torque limits at a level; it could be: hqp"));
  EXPECT_EQ(tactus({"check", limits, "--backend", "hqp"}).exit_code, 0);
  const std::string bounded = changedStack(second, "<contact-force ", "<contact-force force-max=\"2\" ");
  EXPECT_THAT(tactus({"check", bounded, "--backend", "null-space"}).err,
              HasSubstr("back end 'null-space' honours no bounds of contact forces; it could be: hqp, qp"));
  EXPECT_EQ(tactus({"check", bounded, "--backend", "qp"}).exit_code, 0);
}

TEST(CheckCommand, TheSuccessiveCascadeKeepsItsFirstLevelStrictly) {
  const TemporaryFolder first, second;
  const std::string cascade = "null-space/successive";
  const std::string top = changedStack(first, "<level priority=\"1\">", "<level priority=\"1\" strict=\"true\">");
  EXPECT_EQ(tactus({"check", top, "--backend", cascade}).exit_code, 0);
  EXPECT_THAT(tactus({"check", top, "--backend", "qp"}).err,
              HasSubstr("back end 'qp' weighs levels against each other: it cannot keep one strictly"));
  const std::string low = changedStack(second, "<level priority=\"2\">", "<level priority=\"2\" strict=\"true\">");
  EXPECT_EQ(tactus({"check", low}).exit_code, 0) << "every level of the augmented cascade is strict";
  const Outcome outcome = tactus({"check", low, "--backend", cascade});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("back end 'null-space' cannot keep this level strictly: the successive cascade keeps "
                                     "only its first level strictly"));
}

TEST(CheckCommand, WarnsOfATargetThatNoRunCanReach) {
  const auto check = [](const std::string& metric, const std::vector<std::string>& more = {}) {
    const TemporaryFolder folder;
    std::vector<std::string> words{"check", changedStack(folder, "<run duration=\"1\" seed=\"1\">",
                                                         "<run duration=\"1\" seed=\"1\">\n<target metric=\"" + metric +
                                                             "\" upper=\"1\"/>")};
    words.insert(words.end(), more.begin(), more.end());
    return tactus(words);
  };
  const Outcome slip = check("contact_force_maen_N");
  EXPECT_EQ(slip.exit_code, 0);
  EXPECT_THAT(slip.err, AllOf(HasSubstr("stack.xml:16:17: warning[W013]: no run of this stack has a figure "
                                        "'contact_force_maen_N'\n"),
                              HasSubstr("did you mean 'contact_force_mean_N'?")));
  EXPECT_EQ(check("contact_force_maen_N", {"--strict"}).exit_code, 3);
  for (const char* known : {"contact_force_mean_N", "points_touched", "undesired_force_peak_N"})
    EXPECT_EQ(check(known).err, "") << known;
}

TEST(CheckCommand, KnowsTheFiguresOfAFeatureBeforeItIsFound) {
  const Outcome outcome = tactus({"check", std::string(TACTUS_SOURCE_DIR) + "/examples/explore_table/stack.xml"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.err, "") << "it has a target bump_position_error_m";
}

TEST(CheckCommand, NamesTheParameterThatBroughtAValue) {
  const TemporaryFolder folder;
  const std::string stack =
      changedStack(folder, "<robot ", "<parameter name=\"stiff\" value=\"1,5\"/>\n<robot ");
  std::string text = contentOf(stack);
  text.replace(text.find("stiffness=\"1\""), 13, "stiffness=\"${stiff}\"");
  folder.write("stack.xml", text);
  const std::string place = text.substr(0, text.find("<parameter name=\"stiff\""));
  const auto line = 1 + std::count(place.begin(), place.end(), '\n');
  EXPECT_THAT(tactus({"check", stack}).err,
              HasSubstr("'1,5' is not a number: expected a number ≥ 0 (N m/rad); numbers are separated by blanks, not by "
                        "commas; the value comes from parameter 'stiff' at " +
                        stack + ":" + std::to_string(line) + ":"));
  EXPECT_THAT(tactus({"check", stack, "--set", "stiff=x"}).err,
              HasSubstr("'x' is not a number: expected a number ≥ 0 (N m/rad); the value comes from --set stiff=x\n"));
}

TEST(CheckCommand, UnknownAttributeWithoutANearNameListsTheOthers) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"check", changedStack(folder, "stiffness=", "zzzzzz=")});
  EXPECT_THAT(outcome.err, HasSubstr("<posture> has no attribute 'zzzzzz'; it takes name, class, joints, among, stiffness, "
                                     "damping, q, swing, swing-rate, on, desired, delay, active, "
                                     "active-from, active-until, active-ramp\n"));
}

}  // namespace
}  // namespace tactus::testing
