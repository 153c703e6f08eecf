// Drives, bodies and senses that go wrong, in the real program: the finger that presses on the floor with 0.5 N, and
// the main example, with every fault of docs/faults.md.  Whatever it is, the run ends in its time with finite torques
// within limits and bounded forces, or by a message that names what went wrong; and it tells when each fault struck.

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <optional>

#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using runtime::CsvTable;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// A run that its folder tells of.
struct Run {
  void read(const std::vector<std::string>& arguments) {
    outcome = tactus(arguments);
    run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
    log.emplace(CsvTable::read(folder.file("run/log.csv")));
  }
  void endsInItsTime() const {
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(run["status"], "done");
  }
  /// In the row of that time.
  double at(double time, const std::string& column) const {
    const std::vector<double> times = log->numbers("time"), values = log->numbers(column);
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (std::abs(times[i] - time) < std::abs(times[nearest] - time)) nearest = i;
    return values[nearest];
  }
  double largest(const std::string& column) const {
    double most = 0;
    for (const double value : log->numbers(column)) most = std::max(most, std::abs(value));
    return most;
  }
  void tells(const std::string& name, const std::string& kind, double began, std::optional<double> ended) const {
    for (const nlohmann::json& fault : run["faults"]) {
      if (fault["name"] != name) continue;
      EXPECT_EQ(fault["kind"], kind);
      EXPECT_EQ(fault["began_s"], began);
      EXPECT_EQ(fault["ended_s"], ended ? nlohmann::json(*ended) : nlohmann::json());
      EXPECT_THAT(outcome.err, HasSubstr("note: fault '" + name + "' (" + kind + ") struck from t = "));
      EXPECT_THAT(contentOf(folder.file("run/report.html")), HasSubstr("<td>" + name + "</td><td>" + kind + "</td>"));
      return;
    }
    ADD_FAILURE() << "run.json tells of no '" << name << "'";
  }

  TemporaryFolder folder;
  Outcome outcome;
  nlohmann::json run;
  std::optional<CsvTable> log;
};

constexpr double kEffort = 20;                                     // N m, of every joint of the finger
constexpr double kBefore = 1.09, kDuring = 1.39, kEnd = 2.99;

/// The finger for three seconds.
struct Finger : Run {
  explicit Finger(const std::string& faults, const std::string& objects = "") {
    std::string text = contentOf(changedStack(folder, "<signals>", "<faults>" + faults + "</faults><signals>"));
    text = replaced(text, "duration=\"1\"", "duration=\"3\"");
    text = replaced(text, "</scene>", objects + "</scene>");
    const std::string stack = folder.file("faulty.xml");
    runtime::writeFile(stack, text);
    read({"run", stack, "--out", folder.file("run")});
    for (const char* joint : {"hip", "knee", "tip"})
      for (const double torque : log->numbers(std::string("tau/") + joint)) {
        EXPECT_TRUE(std::isfinite(torque));
        EXPECT_LE(std::abs(torque), kEffort);
      }
  }
};

/// From 1.1 s, when the finger presses steadily, until 1.4 s.
std::string during(const std::string& fault) {
  const std::size_t end = fault.find("/>");
  return std::string(fault).replace(end, 0, " name=\"fault\" from=\"1.1\" until=\"1.4\"");
}

TEST(DriveFaults, OfDeadDrivesLetTheFingerLieDownAndComeBack) {
  const Finger finger(during("<torque-loss/>"));
  finger.endsInItsTime();
  finger.tells("fault", "torque-loss", 1.1, 1.4);
  EXPECT_GT(finger.at(kDuring, "q/hip") - finger.at(kBefore, "q/hip"), 0.5) << "it lies on the floor,";
  EXPECT_LT(finger.largest("contact/mean_N"), 9.81) << "with less than its weight";
  EXPECT_EQ(finger.run["ticks"]["fallback"], 0);
  EXPECT_NEAR(finger.at(kEnd, "q/hip"), finger.at(kBefore, "q/hip"), 0.05);
  EXPECT_EQ(finger.at(kDuring, "fault/fault"), 1);
  EXPECT_EQ(finger.at(kBefore, "fault/fault") + finger.at(kEnd, "fault/fault"), 0);
}

TEST(DriveFaults, OfAWeakDriveMoveTheFingerALittle) {
  const Finger finger(during("<torque-loss joints=\"knee\" factor=\"0.5\"/>"));
  finger.endsInItsTime();
  EXPECT_GT(std::abs(finger.at(kDuring, "q/hip") - finger.at(kBefore, "q/hip")), 0.01);
  EXPECT_NEAR(finger.at(kDuring, "contact/mean_N"), 0.5, 0.5);
  EXPECT_NEAR(finger.at(kEnd, "contact/mean_N"), 0.5, 0.1);
}

