// Saving a run and going on with it: the same bytes as without the break, and branches.

#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
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

constexpr const char* table = TACTUS_SOURCE_DIR "/examples/explore_table/stack.xml";

Outcome run(const std::string& stack, const std::string& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"run", stack, "--out", folder};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return tactus(arguments);
}

/// The rows of a log from a time on.
std::string rowsFrom(const std::string& log, double time) {
  std::istringstream lines(log);
  std::string line, kept;
  for (std::getline(lines, line); std::getline(lines, line);)
    if (std::stod(line) >= time - 1e-9) kept += line + "\n";
  return kept;
}

nlohmann::json metricsOf(const std::string& folder) {
  return nlohmann::json::parse(contentOf(folder + "/run.json"))["metrics"];
}

/// Runs a stack whole and in two parts; both must leave the same bytes.
void expectTheSame(const std::string& stack, const std::string& at, const std::string& until,
                   const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments{"--duration", until, "--save-at", at};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome whole = run(stack, folder.file("whole"), arguments);
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  arguments = {"--duration", until, "--from", folder.file("whole/state-" + at + ".json")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Outcome rest = run(stack, folder.file("rest"), arguments);
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_THAT(rest.err, Not(HasSubstr("afresh")));

  const std::string expected = rowsFrom(contentOf(folder.file("whole/log.csv")), std::stod(at));
  EXPECT_GT(expected.size(), 100u);
  EXPECT_EQ(rowsFrom(contentOf(folder.file("rest/log.csv")), 0), expected);
  EXPECT_EQ(contentOf(folder.file("rest/touched_points.csv")), contentOf(folder.file("whole/touched_points.csv")));
  EXPECT_EQ(metricsOf(folder.file("rest")), metricsOf(folder.file("whole")));
}

// The hand has come down, fingers touch and slide.  1.503 s is no time of a row of the log.
TEST(State, TheMainJobGoesOnToTheBit) { expectTheSame(table, "1.503", "2"); }
TEST(State, WithTheOwnSolverToo) { expectTheSame(table, "1.5", "1.7", {"--backend", "qp/active-set"}); }
TEST(State, WithTheHierarchyToo) { expectTheSame(table, "1.5", "1.7", {"--backend", "hqp"}); }

TEST(State, SkinEncodersFaultsAndFreeObjectsGoOnToTheBit) {
  expectTheSame(data("state.xml"), "0.35", "0.6", {"--seed", "5"});
}

TEST(State, ABranchGoesAnotherWay) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(table, folder.file("whole"), {"--duration", "1.7", "--save-at", "1.5"}).exit_code, 0);
  const std::string state = folder.file("whole/state-1.5.json");
  const Outcome branch =
      run(table, folder.file("branch"), {"--duration", "1.7", "--from", state, "--set", "press=0.8"});
  ASSERT_EQ(branch.exit_code, 0) << branch.err;
  const CsvTable whole = CsvTable::read(folder.file("whole/log.csv")), other = CsvTable::read(folder.file("branch/log.csv"));
  EXPECT_DOUBLE_EQ(other.numbers("time").front(), 1.5);
  EXPECT_GT(other.numbers("contact/mean_N").back(), whole.numbers("contact/mean_N").back() + 0.1);
  const Outcome back_end = run(table, folder.file("hqp"), {"--duration", "1.6", "--from", state, "--backend", "hqp"});
  EXPECT_EQ(back_end.exit_code, 0) << back_end.err;
  EXPECT_THAT(back_end.err, HasSubstr("controller/back-end/null-space of the state is not in this stack"));
}

TEST(State, ABranchIsExplained) {
  const TemporaryFolder folder;
  ASSERT_EQ(run(data("press.xml"), folder.file("run"), {"--duration", "0.3", "--save-at", "0.1"}).exit_code, 0);
  const Outcome branch = run(data("press.xml"), folder.file("branch"),
                             {"--from", folder.file("run/state-0.1.json"), "--duration", "0.3", "--set", "press=0.7"});
  ASSERT_EQ(branch.exit_code, 0) << branch.err;
  EXPECT_EQ(nlohmann::json::parse(contentOf(folder.file("branch/run.json")))["from"]["set"][0], "press=0.7");
  const Outcome explained = tactus({"explain", folder.file("branch"), "--at", "0.25"});
  EXPECT_EQ(explained.exit_code, 0) << explained.err;
  EXPECT_THAT(explained.err, HasSubstr("its log is met to the byte"));
  EXPECT_EQ(tactus({"explain", folder.file("branch"), "--at", "0.05"}).exit_code, 2);
}

