// Whole runs of a small stack: a finger that comes down on the floor.

#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "framework/runtime/csv_table.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using runtime::CsvTable;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Outcome runInto(const std::string& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"run", data("press.xml"), "--out", folder};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return tactus(arguments);
}

/// Waits, at most 20 s, until the file holds that many bytes.
bool waitForBytes(const std::string& file, std::uintmax_t bytes) {
  for (int i = 0; i < 400; ++i) {
    if (fs::exists(file) && fs::file_size(file) >= bytes) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST(RunCommand, LeavesACompleteRunFolder) {
  const TemporaryFolder folder;
  const Outcome outcome = runInto(folder.file("run"));
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* file : {"run.json", "log.csv", "timing.csv", "touched_points.csv", "stack.resolved.xml",
                           "report.html", "contacts.svg", "touched_points.svg"}) {
    EXPECT_GT(fs::file_size(folder.file("run") + "/" + file), 0u) << file;
  }
  EXPECT_THAT(outcome.out, HasSubstr("contact_force_mean_N"));
  EXPECT_THAT(outcome.out, HasSubstr("× real time"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("\r"))) << "progress is for terminals";
}

TEST(RunCommand, RunJsonHasTheKeysThatOthersRead) {
  const TemporaryFolder folder;
  const Outcome outcome = runInto(folder.file("run"), {"--seed", "7", "--json"});
  const nlohmann::json run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
  EXPECT_EQ(outcome.json(), run);
  EXPECT_EQ(run["format"], "tactus-run/1");
  EXPECT_EQ(run["stack"], "press");
  EXPECT_EQ(run["backend"], "null-space");
  EXPECT_EQ(run["backend_options"]["projection"], "augmented");
  EXPECT_EQ(run["seed"], 7);
  EXPECT_EQ(run["status"], "done");
  EXPECT_EQ(run["duration_s"], 1.0);
  EXPECT_GT(run["realtime_factor"].get<double>(), 0);
  for (const char* key : {"median", "p99", "p999"}) EXPECT_GT(run["tick_us"][key].get<double>(), 0) << key;
  EXPECT_EQ(run["ticks"]["total"], 1000);
  EXPECT_EQ(run["ticks"]["fallback"], 0);
  for (const char* metric :
       {"contact_force_mean_N", "contact_force_max_mean_N", "contact_force_peak_N", "undesired_force_peak_N",
        "links_in_contact_mean", "contact_switches_per_s", "points_touched"}) {
    EXPECT_TRUE(run["metrics"][metric].is_number()) << metric;
  }
  EXPECT_GT(run["metrics"]["contact_force_mean_N"].get<double>(), 0);
  EXPECT_EQ(run["wanted_force_N"], 0.5);
  for (const char* version : {"tactus", "eigen", "simbody", "ipopt", "nlopt", "compiler"}) {
    EXPECT_FALSE(run["versions"][version].get<std::string>().empty()) << version;
  }
}

TEST(RunCommand, MetricsAgreeWithTheLog) {
  const TemporaryFolder folder;
  changedStack(folder, "rate=\"100\"", "rate=\"1000\"");
  const Outcome outcome = tactus({"run", folder.file("stack.xml"), "--out", folder.file("run"), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const CsvTable log = CsvTable::read(folder.file("run/log.csv"));
  // One desired link and one object: every tick's largest force is its mean.
  const std::vector<double> force = log.numbers(log.column("contact/max_N"));
  double sum = 0, peak = 0;
  int ticks = 0;
  for (const double f : force) {
    sum += f;
    peak = std::max(peak, f);
    ticks += f > 0;
  }
  ASSERT_GT(ticks, 100);
  const nlohmann::json metrics = outcome.json()["metrics"];
  EXPECT_NEAR(metrics["contact_force_mean_N"].get<double>(), sum / ticks, 1e-9);
  EXPECT_EQ(metrics["contact_force_peak_N"].get<double>(), peak);
}

TEST(RunCommand, LogRepeatsToTheByte) {
  const TemporaryFolder folder;
  ASSERT_EQ(runInto(folder.file("a")).exit_code, 0);
  ASSERT_EQ(runInto(folder.file("b")).exit_code, 0);
  EXPECT_EQ(contentOf(folder.file("a/log.csv")), contentOf(folder.file("b/log.csv")));
  EXPECT_EQ(contentOf(folder.file("a/touched_points.csv")), contentOf(folder.file("b/touched_points.csv")));
}

TEST(RunCommand, ResolvedStackRunsToTheSameLog) {
  const TemporaryFolder folder;
  ASSERT_EQ(runInto(folder.file("a"), {"--set", "press=0.7"}).exit_code, 0);
  const Outcome outcome = tactus({"run", folder.file("a/stack.resolved.xml"), "--out", folder.file("b")});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(contentOf(folder.file("a/log.csv")), contentOf(folder.file("b/log.csv")));
}

TEST(RunCommand, OptionsChangeTheRun) {
  const TemporaryFolder folder;
  const nlohmann::json run =
      runInto(folder.file("a"), {"--backend", "qp/nlopt", "--duration", "0.05", "--json"}).json();
  EXPECT_EQ(run["backend"], "qp");
  EXPECT_EQ(run["backend_options"]["solver"], "nlopt");
  EXPECT_EQ(run["duration_s"], 0.05);
  EXPECT_TRUE(run["kkt_max"]["stationarity"].is_number());
}

TEST(RunCommand, DefaultFolderSaysWhatRan) {
  const TemporaryFolder folder;
  Settings there;
  there.working_folder = folder.path();
  const Outcome outcome = tactus({"run", data("press.xml"), "--seed", "3", "--duration", "0.01"}, there);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder.file("runs/press-null-space-seed3/run.json")));
}

TEST(RunCommand, ForeignFolderIsLeftAlone) {
  const TemporaryFolder folder;
  folder.write("thesis.tex", "years of work");
  const Outcome outcome = runInto(folder.path());
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("holds files that are not of a run"));
  EXPECT_EQ(contentOf(folder.file("thesis.tex")), "years of work");
  EXPECT_FALSE(fs::exists(folder.file("log.csv")));
}

