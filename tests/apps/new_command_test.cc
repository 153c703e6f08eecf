// What `tactus new` writes, and what it refuses.  That a new plugin builds is tested against an installed Tactus
// (tests/package).

#include <gmock/gmock.h>

#include <filesystem>
#include <sstream>

#include "framework/control/element_table.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

TEST(NewStack, PassesCheckAndRuns) {
  const TemporaryFolder folder;
  const Outcome made = tactus({"new", "stack", "first", "--out", folder.path()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(made.out, folder.file("first.xml") + "\n");
  const Outcome run = tactus({"run", folder.file("first.xml"), "--out", folder.file("run")});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(tactus({"run", folder.file("first.xml"), "--set", "height=0.5", "--duration", "0.1", "--out",
                    folder.file("lower")}).exit_code, 0);
}

TEST(NewPlugin, NoPlaceholderIsLeft) {
  const TemporaryFolder folder;
  const Outcome made = tactus({"new", "plugin", "acme", "--out", folder.path()});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  int files = 0;
  for (const auto& entry : fs::directory_iterator(folder.file("acme"))) {
    EXPECT_EQ(contentOf(entry.path()).find('@'), std::string::npos) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 7);
  EXPECT_THAT(contentOf(folder.file("acme/stack.xml")), HasSubstr("<acme.reach name=\"reach\""));
  EXPECT_THAT(made.err, HasSubstr("README.md has the commands"));
}

/// The commands of docs/plugins.md are those of the README, which tests/package runs.
TEST(NewPlugin, ThePageAboutPluginsShowsTheCommandsOfItsReadme) {
  const TemporaryFolder folder;
  tactus({"new", "plugin", "acme", "--out", folder.path()});
  const std::string readme = contentOf(folder.file("acme/README.md"));
  const std::string page = contentOf(TACTUS_SOURCE_DIR "/docs/plugins.md");
  const size_t begin = page.find("```sh\n") + 6;
  std::istringstream commands(page.substr(begin, page.find("```", begin) - begin));
  std::string line;
  std::getline(commands, line);
  EXPECT_EQ(line, "tactus new plugin acme && cd acme");
  int lines = 0;
  for (; std::getline(commands, line); ++lines) {
    const std::string command = line.substr(0, line.find(" #"));
    EXPECT_THAT(readme, HasSubstr("\n" + command.substr(0, command.find_last_not_of(' ') + 1))) << line;
  }
  EXPECT_EQ(lines, 5);
}

/// Every name that is taken can begin an element's name, and every other one is refused.
TEST(NewPlugin, NamesAreThoseThatElementsCanBeginWith) {
  const TemporaryFolder folder;
  for (const std::string name :
       {"a", "acme", "acme-2", "Acme_x", "1acme", "acme.x", "ac me", "-x", "acme/x", "", "äcme"}) {
    control::ElementTable table;
    bool fits = name.find('.') == std::string::npos;
    try {
      table.add({.name = name + ".reach", .kind = control::ElementKind::task});
    } catch (const std::invalid_argument&) {
      fits = false;
    }
    const Outcome outcome = tactus({"new", "plugin", "--out", folder.path(), "--", name});
    EXPECT_EQ(outcome.exit_code, fits ? 0 : 2) << "'" << name << "': " << outcome.err;
    if (!fits) {
      EXPECT_THAT(outcome.err, HasSubstr("'" + name + "' is not a name: it begins with a letter"));
    }
  }
}

TEST(NewPlugin, NamesOfOthersAreRefused) {
  const TemporaryFolder folder;
  const Outcome shipped = tactus({"new", "plugin", "qp", "--out", folder.path()});
  EXPECT_EQ(shipped.exit_code, 2);
  EXPECT_THAT(shipped.err, HasSubstr("'qp' is a plugin that Tactus ships; take another name"));
  const Outcome target = tactus({"new", "plugin", "test", "--out", folder.path()});
  EXPECT_EQ(target.exit_code, 2);
  EXPECT_THAT(target.err, HasSubstr("a plugin cannot be called 'test': CMake has a target of that name"));
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(New, NothingIsOverwritten) {
  const TemporaryFolder folder;
  fs::create_directory(folder.file("acme"));
  folder.write("first.xml", "mine");
  const Outcome plugin = tactus({"new", "plugin", "acme", "--out", folder.path()});
  EXPECT_EQ(plugin.exit_code, 6);
  EXPECT_THAT(plugin.err, HasSubstr(folder.file("acme") + ": is there already; give another name"));
  const Outcome stack = tactus({"new", "stack", "first", "--out", folder.path()});
  EXPECT_EQ(stack.exit_code, 6);
  EXPECT_THAT(stack.err, HasSubstr("first.xml: is there already"));
  EXPECT_TRUE(fs::is_empty(folder.file("acme")));
  EXPECT_EQ(contentOf(folder.file("first.xml")), "mine");
}

TEST(New, PlacesThatCannotBeWrittenAreNamed) {
  const Outcome missing = tactus({"new", "plugin", "acme", "--out", "/nowhere"});
  EXPECT_EQ(missing.exit_code, 6);
  EXPECT_THAT(missing.err, HasSubstr("/nowhere: is not a folder"));
  const Outcome refused = tactus({"new", "plugin", "acme", "--out", "/proc"});
  EXPECT_EQ(refused.exit_code, 6);
  EXPECT_THAT(refused.err, HasSubstr("/proc/acme: cannot be made: "));
}

/// A disk that is full halfway leaves nothing behind.
TEST(New, AFailureHalfwayLeavesNothing) {
  const TemporaryFolder folder;
  Settings full;
  full.largest_file = 1500;
  const Outcome outcome = tactus({"new", "plugin", "acme", "--out", folder.path()}, full);
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_TRUE(fs::is_empty(folder.path())) << outcome.err;
}

}  // namespace
}  // namespace tactus::testing
