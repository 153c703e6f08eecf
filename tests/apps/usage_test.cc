// What the program says to those who mistype, and to those who ask.

#include <gmock/gmock.h>

#include "framework/runtime/version.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(Usage, VersionIsData) {
  const Outcome outcome = tactus({"--version"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out, "tactus " TACTUS_VERSION "\n");
  EXPECT_EQ(outcome.err, "");
}

TEST(Usage, EveryCommandHasHelpWithExamples) {
  const std::vector<std::vector<std::string>> commands{{},
                                                       {"run"},
                                                       {"check"},
                                                       {"compare"},
                                                       {"solve"},
                                                       {"dynamics"},
                                                       {"golden"},
                                                       {"golden", "record"},
                                                       {"plugins"},
                                                       {"report"},
                                                       {"explain"},
                                                       {"golden", "verify"},
                                                       {"plugins", "list"},
                                                       {"completion"},
                                                       {"man"}};
  for (std::vector<std::string> command : commands) {
    command.push_back("--help");
    const Outcome outcome = tactus(command);
    EXPECT_EQ(outcome.exit_code, 0) << command[0];
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("Usage: tactus"), HasSubstr("Examples:\n  tactus "))) << command[0];
    EXPECT_EQ(outcome.err, "");
  }
}

TEST(Usage, NothingAskedIsUsage) {
  const Outcome outcome = tactus({});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("Usage: tactus"));
}

TEST(Usage, MisspelledCommand) {
  const Outcome outcome = tactus({"rnu", "stack.xml", "--seed", "3"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err, "tactus: unknown command 'rnu'; did you mean 'run'?\ntry 'tactus --help'\n");
}

TEST(Usage, MisspelledInnerCommand) {
  const Outcome outcome = tactus({"golden", "recrod", "case"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, StartsWith("tactus golden: unknown command 'recrod'; did you mean 'record'?"));
}

TEST(Usage, MisspelledOption) {
  const Outcome outcome = tactus({"run", data("press.xml"), "--durtion=5"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err,
            "tactus run: unknown option '--durtion=5'; did you mean '--duration'?\ntry 'tactus run --help'\n");
}

TEST(Usage, MisspelledOptionHidesNoMissingArgument) {
  const Outcome outcome = tactus({"run", "--sede", "5"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("did you mean '--seed'?"));
}

TEST(Usage, MissingArgument) {
  const Outcome outcome = tactus({"run"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, StartsWith("tactus run: STACK is required\n"));
}

TEST(Usage, NumbersThatAreNone) {
  EXPECT_THAT(tactus({"run", "x.xml", "--duration", "-1"}).err, HasSubstr("'-1' is not a number greater than 0 and at most 1e+06"));
  EXPECT_THAT(tactus({"run", "x.xml", "--duration", "1.5abc"}).err,
              HasSubstr("'1.5abc' is not a number greater than 0"));
  EXPECT_EQ(tactus({"run", "x.xml", "--duration", "1e300"}).exit_code, 2);
  for (const std::string seed : {"x", "-1", "1.5", "2147483648", ""}) {
    const Outcome outcome = tactus({"run", data("press.xml"), "--seed=" + seed});
    EXPECT_EQ(outcome.exit_code, 2) << seed;
  }
  EXPECT_THAT(tactus({"run", data("press.xml"), "--seed", "-1"}).err,
              HasSubstr("'-1' is not a whole number from 0 to 2147483647"));
}

TEST(Usage, DataThatCannotBeWrittenIsAFailure) {
  const TemporaryFolder folder;
  Settings full;
  full.out = "/dev/full";
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"run", data("press.xml"), "--json", "--duration", "0.01", "--out", folder.file("run")},
                                             {"plugins", "list"},
                                             {"explain"},
                                             {"check", data("press.xml")},
                                             {"--version"}}) {
    const Outcome outcome = tactus(command, full);
    EXPECT_EQ(outcome.exit_code, 6) << command[0];
    EXPECT_THAT(outcome.err, HasSubstr("tactus: standard output could not be written\n"));
  }
}

/// The commands that a help page shows for the shipped robots do what they promise.
TEST(Usage, TheRobotsOfTheHelpExist) {
  const std::string help = tactus({"dynamics", "--help"}).out;
  ASSERT_THAT(help, HasSubstr("tactus dynamics lwr_4plus --q 0,0,0,1.57,0,0,0 --qdd 0,0,0,1,0,0,0 --gravity 0,0,0"));
  EXPECT_EQ(tactus({"dynamics", "lwr_4plus", "--q", "0,0,0,1.57,0,0,0", "--qdd", "0,0,0,1,0,0,0", "--gravity", "0,0,0"})
                .exit_code, 0);
}

}  // namespace
}  // namespace tactus::testing
