// Scripts for shells' completion: each knows every command and option that the help shows, and what bash makes of its
// script is what a user would see.  What zsh and fish make of theirs is not tried, only that they can read them.

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <regex>
#include <sstream>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::UnorderedElementsAreArray;
using Words = std::vector<std::string>;

/// A command as its help shows it.
struct Shown {
  Words path;
  Words commands;
  Words options;                                                   ///< long ones
};

std::string joined(const Words& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

/// First words of the lines below a heading, down to the next empty line.
Words listedBelow(const std::string& heading, const std::string& help) {
  Words words;
  bool inside = false;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    if (line == heading) inside = true;
    if (line.empty()) inside = false;
    static const std::regex entry("  ([^ ]+).*");
    std::smatch match;
    if (inside && std::regex_match(line, match, entry)) words.push_back(match[1]);
  }
  return words;
}

/// The program's whole tree, from what it says of itself.
std::vector<Shown> everyCommand(const Words& path = {}) {
  Words asked = path;
  asked.push_back("--help");
  const std::string help = tactus(asked).out;
  Shown shown{path, listedBelow("Subcommands:", help), {}};
  for (const std::string& names : listedBelow("Options:", help)) {  // "-h,--help"
    const size_t at = names.find("--");
    if (at != std::string::npos) shown.options.push_back(names.substr(at));
  }
  std::vector<Shown> all{shown};
  for (const std::string& inner : shown.commands) {
    Words further = path;
    further.push_back(inner);
    for (Shown& one : everyCommand(further)) all.push_back(std::move(one));
  }
  return all;
}

int shell(const std::string& command, std::string& said) {
  said.clear();
  FILE* pipe = ::popen(("(" + command + ") 2>&1").c_str(), "r");
  if (!pipe) return -1;
  char part[4096];
  for (size_t count; (count = std::fread(part, 1, sizeof part, pipe)) > 0;) said.append(part, count);
  return WEXITSTATUS(::pclose(pipe));
}

class Completion : public ::testing::Test {
 protected:
  /// The script's file.
  std::string script(const std::string& name) {
    const Outcome outcome = tactus({"completion", name});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return folder_.write("completion." + name, outcome.out);
  }

  /// What bash offers for the last of these words, in a folder with a file `stack.xml` and a folder `stacks`.
  Words offered(const Words& words) {
    std::string typed;
    for (const std::string& word : words) typed += " '" + word + "'";
    std::filesystem::create_directories(folder_.file("room/stacks"));
    folder_.write("room/stack.xml", "");
    const std::string asking = folder_.write(
        "ask.bash", "source " + script("bash") + "\ncd " + folder_.file("room") + "\nCOMP_WORDS=(" + typed +
                        ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) +
                        "\n_tactus\nprintf '%s\\n' \"${COMPREPLY[@]}\"\n");
    std::string said;
    EXPECT_EQ(shell("bash " + asking, said), 0) << said;
    Words found;
    std::istringstream lines(said);
    for (std::string each; std::getline(lines, each);)
      if (!each.empty()) found.push_back(each);
    return found;
  }

  void expectReadable(const std::string& name) {
    std::string said;
    if (shell("command -v " + name, said) != 0) GTEST_SKIP() << name << " is not installed";
    EXPECT_EQ(shell(name + " -n " + script(name), said), 0) << said;
    EXPECT_EQ(said, "");
  }

  TemporaryFolder folder_;
};

TEST_F(Completion, BashCanReadItsScript) { expectReadable("bash"); }
TEST_F(Completion, ZshCanReadItsScript) { expectReadable("zsh"); }
TEST_F(Completion, FishCanReadItsScript) { expectReadable("fish"); }

TEST_F(Completion, BashCompletesCommandsAndOptions) {
  EXPECT_THAT(offered({"tactus", "ru"}), ElementsAre("run"));
  EXPECT_THAT(offered({"tactus", "golden", "re"}), ElementsAre("record"));
  EXPECT_THAT(offered({"tactus", "run", "--du"}), ElementsAre("--duration"));
  EXPECT_THAT(offered({"tactus", "run", "x.xml", "--duration", "1", "--see"}), ElementsAre("--seed"));
  EXPECT_THAT(offered({"tactus", "xyz"}), IsEmpty());
}

