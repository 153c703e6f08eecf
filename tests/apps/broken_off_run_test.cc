// Runs that are killed, and runs on a disk that fills up: what is left can be read, and passes for no more than it is.

#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <thread>

#include "framework/runtime/csv_table.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using runtime::CsvTable;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string explore = std::string(TACTUS_SOURCE_DIR) + "/examples/explore_table/stack.xml";
const std::vector<std::string> tables{"log.csv", "timing.csv", "touched_points.csv", "replay.csv",
                                      "replay_contacts.csv"};

/// Every table that is there can be read, and its times rise.
void expectReadable(const std::string& run) {
  for (const std::string& name : tables) {
    const std::string file = run + "/" + name;
    if (!fs::exists(file)) continue;
    const CsvTable table = CsvTable::read(file);
    const std::vector<double> times = table.numbers("time");
    EXPECT_TRUE(std::is_sorted(times.begin(), times.end())) << file;
  }
}

/// s, the last time of a table.
double lastTime(const std::string& file) {
  const std::vector<double> times = CsvTable::read(file).numbers("time");
  return times.empty() ? 0 : times.back();
}

/// Report, export and plot of what is there.
void expectUsable(const std::string& run) {
  const Outcome report = tactus({"report", run});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(contentOf(run + "/report.html"), HasSubstr("This run was cut off"));
  const Outcome exported = tactus({"export", run, "--mcap", run + "/run.mcap"});
  EXPECT_EQ(exported.exit_code, 0) << exported.err;
  if (!fs::exists(run + "/log.csv")) return;
  const Outcome plot = tactus({"plot", run, "contact/mean_N"});
  EXPECT_EQ(plot.exit_code, 0) << plot.err;
}