TEST(DriveFaults, OfStuckDrivesPressOnAsLongAsNothingElseMoves) {
  const Finger finger(during("<torque-stuck/>"));
  finger.endsInItsTime();
  finger.tells("fault", "torque-stuck", 1.1, 1.4);
  EXPECT_NEAR(finger.at(kDuring, "contact/mean_N"), 0.5, 0.1);
  EXPECT_NEAR(finger.at(kEnd, "contact/mean_N"), 0.5, 0.1);
}

TEST(DriveFaults, OfTorquesALittleLateChangeLittle) {
  const Finger finger(during("<torque-delay delay=\"0.002\"/>"));
  finger.endsInItsTime();
  finger.tells("fault", "torque-delay", 1.1, 1.4);
  EXPECT_NEAR(finger.at(kDuring, "contact/mean_N"), 0.5, 0.1);
}

TEST(DriveFaults, OfTorquesTooLateSwingAndAreCaught) {
  const Finger swings(during("<torque-delay delay=\"0.04\"/>"));
  swings.endsInItsTime();
  EXPECT_GT(swings.largest("qd/hip") + swings.largest("qd/knee") + swings.largest("qd/tip"), 1);
  EXPECT_NEAR(swings.at(kEnd, "contact/mean_N"), 0.5, 0.2) << "it calms down when it is over";

  const Finger lost("<torque-delay name=\"bus\" delay=\"0.2\"/>");
  EXPECT_EQ(lost.outcome.exit_code, 5);
  EXPECT_EQ(lost.run["status"], "plant-error");
  EXPECT_THAT(lost.outcome.err,
              AllOf(HasSubstr("runs away"), HasSubstr("Faults that struck then: 'bus' (torque-delay)")));
  lost.tells("bus", "torque-delay", 0, {});
  const double ticks = lost.run["ticks"]["total"];
  EXPECT_EQ(lost.log->numbers("time").size(), std::ceil(ticks / 10)) << "the log is whole";
}

TEST(BodyFaults, OfAHeavierLinkPressAsMuchHarder) {
  const Finger finger("<wrong-mass name=\"heavy\" link=\"distal\" factor=\"2\"/>");  // 0.1 kg more
  finger.endsInItsTime();
  finger.tells("heavy", "wrong-mass", 0, {});
  EXPECT_GT(finger.at(kEnd, "contact/mean_N"), 1);
  EXPECT_LT(finger.at(kEnd, "contact/mean_N"), 0.5 + 0.1 * 9.81 + 0.2);
}

TEST(BodyFaults, OfALoadThatComesAndGoesAreCarriedByTheContact) {
  const Finger finger(during("<wrong-mass link=\"distal\" added=\"0.1\" point=\"0.05 0 0\"/>"));
  finger.endsInItsTime();
  finger.tells("fault", "wrong-mass", 1.1, 1.4);
  EXPECT_NEAR(finger.at(kBefore, "contact/mean_N"), 0.5, 0.1);
  EXPECT_NEAR(finger.at(kDuring, "contact/mean_N"), 0.5 + 0.1 * 9.81, 0.2);
  EXPECT_NEAR(finger.at(kEnd, "contact/mean_N"), 0.5, 0.1);
}

TEST(BodyFaults, OfAShoveGiveWayAndComeBack) {
  const Finger finger(during("<shove link=\"distal\" force=\"0 0 2\"/>"));
  finger.endsInItsTime();
  finger.tells("fault", "shove", 1.1, 1.4);
  EXPECT_EQ(finger.at(kDuring, "contact/mean_N"), 0) << "lifted off";
  EXPECT_LT(finger.largest("contact/mean_N"), 10);
  EXPECT_NEAR(finger.at(kEnd, "contact/mean_N"), 0.5, 0.15);
}

TEST(BodyFaults, OfJointsThatRubKeepAShoveFromMovingThem) {
  const std::string shove = "<shove name=\"push\" link=\"distal\" force=\"0 0 2\" from=\"1.1\" until=\"1.4\"/>";
  const Finger slips(shove), rubs(shove + during("<joint-friction torque=\"2\"/>")),
      little(shove + during("<joint-friction of-effort=\"0.001\"/>"));
  for (const Finger* finger : {&rubs, &little}) {
    finger->endsInItsTime();
    finger->tells("fault", "joint-friction", 1.1, 1.4);
    EXPECT_NEAR(finger->at(kEnd, "contact/mean_N"), 0.5, 0.3) << "and it is free again";
  }
  const auto moved = [](const Finger& finger) { return std::abs(finger.at(kDuring, "q/hip") - finger.at(kBefore, "q/hip")); };
  EXPECT_GT(moved(slips), 0.02);
  EXPECT_LT(moved(rubs), 1e-3);
  EXPECT_GT(moved(little), 0.5 * moved(slips)) << "0.02 N m hardly hold it";
}