TEST(RunCommand, FolderOfAnEarlierRunIsUsedAgain) {
  const TemporaryFolder folder;
  ASSERT_EQ(runInto(folder.file("run"), {"--duration", "0.1"}).exit_code, 0);
  ASSERT_EQ(runInto(folder.file("run"), {"--duration", "0.05"}).exit_code, 0);
  EXPECT_EQ(CsvTable::read(folder.file("run/timing.csv")).rows(), 50u);
}

TEST(RunCommand, FileInsteadOfAFolder) {
  const Outcome outcome = runInto("/dev/full");
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("/dev/full"));
}

TEST(RunCommand, FullDiskLeavesAStatus) {
  const TemporaryFolder folder;
  Settings small;
  small.largest_file = 100'000;                                    // the log passes it, run.json does not
  changedStack(folder, "rate=\"100\"", "rate=\"1000\"");
  const Outcome outcome = tactus({"run", folder.file("stack.xml"), "--out", folder.file("run")}, small);
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("log.csv: cannot be written: File too large; the log is kept"));
  const nlohmann::json run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
  EXPECT_EQ(run["status"], "file-error");
  EXPECT_THAT(run["message"].get<std::string>(), HasSubstr("log.csv: cannot be written"));
  EXPECT_GT(run["duration_s"].get<double>(), 0);
}

TEST(RunCommand, PicturesThatCouldNotBeWrittenAreNotPromised) {
  const TemporaryFolder folder;
  ASSERT_EQ(runInto(folder.file("run"), {"--duration", "0.1"}).exit_code, 0);
  Settings small;
  small.largest_file = 8'000;                                      // the report passes it, all else does not
  const Outcome outcome = tactus({"run", data("press.xml"), "--out", folder.file("run"), "--duration", "0.03"}, small);
  EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("cannot be written"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("pictures in")));
  EXPECT_THAT(outcome.out, HasSubstr("contact_force_mean_N"));
  EXPECT_EQ(nlohmann::json::parse(contentOf(folder.file("run/run.json")))["status"], "done");
}

