// Sensors, controllers of levels and recorders of a plugin that go wrong at 0.02 s of a run: which one, when and what is
// said; the log is kept.

#include <gmock/gmock.h>

#include <filesystem>

#include "framework/runtime/csv_table.h"
#include "framework/runtime/file_error.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using runtime::CsvTable;
using ::testing::HasSubstr;

const std::string kPlugin = std::string(TEST_PLUGINS) + "/naughty.so";

/// The small stack with `part` put before `before`, run with `on_fault`.
struct Faulty {
  Faulty(const std::string& before, const std::string& part, const std::string& on_fault = "fall-back") {
    std::string text = contentOf(changedStack(folder, before, part + before));
    const std::string controller = "<controller ";
    text.insert(text.find(controller) + controller.size(), "on-fault=\"" + on_fault + "\" ");
    stack = folder.file("faulty.xml");
    runtime::writeFile(stack, text);
    outcome = tactus({"run", stack, "--plugin", kPlugin, "--out", folder.file("run")});
    if (std::filesystem::exists(folder.file("run/run.json")))
      run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
  }
  size_t ticks() const { return CsvTable::read(folder.file("run/timing.csv")).rows(); }

  TemporaryFolder folder;
  std::string stack;
  Outcome outcome;
  nlohmann::json run;
};

const std::string sensor = "<sensors><naughty.sensor name=\"nerve\"/></sensors>";
const std::string recorder = "<naughty.recorder name=\"pencil\"/>";
const std::string owner = "<level priority=\"3\"><naughty.owner name=\"own\"/></level>";

TEST(FaultySensor, EndsTheRunWithItsName) {
  const Faulty faulty("<signals>", sensor);
  EXPECT_EQ(faulty.outcome.exit_code, 4);
  EXPECT_THAT(faulty.outcome.err, HasSubstr("tactus run: sensor 'nerve' failed at t = 0.02 s: the nerve is cut; the log is kept"));
  EXPECT_EQ(faulty.run["status"], "part-error");
  EXPECT_EQ(faulty.ticks(), 20u);
}

TEST(FaultyRecorder, EndsTheRunWithItsName) {
  const Faulty faulty("<record ", recorder);
  EXPECT_EQ(faulty.outcome.exit_code, 4);
  EXPECT_THAT(faulty.outcome.err, HasSubstr("recorder 'pencil' failed at t = 0.02 s: the pencil broke"));
  EXPECT_EQ(faulty.run["status"], "part-error");
}

TEST(FaultyRecorder, FallsSilentWhereTheStackSaysSo) {
  const Faulty faulty("<record ", recorder, "switch-off");
  EXPECT_EQ(faulty.outcome.exit_code, 4);
  EXPECT_EQ(faulty.run["status"], "done");
  EXPECT_EQ(faulty.run["ticks"]["total"], 1000);
  EXPECT_EQ(faulty.run["warnings"],
            nlohmann::json({"recorder 'pencil' failed at t = 0.02 s: the pencil broke; it recorded nothing more"}));
}

TEST(FaultyRecorder, ThatCannotWriteIsAMatterOfFiles) {
  const Faulty faulty("<record ", "<naughty.recorder name=\"pencil\" fault=\"disk\"/>");
  EXPECT_EQ(faulty.outcome.exit_code, 6);
  EXPECT_THAT(faulty.outcome.err, HasSubstr("no space left"));
}

TEST(FaultyController, EndsTheRunWithItsName) {
  const Faulty faulty("<controller ", owner);
  EXPECT_EQ(faulty.outcome.exit_code, 4);
  EXPECT_THAT(faulty.outcome.err, HasSubstr("controller 'own' failed at t = 0.02 s: lost the thread"));
  EXPECT_EQ(faulty.run["status"], "tick-error");
}

TEST(FaultyController, IsSwitchedOffWithItsTasksWhereTheStackSaysSo) {
  const Faulty faulty("<controller ", owner, "switch-off");
  EXPECT_EQ(faulty.outcome.exit_code, 4);
  EXPECT_EQ(faulty.run["ticks"]["total"], 1000);
  EXPECT_EQ(faulty.run["ticks"]["fallback"], 0);
  EXPECT_EQ(faulty.run["warnings"],
            nlohmann::json({"task 'own.rest' was switched off at t = 0.02 s: controller 'own': lost the thread"}));
}

TEST(FaultySignal, EndsTheRunWithItsName) {
  const Faulty faulty("<contacts ", "<naughty.signal name=\"idea\"/>");
  EXPECT_EQ(faulty.outcome.exit_code, 4);
  EXPECT_THAT(faulty.outcome.err, HasSubstr("signal 'idea' failed at t = 0.02 s: out of ideas"));
}

/// The posture reads the first through the second.
TEST(FaultySignal, IsSwitchedOffWithWhatReadsItWhereTheStackSaysSo) {
  const Faulty faulty("<controller ",
                      "<signals><naughty.signal name=\"idea\"/><naughty.signal name=\"copy\" from=\"idea.value\"/></signals>"
                      "<level priority=\"3\"><posture name=\"extra\" joints=\"tip\" active=\"copy.value\"/></level>",
                      "switch-off");
  EXPECT_EQ(faulty.outcome.exit_code, 4);
  EXPECT_EQ(faulty.run["ticks"]["total"], 1000);
  EXPECT_EQ(faulty.run["warnings"],
            nlohmann::json({"task 'extra' was switched off at t = 0.02 s: signal 'idea': out of ideas"}));
}

TEST(FaultyParts, AreNamedByOtherCommandsToo) {
  const Faulty faulty("<signals>", sensor);
  const Outcome compared = tactus({"compare", faulty.stack, "--plugin", kPlugin, "--backends", "null-space"});
  EXPECT_EQ(compared.exit_code, 4);
  EXPECT_THAT(compared.err, HasSubstr("sensor 'nerve' failed at t = 0.02 s: the nerve is cut"));
}

}  // namespace
}  // namespace tactus::testing