TEST(BodyFaults, OfARobotThatIsLighterLetItsContactsGo) {
  const Finger finger(during("<wrong-mass links=\"all\" factor=\"0.7\"/>"));
  finger.endsInItsTime();
  finger.tells("fault", "wrong-mass", 1.1, 1.4);
  EXPECT_EQ(finger.at(kDuring, "contact/mean_N"), 0) << "a weight that is not there is borne";
}

TEST(BodyFaults, OfAShoveThatIsTooMuchEndTheRunByName) {
  const Finger finger("<shove name=\"blast\" link=\"medial\" force=\"0 0 20000\" from=\"1.1\"/>");
  EXPECT_EQ(finger.outcome.exit_code, 5);
  EXPECT_EQ(finger.run["status"], "plant-error");
  EXPECT_THAT(finger.run["message"].get<std::string>(), HasSubstr("Faults that struck then: 'blast' (shove)"));
  finger.tells("blast", "shove", 1.1, {});
}

TEST(BodyFaults, OfAnObjectThatIsShovedShowInItsMotion) {
  const Finger finger("<shove name=\"kick\" object=\"puck\" impulse=\"0.2 0 0\" from=\"1.1\" until=\"1.1004\"/>",
                      "<object name=\"puck\" pose=\"0 0.5 0.02\" mobility=\"free\" mass=\"0.4\" friction=\"0.3\">"
                      "<cylinder radius=\"0.05\" length=\"0.04\"/></object>");
  finger.endsInItsTime();
  EXPECT_NEAR(finger.at(kBefore, "object/puck/x"), 0, 1e-3);
  // It sets off with p/m = 0.5 m/s, and friction (the smaller μ, 0.2) takes that within v²/2μg.
  EXPECT_NEAR(finger.at(kEnd, "object/puck/x"), 0.5 * 0.5 / (2 * 0.2 * 9.81), 0.02);
  EXPECT_NEAR(finger.at(kEnd, "contact/mean_N"), 0.5, 0.1) << "and the finger does not care";
}

TEST(SenseFaults, AmongTheFaultsStrikeWhatAllSensorsTell) {
  const Finger finger(during("<fault kind=\"dropped\" links=\"distal\" of=\"skin\"/>") +
                      "</faults><sensors><skin name=\"skin\" links=\"distal\"/></sensors><faults>");
  finger.endsInItsTime();
  finger.tells("fault", "dropped", 1.1, 1.4);
  EXPECT_GT(finger.at(kBefore, "sensor/skin/force"), 0.3);
  EXPECT_EQ(finger.at(kDuring, "sensor/skin/force"), 0);
  EXPECT_EQ(finger.at(kDuring, "signal/touch/held"), 0);
}

TEST(SenseFaults, OfEveryKindTellWhenTheyStruck) {
  for (const auto& [kind, what] : std::map<std::string, std::string>{{"dropped", "links=\"distal\""},
                                                                     {"stuck", "links=\"distal\" joints=\"knee\""},
                                                                     {"nan", "links=\"distal\" joints=\"knee\""},
                                                                     {"jump", "joints=\"knee\""},
                                                                     {"late", "delay=\"0.005\""}}) {
    const Finger finger(during("<fault kind=\"" + kind + "\" " + what + "/>"));
    finger.endsInItsTime();
    finger.tells("fault", kind, 1.1, 1.4);
    EXPECT_LT(finger.largest("contact/mean_N"), 10) << kind;
  }
}

TEST(Faults, ThatBeginAfterTheRunAreToldToo) {
  const Finger finger("<torque-loss name=\"late\" from=\"3\"/>");
  finger.endsInItsTime();
  EXPECT_TRUE(finger.run["faults"][0]["began_s"].is_null());
  EXPECT_THAT(finger.outcome.err, HasSubstr("note: fault 'late' (torque-loss) never struck: its time is not that of a tick of this run"));
}

TEST(Faults, RepeatToTheByte) {
  const std::string faults = during("<torque-delay delay=\"0.003\"/>") +
                             "<wrong-mass name=\"load\" link=\"medial\" added=\"0.1\" from=\"0.5\"/>"
                             "<shove name=\"push\" link=\"medial\" force=\"0 1 1\" from=\"1\"/>";
  const Finger first(faults), second(faults);
  EXPECT_EQ(contentOf(first.folder.file("run/log.csv")), contentOf(second.folder.file("run/log.csv")));
}

TEST(Faults, GoIntoTheResolvedStackThatRunsAlike) {
  const Finger first(during("<torque-loss joints=\"knee\" factor=\"0.5\"/>") +
                     "<fault name=\"slow\" kind=\"late\" delay=\"0.002\"/>");
  const std::string resolved = first.folder.file("run/stack.resolved.xml");
  const Outcome again = tactus({"run", resolved, "--out", first.folder.file("again")});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(contentOf(first.folder.file("run/log.csv")), contentOf(first.folder.file("again/log.csv")));
}

