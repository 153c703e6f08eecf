// `tactus run --live` in a terminal, and where there is none.

#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AnyOf;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;

const std::string explore = std::string(TACTUS_SOURCE_DIR) + "/examples/explore_table/stack.xml";

/// Of what was written up to now: the last drawing that is whole.
std::vector<std::string> lastDrawing(const std::string& output) {
  return screenOf(output.substr(0, output.rfind("\033[J") + 3));
}

size_t drawingsIn(const std::string& output) {
  size_t count = 0;
  for (size_t at = 0; (at = output.find("\033[J", at)) != std::string::npos; ++at) ++count;
  return count;
}

bool showsARow(const std::string& output) {
  return output.find("link (! undesired)") != std::string::npos && output.ends_with("\033[J");
}

TEST(LiveRun, ATableThatIsTakenAwayAtTheEnd) {
  const TemporaryFolder folder;
  ProgramInTerminal program({"run", explore, "--live", "--duration", "3600", "--out", folder.file("run")});
  while (!showsARow(program.output()) || drawingsIn(program.output()) < 3)
    ASSERT_TRUE(program.read(1000)) << program.output();
  const std::vector<std::string> shown = lastDrawing(program.output());
  ASSERT_GE(shown.size(), 4u);
  EXPECT_THAT(shown[0], MatchesRegex("[0-9.]+ of 3600.0 s, [0-9.]+ × real time, [0-9:]+ left"));
  EXPECT_THAT(shown[1], MatchesRegex("[0-9]+ links?, mean [0-9.]+, largest [0-9.]+, undesired [0-9.]+ N"));
  EXPECT_THAT(shown[3], HasSubstr("_"));                           // a link's name

  program.type("\003");                                            // Ctrl-C
  while (program.output().find("run folder: ") == std::string::npos) ASSERT_TRUE(program.read(1000));
  EXPECT_TRUE(program.settingsAreOrdinary());
  EXPECT_EQ(program.wait(), 130);
  const std::vector<std::string> rest = screenOf(program.output(), 1000);
  EXPECT_THAT(rest, Each(Not(AnyOf(HasSubstr("real time, "), HasSubstr("link (!")))));
  EXPECT_THAT(rest[0], StartsWith("explore-table with null-space, seed 1: interrupted"));
  EXPECT_THAT(program.output(), Not(HasSubstr("\033[?")));
}

TEST(LiveRun, ALineAtEveryTenthWhereThereIsNoTerminal) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"run", data("press.xml"), "--live", "--duration", "1", "--out", folder.file("run")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("\033")));
  for (int tenth = 1; tenth <= 10; ++tenth)
    EXPECT_THAT(outcome.err, HasSubstr("tactus run: " + std::to_string(tenth / 10) + "." + std::to_string(tenth % 10) +
                                       " of 1.0 s, "));
  EXPECT_THAT(outcome.err, HasSubstr(" left: 1 link, mean "));
}

/// Tenths are those of what is left to run.
TEST(LiveRun, ARunThatGoesOn) {
  const TemporaryFolder folder;
  const std::string stack = data("press.xml"), state = folder.file("run/state-0.8.json");
  ASSERT_EQ(tactus({"run", stack, "--duration", "1", "--save-at", "0.8", "--out", folder.file("run")}).exit_code, 0);
  const Outcome outcome =
      tactus({"run", stack, "--live", "--duration", "1", "--out", folder.file("rest"), "--from", state});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  size_t lines = 0;
  for (size_t at = 0; (at = outcome.err.find(" of 1.0 s, ", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 10u);
  EXPECT_THAT(outcome.err, StartsWith("tactus run: 0.8 of 1.0 s, "));
}

TEST(LiveRun, ChangesNoByteOfTheResults) {
  const TemporaryFolder folder;
  const std::vector<std::string> words{"run", explore, "--duration", "2.5", "--out"};
  const auto with = [&](const std::string& name, bool live) {
    std::vector<std::string> all = words;
    all.push_back(folder.file(name));
    if (live) all.push_back("--live");
    return all;
  };
  ASSERT_EQ(tactus(with("plain", false)).exit_code, 0);
  ASSERT_EQ(tactus(with("lines", true)).exit_code, 0);
  ProgramInTerminal terminal(with("table", true));
  ASSERT_EQ(terminal.wait(), 0);
  size_t compared = 0;
  for (const auto& entry : fs::directory_iterator(folder.file("plain"))) {
    const std::string name = entry.path().filename();
    // Where the wall clock stands.
    if (name == "timing.csv" || name == "run.json" || name == "report.html") continue;
    const std::string content = contentOf(entry.path());
    for (const char* other : {"lines", "table"}) EXPECT_EQ(contentOf(folder.file(other) + "/" + name), content) << name;
    ++compared;
  }
  EXPECT_GE(compared, 8u);
}

}  // namespace
}  // namespace tactus::testing
