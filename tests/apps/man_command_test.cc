// Manual pages: each command has one, with every option and sub-command that its help shows, in troff without warnings.

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <regex>
#include <set>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

std::set<std::string> matches(const std::string& text, const std::string& pattern) {
  std::set<std::string> found;
  const std::regex regex(pattern);
  for (std::sregex_iterator at(text.begin(), text.end(), regex), end; at != end; ++at) found.insert((*at)[1]);
  return found;
}

/// "tactus-golden-record.1" → {"golden", "record"}
std::vector<std::string> commandOf(const fs::path& page) {
  std::vector<std::string> words;
  std::stringstream name(page.stem().string());
  for (std::string word; std::getline(name, word, '-');) words.push_back(word);
  words.erase(words.begin());
  return words;
}

TEST(ManCommand, EveryOptionAndCommandOfTheHelpHasItsLine) {
  const TemporaryFolder folder;
  ASSERT_EQ(tactus({"man", "--out", folder.file("man1")}).exit_code, 0);
  std::set<std::string> pages;
  for (const auto& entry : fs::directory_iterator(folder.file("man1"))) {
    pages.insert(entry.path().filename());
    std::vector<std::string> command = commandOf(entry.path());
    std::string page = contentOf(entry.path());
    command.push_back("--help");
    const std::string help = tactus(command).out;
    page = std::regex_replace(page, std::regex("\\\\-"), "-");
    const auto options = matches(help, "\n  (?:-[a-z],)?(--[a-z-]+)");
    EXPECT_FALSE(options.empty()) << help;
    EXPECT_EQ(matches(page, "\\\\fB(--[a-z-]+)"), options) << entry.path();
  }
  for (const char* name : {"tactus.1", "tactus-run.1", "tactus-golden-record.1", "tactus-plugins-check.1",
                           "tactus-man.1"})
    EXPECT_TRUE(pages.count(name)) << name;
  std::string help = tactus({"--help"}).out;
  help = help.substr(help.find("Subcommands:"), help.find("Examples:") - help.find("Subcommands:"));
  const auto commands = matches(help, "\n  ([a-z]+)");
  EXPECT_GE(commands.size(), 15u) << help;
  for (const std::string& command : commands) EXPECT_TRUE(pages.count("tactus-" + command + ".1")) << command;
}

TEST(ManCommand, APageHasItsSections) {
  const Outcome run = tactus({"man", "run"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out, AllOf(HasSubstr(".TH TACTUS-RUN 1 "),
                             HasSubstr("tactus\\-run \\- run a stack on the simulated robot"),
                             HasSubstr(".SH SYNOPSIS\n.B tactus run\n[\\fIOPTIONS\\fR] \\fISTACK\\fR\n"),
                             HasSubstr("\\fB\\-\\-backend\\fR \\fIBACKEND\\fR\n"),
                             HasSubstr(".SH EXAMPLES\n.nf\n  tactus run "),
                             HasSubstr(".SH \"SEE ALSO\"\n\\fBtactus\\fR(1)\n")));
  EXPECT_THAT(tactus({"man"}).out, AllOf(HasSubstr("tactus \\- XML stacks of contact tasks"),
                                         HasSubstr(".SH \"EXIT STATUS\"\n0 done, 1 comparison or golden mismatch"),
                                         HasSubstr("\\fBtactus\\-run\\fR(1),\n")));
  EXPECT_EQ(tactus({"man", "golden", "recrod"}).exit_code, 2);
  EXPECT_EQ(tactus({"man", "run", "--out", "/tmp"}).exit_code, 2);
  EXPECT_EQ(tactus({"man", "--out", "/proc/none"}).exit_code, 6);
}

TEST(ManCommand, TroffHasNothingToSay) {
  if (std::system("command -v groff >/dev/null") != 0) GTEST_SKIP() << "there is no groff";
  const TemporaryFolder folder;
  ASSERT_EQ(tactus({"man", "--out", folder.path()}).exit_code, 0);
  const std::string said = folder.file("said");
  EXPECT_EQ(std::system(("cd " + folder.path() + " && groff -k -man -ww -z *.1 2> " + said).c_str()), 0);
  EXPECT_EQ(contentOf(said), "");
}

}  // namespace
}  // namespace tactus::testing