TEST_F(Completion, BashCompletesValues) {
  EXPECT_THAT(offered({"tactus", "run", "--backend", "nu"}), ElementsAre("null-space"));
  EXPECT_THAT(offered({"tactus", "run", "--backend", "=", "nu"}), ElementsAre("null-space"));
  EXPECT_THAT(offered({"tactus", "run", "--backend", "="}), Contains("hqp"));
  EXPECT_THAT(offered({"tactus", "schema", "x"}), ElementsAre("xsd"));
  EXPECT_THAT(offered({"tactus", "explain", "imp"}), ElementsAre("impedance"));
  EXPECT_THAT(offered({"tactus", "run", "sta"}), UnorderedElementsAreArray({"stack.xml", "stacks"}));
  EXPECT_THAT(offered({"tactus", "run", "x.xml", "--out", "sta"}), ElementsAre("stacks"));
  EXPECT_THAT(offered({"tactus", "run", "x.xml", "--seed", ""}), IsEmpty());
}

/// A value that is called like a command is none.
TEST_F(Completion, BashTakesNoValueForACommand) {
  EXPECT_THAT(offered({"tactus", "plugins", "check", "--stack", "list", "--st"}), ElementsAre("--stack"));
  EXPECT_THAT(offered({"tactus", "plugins", "check", "--s"}), ElementsAre("--stack"));
}

TEST_F(Completion, BashKnowsEveryCommandAndOptionOfTheHelp) {
  for (const Shown& command : everyCommand()) {
    Words words{"tactus"};
    words.insert(words.end(), command.path.begin(), command.path.end());
    words.push_back("--");
    EXPECT_THAT(offered(words), UnorderedElementsAreArray(command.options)) << joined(words, " ");
    words.back() = "";
    if (command.commands.empty()) continue;
    EXPECT_THAT(offered(words), UnorderedElementsAreArray(command.commands)) << joined(words, " ");
  }
}

TEST_F(Completion, ZshKnowsEveryCommandAndOptionOfTheHelp) {
  const std::string text = contentOf(script("zsh"));
  for (const Shown& command : everyCommand()) {
    Words name = command.path;
    name.insert(name.begin(), "_tactus");
    const std::string start = "\n" + joined(name, "_") + "() {\n";
    const size_t at = text.find(start);
    ASSERT_NE(at, std::string::npos) << start;
    const std::string body = text.substr(at, text.find("\n}\n", at) - at);
    for (const std::string& option : command.options)
      EXPECT_TRUE(std::regex_search(body, std::regex("'\\*" + option + "=?\\["))) << start << option;
    for (const std::string& inner : command.commands)
      EXPECT_THAT(body, ::testing::AllOf(HasSubstr("'" + inner + ":"),
                                         HasSubstr(inner + ") " + joined(name, "_") + "_" + inner + " ;;")));
  }
}

TEST_F(Completion, FishKnowsEveryCommandAndOptionOfTheHelp) {
  const std::string text = contentOf(script("fish"));
  for (const Shown& command : everyCommand()) {
    const std::string way = std::string(command.commands.empty() ? "in" : "to") + (command.path.empty() ? "" : " ");
    const std::string start = "complete -c tactus -n '__tactus_leads " + way + joined(command.path, " ") + "'";
    for (const std::string& option : command.options)
      EXPECT_THAT(text, HasSubstr(start + " -l " + option.substr(2) + " "));
    for (const std::string& inner : command.commands) EXPECT_THAT(text, HasSubstr(start + " -a " + inner + " "));
  }
}

TEST_F(Completion, TheHelpIsReadWhole) {
  std::vector<std::string> commands;
  for (const Shown& command : everyCommand()) commands.push_back(joined(command.path, " "));
  EXPECT_THAT(commands, IsSupersetOf({"", "run", "golden record", "plugins check", "completion"}));
}

TEST_F(Completion, OtherShellsAreRefused) {
  const Outcome outcome = tactus({"completion", "tcsh"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.err, "tactus: completion is for 'bash', 'zsh' or 'fish', not for 'tcsh'\n");
}

TEST_F(Completion, TheHelpSaysHowEachShellTakesIt) {
  const std::string help = tactus({"completion", "--help"}).out;
  for (const std::string name : {"bash", "zsh", "fish"})
    EXPECT_THAT(help, HasSubstr("  tactus completion " + name + " > "));
}

}  // namespace
}  // namespace tactus::testing
