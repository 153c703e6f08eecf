// Sensors of the plugin `senses` in closed loop, in the real program: the finger that comes down on the floor and
// presses, first felt as it should be, then with every fault.  Whatever it is, the run ends in its time, with finite
// torques within limits, and in a state that docs/senses.md tells.

#include <gmock/gmock.h>

#include <cmath>
#include <optional>

#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using runtime::CsvTable;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kEffort = 20;                                     // N m, of every joint of the finger

/// The small stack for two seconds, with these sensors.
struct Felt {
  explicit Felt(const std::string& sensors) {
    std::string text = contentOf(changedStack(folder, "<signals>", "<sensors>" + sensors + "</sensors><signals>"));
    const std::string duration = "duration=\"1\"";
    text.replace(text.find(duration), duration.size(), "duration=\"2\"");
    const std::string stack = folder.file("felt.xml");
    runtime::writeFile(stack, text);
    outcome = tactus({"run", stack, "--out", folder.file("run")});
    run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
    log.emplace(CsvTable::read(folder.file("run/log.csv")));
    for (const char* joint : {"hip", "knee", "tip"})
      for (const double torque : log->numbers(std::string("tau/") + joint)) {
        EXPECT_TRUE(std::isfinite(torque));
        EXPECT_LE(std::abs(torque), kEffort);
      }
  }

  void endsInItsTime() const {
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(run["status"], "done");
    EXPECT_EQ(run["ticks"]["total"], 2000);
  }
  /// In the row of that time.
  double at(double time, const std::string& column) const {
    const std::vector<double> times = log->numbers("time"), values = log->numbers(column);
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < times.size(); ++i)
      if (std::abs(times[i] - time) < std::abs(times[nearest] - time)) nearest = i;
    return values[nearest];
  }
  std::vector<std::string> warnings() const { return run["warnings"].get<std::vector<std::string>>(); }

  TemporaryFolder folder;
  Outcome outcome;
  nlohmann::json run;
  std::optional<CsvTable> log;
};

const std::string skin = "<skin name=\"skin\" links=\"distal\"/>";
/// From 1.1 s, when the finger presses steadily, until 1.4 s.
std::string fault(const std::string& attributes) {
  return skin + "<fault name=\"fault\" from=\"1.1\" until=\"1.4\" " + attributes + "/>";
}
constexpr double kBefore = 1.09, kDuring = 1.39, kEnd = 1.99;

TEST(Senses, OfTaxelsPressAsTheContactsThemselvesDo) {
  const Felt felt(skin);
  felt.endsInItsTime();
  EXPECT_THAT(felt.warnings(), ElementsAre());
  EXPECT_NEAR(felt.at(kEnd, "contact/mean_N"), 0.5, 0.05);
  EXPECT_NEAR(felt.at(kEnd, "sensor/skin/force"), felt.at(kEnd, "contact/mean_N"), 0.03) << "but what is below thresholds";
  EXPECT_GE(felt.at(kEnd, "sensor/skin/active"), 3);
}

TEST(Senses, WithNoiseStepsAndFiltersStillPress) {
  const Felt felt("<encoders name=\"angles\" joints=\"hip knee tip\" delay=\"0.001\"/>"
                  "<skin name=\"skin\" links=\"distal\" noise=\"0.005\" threshold=\"0.02\" range=\"5\" levels=\"255\" "
                  "dead=\"0.05\" rate=\"250\" delay=\"0.004\"/>"
                  "<force-torque name=\"wrist\" link=\"distal\" force-noise=\"0.01\" cutoff=\"50\"/>");
  felt.endsInItsTime();
  EXPECT_THAT(felt.warnings(), ElementsAre());
  EXPECT_NEAR(felt.at(kEnd, "contact/mean_N"), 0.5, 0.1);
  // What the last link weighs, 0.981 N, less what the floor bears.
  EXPECT_NEAR(felt.at(kEnd, "sensor/wrist/force"), 0.981 - felt.at(kEnd, "contact/mean_N"), 0.05);
}

TEST(Senses, RepeatToTheByte) {
  const std::string noisy = "<skin name=\"skin\" links=\"distal\" noise=\"0.005\" threshold=\"0.02\" drift=\"0.01\"/>"
                            "<encoders name=\"angles\" joints=\"knee\" noise=\"1e-5\"/>";
  const Felt first(noisy), second(noisy);
  EXPECT_EQ(contentOf(first.folder.file("run/log.csv")), contentOf(second.folder.file("run/log.csv")));
}

TEST(Faults, OfADroppedPatchLookLikeNoTouch) {
  const Felt felt(fault("kind=\"dropped\" links=\"distal\" of=\"skin\""));
  felt.endsInItsTime();
  EXPECT_THAT(felt.warnings(), ElementsAre());
  EXPECT_EQ(felt.at(kDuring, "sensor/fault/active"), 1);
  EXPECT_EQ(felt.at(kDuring, "sensor/skin/force"), 0);
  EXPECT_EQ(felt.at(kDuring, "signal/touch/held"), 0) << "the task on the contact has let go";
  EXPECT_LT(felt.at(kDuring, "contact/mean_N"), 1) << "the posture alone holds the finger there";
  EXPECT_EQ(felt.at(kEnd, "sensor/fault/active"), 0);
  EXPECT_NEAR(felt.at(kEnd, "contact/mean_N"), 0.5, 0.05);
}