TEST(State, TwoRunsDoNotShareAFolder) {
  const TemporaryFolder folder;
  RunningProgram first({"run", table, "--duration", "1000", "--out", folder.file("run")});
  for (int i = 0; i < 400 && !fs::exists(folder.file("run/log.csv")); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const Outcome second = run(data("press.xml"), folder.file("run"), {});
  EXPECT_EQ(second.exit_code, 6);
  EXPECT_THAT(second.err, HasSubstr("another run is writing into it"));
  first.send(SIGINT);
  EXPECT_EQ(first.wait().exit_code, 130);
}

TEST(State, AnInterruptedRunLeavesItsState) {
  const TemporaryFolder folder;
  RunningProgram program({"run", table, "--duration", "1000", "--out", folder.file("run")});
  for (int i = 0; i < 400 && !(fs::exists(folder.file("run/log.csv")) && fs::file_size(folder.file("run/log.csv")) > 60000); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130);
  const nlohmann::json description = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
  ASSERT_EQ(description["states"].size(), 1u);
  const std::string state = folder.file("run/" + description["states"][0].get<std::string>());
  EXPECT_THAT(outcome.err, HasSubstr("to go on: tactus run " + std::string(table) + " --from " + state));
  const double until = nlohmann::json::parse(contentOf(state))["time"].get<double>() + 0.05;
  const Outcome on = run(table, folder.file("on"), {"--from", state, "--duration", std::to_string(until)});
  EXPECT_EQ(on.exit_code, 0) << on.err;
}

class BadState : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder = new TemporaryFolder;
    run(data("press.xml"), folder->file("run"), {"--duration", "0.2", "--save-at", "0.1"});
  }
  static void TearDownTestSuite() { delete folder; }
  static std::string state() { return folder->file("run/state-0.1.json"); }
  static Outcome from(const std::string& file, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"--from", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(data("press.xml"), folder->file("other"), arguments);
  }
  /// The state with a text replaced.
  static std::string changed(const std::string& from, const std::string& to) {
    std::string text = contentOf(state());
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const std::string file = folder->file("changed.json");
    std::ofstream(file) << text;
    return file;
  }
  static TemporaryFolder* folder;
};
TemporaryFolder* BadState::folder = nullptr;

void expectRefused(const Outcome& outcome, int exit_code, const std::string& message) {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(message));
}

TEST_F(BadState, FilesThatAreNone) {
  expectRefused(from(folder->file("nowhere.json")), 6, "nowhere.json");
  expectRefused(from(data("press.xml")), 6, "not JSON");
  expectRefused(from(changed("tactus-state/1", "tactus-state/9")), 6, "\"format\" is not \"tactus-state/1\"");
  std::ofstream(folder->file("half.json")) << contentOf(state()).substr(0, 500);
  expectRefused(from(folder->file("half.json")), 6, "not JSON");
}

TEST_F(BadState, OfAnotherWorld) {
  expectRefused(from(changed("\"joints\": [\"", "\"joints\": [\"other_")), 6, "the state has other joints than this stack");
  expectRefused(from(changed("\"plant/world/q\"", "\"plant/world/x\"")), 6, "the state lacks 'plant/world/q'");
  expectRefused(from(changed("\"plant/world/qd\": [", "\"plant/world/qd\": [0.0,")), 6, "state 'plant/world/qd' has ");
}

TEST_F(BadState, NumbersThatAreNone) {
  expectRefused(from(changed("\"plant/world/qd\": [", "\"plant/world/qd\": [\"nan\",1.0,1.0],\n\"plant/world/old\": [")), 6,
                "a place or speed is no number");
  expectRefused(from(changed("\"plant/world/steps\": [400]", "\"plant/world/steps\": [-1]")), 6,
                "state 'plant/world/steps' is -1, and must be from 0");
}

TEST_F(BadState, SizesIndicesAndTimesThatCannotBe) {
  const char* size = "\"controller/signal/touch/points/time/size\": [";
  expectRefused(from(changed(size, "\"controller/signal/touch/points/time/size\": [9999999], \"x\": [")), 6,
                "has a size of 9999999, and holds no more than");
  expectRefused(from(changed("recent-next\": [", "recent-next\": [-1], \"x\": [")), 6, "is -1, and must be from 0 to 15");
  expectRefused(from(changed("\"time\": 0.1", "\"time\": 0.05")), 6, "its world stands at 0.1 s");
  expectRefused(from("/dev/zero"), 6, "is not a file");
  expectRefused(from(""), 2, "--from: it is empty");
}

TEST_F(BadState, AsksForWhatCannotBe) {
  expectRefused(from(state(), {"--duration", "0.1"}), 2, "give a longer --duration");
  expectRefused(from(state(), {"--seed", "77"}), 2, "the state is of seed");
  expectRefused(run(data("press.xml"), folder->file("run"), {"--from", state()}), 2, "the state to go on from lies there");
  expectRefused(run(data("press.xml"), folder->file("other"), {"--save-at", "99"}), 2, "--save-at 99: the run goes from 0 to");
  expectRefused(run(data("press.xml"), folder->file("other"), {"--save-at", "soon"}), 2, "--save-at");
}

// A task that the state does not know starts afresh, and is told.
TEST_F(BadState, OfAnotherStack) {
  const Outcome outcome = from(changed("\"controller/signal/touch/links/0/recent-next\"", "\"controller/signal/feel/links/0/recent-next\""));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("controller/signal/touch is not in the state, or not all of it"),
                                 HasSubstr("controller/signal/feel of the state is not in this stack")));
}

}  // namespace
}  // namespace tactus::testing