TEST(RunCommand, ADurationBelowOneTickIsUsage) {
  const TemporaryFolder folder;
  const Outcome outcome = runInto(folder.file("run"), {"--duration", "0.0001"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--duration 0.0001 is shorter than one tick of 0.001 s"));
  EXPECT_FALSE(fs::exists(folder.file("run")));
}

TEST(RunCommand, TheLongestRunTakesNoMoreMemory) {
  const TemporaryFolder folder;
  RunningProgram program({"run", data("press.xml"), "--duration", "1e6", "--out", folder.file("run")});
  ASSERT_TRUE(waitForBytes(folder.file("run/log.csv"), 4000));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().exit_code, 130);
}

TEST(RunCommand, TargetsAreTheStacks) {
  const TemporaryFolder folder;
  EXPECT_THAT(runInto(folder.file("none")).out, AllOf(Not(HasSubstr("wanted")), Not(HasSubstr("missed")), Not(HasSubstr("lost_rank"))));
  const std::string stack =
      changedStack(folder, "<record", "<target metric=\"contact_force_mean_N\" lower=\"0.1\" upper=\"9\"/>"
                                      "<target metric=\"points_touched\" lower=\"1e9\"/><target metric=\"nothing\" upper=\"1\"/><record");
  const Outcome outcome = tactus({"run", stack, "--out", folder.file("run")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("contact_force_mean_N +[0-9.]+ +0.1 – 9 +met\n"));
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("points_touched +[0-9.]+ +≥ 1e[+]09 +missed\n"));
  EXPECT_THAT(outcome.err, HasSubstr("warning: the target 'nothing' names no figure of this run"));
  const nlohmann::json run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
  EXPECT_EQ(run["wanted"]["contact_force_mean_N"], (nlohmann::json{{"lower", 0.1}, {"upper", 9.0}}));
  EXPECT_TRUE(run["ticks"]["lost_rank"].is_number());
  EXPECT_THAT(contentOf(folder.file("run/stack.resolved.xml")), HasSubstr("<target metric=\"points_touched\" lower=\"1e+09\"/>"));
}

TEST(RunCommand, ScaledTorquesAreCountedAsLimited) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "stiffness=\"1\" damping=\"0.4\"", "stiffness=\"1000\" damping=\"0.4\"");
  const Outcome outcome = tactus({"run", stack, "--out", folder.file("run"), "--duration", "0.005", "--json"});
  const CsvTable log = CsvTable::read(folder.file("run/log.csv"));
  EXPECT_LT(log.numbers("controller/scale").front(), 1);
  EXPECT_EQ(log.numbers("controller/limited").front(), 1);
  EXPECT_GT(outcome.json()["ticks"]["limited"], 0);
}

TEST(RunCommand, WhatTheControllerDeclaresIsLogged) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(
      folder, "<level priority=\"2\"><posture", "<level priority=\"2\"><posture active-from=\"0.2\" active-ramp=\"0.04\"");
  std::string text = contentOf(stack);
  const std::string backend = "<controller backend=\"null-space\"";
  ASSERT_NE(text.find(backend), std::string::npos);
  text.replace(text.find(backend), backend.size(), backend + " torque-rate=\"0.1\" deadline-iterations=\"50\"");
  const Outcome outcome = tactus({"run", folder.write("declared.xml", text), "--out", folder.file("run"), "--json"});
  const CsvTable log = CsvTable::read(folder.file("run/log.csv"));
  EXPECT_EQ(log.numbers("task/bow/share").at(19), 0);
  EXPECT_NEAR(log.numbers("task/bow/share").at(22), 0.5, 0.1);
  EXPECT_EQ(log.numbers("task/bow/share").at(25), 1);
  EXPECT_EQ(log.numbers("controller/late").back(), 0);
  EXPECT_GE(log.column("controller/rate_limited"), 0);
  const nlohmann::json ticks = outcome.json()["ticks"];
  EXPECT_GT(ticks["rate_limited"], 0);
  for (const char* count : {"late", "partial", "held", "gravity", "blind"}) EXPECT_EQ(ticks[count], 0) << count;
  const Outcome said = tactus({"run", folder.file("declared.xml"), "--out", folder.file("run")});
  EXPECT_THAT(said.out, HasSubstr("ticks kept at the torque rate: "));
}