TEST(Faults, OfAStuckPatchPressOn) {
  const Felt felt(fault("kind=\"stuck\" links=\"distal\" of=\"skin\""));
  felt.endsInItsTime();
  EXPECT_EQ(felt.at(kDuring, "sensor/skin/force"), felt.at(1.2, "sensor/skin/force"));
  EXPECT_EQ(felt.at(kDuring, "signal/touch/held"), 1);
  EXPECT_NEAR(felt.at(kDuring, "contact/mean_N"), 0.5, 0.1);
  EXPECT_NEAR(felt.at(kEnd, "contact/mean_N"), 0.5, 0.05);
}

TEST(Faults, OfAStuckJointAreBorneByTheOthers) {
  const Felt felt(fault("kind=\"stuck\" joints=\"knee\""));
  felt.endsInItsTime();
  EXPECT_EQ(felt.at(kDuring, "q/knee"), felt.at(1.2, "q/knee")) << "as it is felt";
  EXPECT_EQ(felt.at(kDuring, "qd/knee"), 0);
  EXPECT_NEAR(felt.at(kDuring, "contact/mean_N"), 0.5, 0.1);
  EXPECT_NEAR(felt.at(kEnd, "contact/mean_N"), 0.5, 0.05);
}

TEST(Faults, OfAJointWithoutNumbersLeaveTheWeightAlone) {
  const Felt felt(fault("kind=\"nan\" joints=\"knee\""));
  felt.endsInItsTime();
  EXPECT_THAT(felt.warnings(), ElementsAre("joint 'knee' was not sensed, first at t = 1.1 s: 300 ticks took its last good "
                                           "values, or bore the weight alone"));
  EXPECT_EQ(felt.run["ticks"]["blind"], 280) << "after the hold of 20 ms";
  EXPECT_EQ(felt.at(kDuring, "sensing/joints_held"), 1);
  EXPECT_LT(felt.at(kDuring, "contact/mean_N"), 0.05) << "nothing presses";
  EXPECT_NEAR(felt.at(kEnd, "contact/mean_N"), 0.5, 0.1);
}

TEST(Faults, OfContactsWithoutNumbersAreIgnoredAndReadingsKept) {
  const Felt felt(fault("kind=\"nan\" links=\"distal\" of=\"skin\""));
  felt.endsInItsTime();
  EXPECT_THAT(felt.warnings(),
              ElementsAre("contacts of link 'distal' were no numbers, first at t = 1.1 s: 300 were ignored"));
  EXPECT_EQ(felt.at(kDuring, "signal/touch/held"), 0);
  EXPECT_GT(felt.at(kDuring, "sensor/skin/force"), 0.4) << "the last good one";
  EXPECT_NEAR(felt.at(kEnd, "contact/mean_N"), 0.5, 0.05);
}

TEST(Faults, OfAnEncoderThatJumpsPressWrongWithinLimits) {
  const Felt felt(fault("kind=\"jump\" joints=\"knee\" offset=\"0.1\""));
  felt.endsInItsTime();
  EXPECT_NEAR(felt.at(1.11, "q/knee") - felt.at(kBefore, "q/knee"), 0.1, 0.02);
  EXPECT_LT(felt.at(kDuring, "contact/mean_N"), 2);
  EXPECT_EQ(felt.run["ticks"]["fallback"], 0);
  EXPECT_NEAR(felt.at(kEnd, "contact/mean_N"), 0.5, 0.1);
}

TEST(Faults, ThatAreALittleLateChangeLittle) {
  const Felt felt(fault("kind=\"late\" delay=\"0.005\""));
  felt.endsInItsTime();
  EXPECT_NEAR(felt.at(kDuring, "contact/mean_N"), 0.5, 0.05);
}

TEST(Faults, ThatAreTooLateSwingAndAreCaught) {
  const Felt swings(fault("kind=\"late\" delay=\"0.04\""));
  swings.endsInItsTime();
  EXPECT_GT(std::abs(swings.at(kDuring, "qd/knee")), 0.5);
  EXPECT_LT(std::abs(swings.at(kEnd, "qd/knee")), 0.5) << "it calms down when it is over";

  const Felt lost(skin + "<fault name=\"fault\" kind=\"late\" delay=\"0.2\"/>");
  EXPECT_EQ(lost.outcome.exit_code, 5);
  EXPECT_EQ(lost.run["status"], "plant-error");
  EXPECT_THAT(lost.outcome.err, HasSubstr("runs away"));
}

TEST(Faults, NameASensorThatStandsBeforeThem) {
  const TemporaryFolder folder;
  const std::string stack =
      changedStack(folder, "<signals>", "<sensors>" + skin + "<fault name=\"fault\" kind=\"nan\" of=\"skim\"/></sensors><signals>");
  const Outcome outcome = tactus({"check", stack});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("no sensor 'skim' stands before it"));
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'skin'"));
}

}  // namespace
}  // namespace tactus::testing