TEST(KilledRun, AtAnyMomentLeavesWhatCanBeRead) {
  for (const int milliseconds : {0, 30, 100, 300, 700, 1300, 2100}) {
    const TemporaryFolder folder;
    const std::string run = folder.file("run");
    RunningProgram program({"run", explore, "--duration", "3600", "--out", run});
    for (int i = 0; i < 2000 && !fs::exists(run + "/run.json"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    program.send(SIGKILL);
    EXPECT_EQ(program.wait().exit_code, 128 + SIGKILL);
    EXPECT_EQ(nlohmann::json::parse(contentOf(run + "/run.json"))["status"], "running");
    expectReadable(run);
    expectUsable(run);
  }
}

/// A run into the folder of an earlier one that ends before its first row: nothing of the earlier one is taken for its
/// own, nor what one that was killed left unfinished.
TEST(BrokenOffRun, HoldsNothingOfTheRunBeforeIt) {
  const TemporaryFolder folder;
  const std::string run = folder.file("run"), stack = run + "/stack.resolved.xml";
  ASSERT_EQ(tactus({"run", data("press.xml"), "--duration", "0.5", "--out", run}).exit_code, 0);
  std::ofstream(run + "/log.csv.new") << "ti";
  fs::remove(stack);
  fs::create_directory(stack);                                     // which the next run cannot write
  EXPECT_EQ(tactus({"run", data("press.xml"), "--duration", "0.5", "--out", run}).exit_code, 6);
  EXPECT_EQ(nlohmann::json::parse(contentOf(run + "/run.json"))["status"], "file-error");
  for (const std::string& name : tables) EXPECT_FALSE(fs::exists(run + "/" + name)) << name;
  EXPECT_FALSE(fs::exists(run + "/log.csv.new"));
}

/// The live view tells, unbuffered, how far a run is.  What it told a second and more before the kill is in every file.
TEST(KilledRun, LosesAtMostASecondOfTheWallClock) {
  const TemporaryFolder folder;
  const std::string run = folder.file("run");
  ProgramInTerminal program({"run", explore, "--live", "--duration", "3600", "--out", run});
  struct Told {
    Clock::time_point at;
    double time;                                                   // s
  };
  std::vector<Told> told;
  const auto end = Clock::now() + std::chrono::seconds(5);
  while (Clock::now() < end) {
    ASSERT_TRUE(program.read(20)) << program.output();
    const size_t at = program.output().rfind(" of 3600.0 s");
    if (at == std::string::npos) continue;
    const size_t begin = program.output().find_last_of("\r\n", at) + 1;
    std::string text = program.output().substr(begin, at - begin);
    if (text.starts_with("\033[")) text = text.substr(text.find('A') + 1);
    told.push_back({Clock::now(), std::stod(text)});
  }
  program.send(SIGKILL);
  const auto killed = Clock::now();
  EXPECT_EQ(program.wait(), 128 + SIGKILL);

  double known = 0;                                                // s, simulated more than a second ago
  for (const Told& one : told)
    if (killed - one.at > std::chrono::milliseconds(1300)) known = one.time;
  ASSERT_GT(known, 0.5);
  EXPECT_GE(lastTime(run + "/log.csv"), known - 0.1);
  EXPECT_GE(lastTime(run + "/timing.csv"), known - 0.1);
  EXPECT_GE(lastTime(run + "/replay.csv"), known - 0.1);
  expectReadable(run);
  expectUsable(run);

  // Touched points come seldom: all that the same run touches up to there.
  const std::string whole = folder.file("whole");
  ASSERT_EQ(tactus({"run", explore, "--duration", std::to_string(known), "--out", whole}).exit_code, 0);
  for (const char* name : {"log.csv", "touched_points.csv", "replay.csv", "replay_contacts.csv"}) {
    const std::string expected = contentOf(whole + "/" + name), found = contentOf(run + "/" + name);
    // The time told is rounded to a tenth: rows of the last tenth may be missing.
    std::vector<double> times = CsvTable::read(whole + "/" + name).numbers("time");
    const auto certain = std::count_if(times.begin(), times.end(), [&](double time) { return time < known - 0.1; });
    size_t bytes = expected.find('\n') + 1;
    for (long row = 0; row < certain; ++row) bytes = expected.find('\n', bytes) + 1;
    EXPECT_EQ(found.substr(0, bytes), expected.substr(0, bytes)) << name;
  }
}

TEST(KilledRun, ALineThatWasBrokenOffIsLeftOutAloud) {
  const TemporaryFolder folder;
  const std::string run = folder.file("run");
  ASSERT_EQ(tactus({"run", data("press.xml"), "--duration", "0.5", "--out", run}).exit_code, 0);
  for (const char* name : {"log.csv", "replay.csv", "touched_points.csv"}) {
    const std::string good = contentOf(run + "/" + name);
    std::ofstream(run + "/" + name, std::ios::binary) << good.substr(0, good.size() - 3);
    const Outcome outcome = tactus({"report", run});
    EXPECT_EQ(outcome.exit_code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("warning: " + run + "/" + name + " ends within a line, which is left out"));
    EXPECT_THAT(contentOf(run + "/report.html"),
                HasSubstr(std::string(name) + " ends within a line, which is left out."));
    std::ofstream(run + "/" + name, std::ios::binary) << good;
  }
}

/// A run.json that was written at the end tells how it ended; whatever is there is whole, or the reader says so.
void expectHonest(const std::string& run, const Outcome& outcome) {
  EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(run.substr(run.rfind('/'))));
  EXPECT_THAT(outcome.err, AnyOf(HasSubstr("cannot be written"), HasSubstr("cannot be created")));
  EXPECT_THAT(outcome.err, Not(HasSubstr("pictures in")));
  for (const auto& entry : fs::directory_iterator(run))
    EXPECT_NE(entry.path().extension(), ".new") << entry.path() << " was left behind";
  if (!fs::exists(run + "/run.json")) return;
  const nlohmann::json json = nlohmann::json::parse(contentOf(run + "/run.json"));
  EXPECT_THAT(json["status"], AnyOf("running", "file-error"));
  const Outcome report = tactus({"report", run});
  EXPECT_THAT(report.exit_code, AnyOf(0, 6));
  for (const std::string& name : tables) {
    const std::string content = fs::exists(run + "/" + name) ? contentOf(run + "/" + name) : "";
    if (content.empty() || content.ends_with('\n') || name == "timing.csv") continue;
    EXPECT_THAT(report.err, HasSubstr(name)) << "a broken line passed in silence";
  }
}

TEST(FullDisk, WhereverItFillsUpTheRunSaysSo) {
  for (const long bytes : {2'000, 5'000, 20'000, 64'000, 65'000, 100'000, 200'000}) {
    const TemporaryFolder folder;
    Settings small;
    small.largest_file = bytes;
    const std::string run = folder.file("run");
    expectHonest(run, tactus({"run", explore, "--duration", "10", "--out", run}, small));
  }
}

/// A real file system that fills up, in a mount namespace of its own.
TEST(FullDisk, OnASmallFileSystem) {
  const TemporaryFolder folder;
  const std::string disk = folder.file("disk"), script = folder.file("run.sh");
  fs::create_directory(disk);
  if (std::system(("unshare -rm mount -t tmpfs tmpfs " + disk + " 2> /dev/null").c_str()) != 0)
    GTEST_SKIP() << "this user may not mount a file system of its own";
  for (const char* size : {"100k", "400k", "1200k"}) {
    const std::string left = folder.file(size);
    const std::string command = "mount -t tmpfs -o size=" + std::string(size) + " tmpfs " + disk + " && {  " +
                                TACTUS_BINARY_DIR "/bin/tactus run " + explore + " --duration 10 --out " + disk +
                                "/run 2> " + folder.file("err") + " > /dev/null; code=$?; cp -r " + disk + "/run " +
                                left + "; exit $code; }";
    std::ofstream(script) << command;
    const int status = std::system(("unshare -rm sh " + script).c_str());
    Outcome outcome{WEXITSTATUS(status), "", contentOf(folder.file("err"))};
    EXPECT_THAT(outcome.err, HasSubstr("No space left on device"));
    EXPECT_THAT(outcome.err, HasSubstr(disk + "/run/"));
    outcome.err += left;                                           // the copy's place
    expectHonest(left, outcome);
  }
}

}  // namespace
}  // namespace tactus::testing