TEST(RunCommand, MissingStack) { EXPECT_EQ(tactus({"run", "/nowhere/stack.xml"}).exit_code, 6); }

TEST(RunCommand, BrokenStackLosesNothing) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "stiffness=\"1\"", "stiffness=\"nan\"");
  const Outcome outcome = tactus({"run", stack, "--out", folder.file("run"), "--json"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.json()["errors"][0]["line"], 13);
  EXPECT_FALSE(fs::exists(folder.file("run")));
}

TEST(RunCommand, RobotWithoutMassIsRefused) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "press", "press");
  std::string robot = contentOf(data("finger.urdf"));
  const size_t from = robot.find("<inertial>"), to = robot.find("</inertial>") + 11;
  folder.write("finger.urdf", robot.erase(from, to - from));
  const Outcome outcome = tactus({"run", stack, "--out", folder.file("run")});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("proximal"));
}

TEST(RunCommand, KilledRunLeavesAReadableLog) {
  const TemporaryFolder folder;
  RunningProgram program({"run", data("press.xml"), "--duration", "3600", "--out", folder.file("run")});
  ASSERT_TRUE(waitForBytes(folder.file("run/log.csv"), 4000));
  program.send(SIGKILL);
  EXPECT_EQ(program.wait().exit_code, 128 + SIGKILL);
  const CsvTable log = CsvTable::read(folder.file("run/log.csv"));
  ASSERT_GT(log.rows(), 10u);
  const std::vector<double> time = log.numbers(log.column("time"));
  EXPECT_NEAR(time.back(), 0.01 * static_cast<double>(log.rows() - 1), 1e-9);
  EXPECT_EQ(nlohmann::json::parse(contentOf(folder.file("run/run.json")))["status"], "running");
  EXPECT_EQ(tactus({"report", folder.file("run")}).exit_code, 0);
  EXPECT_THAT(contentOf(folder.file("run/report.html")), HasSubstr("This run was cut off"));
}

TEST(RunCommand, InterruptedRunKeepsEverything) {
  const TemporaryFolder folder;
  RunningProgram program({"run", data("press.xml"), "--duration", "3600", "--out", folder.file("run")});
  ASSERT_TRUE(waitForBytes(folder.file("run/log.csv"), 4000));
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; the log is kept"));
  const nlohmann::json run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
  EXPECT_EQ(run["status"], "interrupted");
  EXPECT_EQ(CsvTable::read(folder.file("run/timing.csv")).rows(), run["ticks"]["total"].get<size_t>());
  EXPECT_TRUE(fs::exists(folder.file("run/report.html")));
}

TEST(ReportCommand, MakesTheSameReportAgain) {
  const TemporaryFolder folder;
  ASSERT_EQ(runInto(folder.file("run")).exit_code, 0);
  const std::string report = contentOf(folder.file("run/report.html"));
  EXPECT_THAT(report, HasSubstr("Links in contact"));
  EXPECT_THAT(report, HasSubstr("Touched points from above"));
  EXPECT_THAT(report, HasSubstr("Error of task bow"));
  for (const char* elsewhere : {"<script src", "<link", "<img", "<iframe", "@import"})
    EXPECT_THAT(report, Not(HasSubstr(elsewhere))) << "the report stands alone";
  EXPECT_LT(report.size(), 3'000'000u);
  fs::remove(folder.file("run/report.html"));
  EXPECT_EQ(tactus({"report", folder.file("run")}).exit_code, 0);
  EXPECT_EQ(contentOf(folder.file("run/report.html")), report);
}

TEST(ReportCommand, NeedsARunFolder) {
  const TemporaryFolder folder;
  EXPECT_EQ(tactus({"report", folder.path()}).exit_code, 6);
  folder.write("run.json", "{\"format\": \"something else\"}");
  const Outcome outcome = tactus({"report", folder.path()});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("is not of the format tactus-run/1"));
}

}  // namespace
}  // namespace tactus::testing