/// The main example for five seconds, 1.6 s in contact; faults strike from 3.5 s until 4 s.
struct Exploration : Run {
  explicit Exploration(const std::string& fault) {
    std::string text = contentOf(TACTUS_SOURCE_DIR "/examples/explore_table/stack.xml");
    const std::string window = std::string(" name=\"fault\"") +
                               (fault.find("from=") == std::string::npos ? " from=\"3.5\" until=\"4\"/>" : "/>");
    text = replaced(text, "<signals>", "<faults>" + replaced(fault, "/>", window) + "</faults><signals>");
    text = replaced(text, "columns=\"default\"", "columns=\"all\"");
    const std::string stack = folder.file("faulty.xml");
    runtime::writeFile(stack, text);
    read({"run", stack, "--duration", "5", "--out", folder.file("run")});
    for (const std::string& column : log->columns()) {
      if (!column.starts_with("tau/")) continue;
      for (const double torque : log->numbers(column)) EXPECT_TRUE(std::isfinite(torque));
    }
  }
  double metric(const char* name) const { return run["metrics"][name].get<double>(); }
};

struct Case {
  const char* name;
  const char* fault;
  double desired, undesired;                                       // N, the largest forces that are let through
};

/// The larger forces are those of a hand that falls on the table, and of one that does not feel what it presses on.
class MainExample : public ::testing::TestWithParam<Case> {};

TEST_P(MainExample, GoesOnWithBoundedForces) {
  const Exploration run(GetParam().fault);
  run.endsInItsTime();
  EXPECT_EQ(run.run["ticks"]["total"], 5000);
  EXPECT_LT(run.metric("contact_force_peak_N"), GetParam().desired);
  EXPECT_LT(run.metric("undesired_force_peak_N"), GetParam().undesired);
  EXPECT_FALSE(run.run["faults"][0]["began_s"].is_null());
  // It goes on: at the end fingers press again, as hard as they should.
  EXPECT_GE(run.at(4.99, "contact/links"), 1);
  EXPECT_LT(run.at(4.99, "contact/max_N"), 2);
}

INSTANTIATE_TEST_SUITE_P(
    Faults, MainExample,
    ::testing::Values(Case{"ArmAtHalf", "<torque-loss joints=\"arm\" factor=\"0.5\"/>", 40, 50},
                      Case{"AllDead", "<torque-loss/>", 80, 140},
                      Case{"AllStuck", "<torque-stuck/>", 4, 4},
                      Case{"TwoMillisecondsLate", "<torque-delay delay=\"0.002\" from=\"0\"/>", 2, 2},
                      Case{"Loaded", "<wrong-mass link=\"palm\" added=\"0.5\"/>", 6, 4},
                      Case{"HeavierHand", "<wrong-mass link=\"palm\" factor=\"1.3\" from=\"0\"/>", 4, 4},
                      Case{"PushedDown", "<shove link=\"palm\" force=\"0 0 -10\"/>", 10, 4},
                      Case{"SkinDropped", "<fault kind=\"dropped\" links=\"fingers\"/>", 25, 4},
                      Case{"SkinStuck", "<fault kind=\"stuck\" links=\"fingers\"/>", 3, 3},
                      Case{"NoNumbers", "<fault kind=\"nan\" links=\"fingers\" joints=\"a4\"/>", 20, 4},
                      Case{"EncoderJumps", "<fault kind=\"jump\" joints=\"a4\" offset=\"0.05\"/>", 3, 3}),
    [](const auto& info) { return info.param.name; });

TEST(LostExample, OfTorquesFourMillisecondsLateSaysSo) {
  const Exploration run("<torque-delay delay=\"0.004\" from=\"0\"/>");
  EXPECT_EQ(run.outcome.exit_code, 5);
  EXPECT_EQ(run.run["status"], "plant-error");
  EXPECT_THAT(run.outcome.err,
              AllOf(HasSubstr("runs away"), HasSubstr("Faults that struck then: 'fault' (torque-delay)"),
                    HasSubstr("was faster than its velocity limit")));
  run.tells("fault", "torque-delay", 0, {});
  const double last = run.log->numbers("time").back();
  EXPECT_GT(last, 0.05);
  EXPECT_LE(last, run.run["duration_s"].get<double>());
  for (const std::string& column : run.log->columns()) {
    if (!column.starts_with("q/") && !column.starts_with("qd/")) continue;
    EXPECT_TRUE(std::isfinite(run.log->numbers(column).back())) << column;
  }
}

}  // namespace
}  // namespace tactus::testing
