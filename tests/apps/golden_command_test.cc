#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <thread>

#include "framework/runtime/version.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class GoldenCommandTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome outcome = tactus({"golden", "record", golden(), "--stack", data("press.xml"), "--duration", "0.4",
                                    "--reason", "the test needs one"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  std::string golden() const { return folder.file("press-short"); }
  std::string stack() const { return contentOf(golden() + "/stack.xml"); }
  void change(const std::string& file, const std::string& from, const std::string& to) {
    std::string content = contentOf(golden() + "/" + file);
    const size_t at = content.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    folder.write("press-short/" + file, content.replace(at, from.size(), to));
  }
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::directory_iterator(golden())) files[entry.path().string()] = contentOf(entry.path());
    return files;
  }

  TemporaryFolder folder;
};

TEST_F(GoldenCommandTest, CaseHasItsFourFiles) {
  EXPECT_EQ(files().size(), 4u);
  const nlohmann::json provenance = nlohmann::json::parse(contentOf(golden() + "/provenance.json"));
  EXPECT_EQ(provenance["reason"], "the test needs one");
  EXPECT_EQ(provenance["duration_s"], 0.4);
  EXPECT_EQ(provenance["versions"]["tactus"], TACTUS_VERSION);
  EXPECT_TRUE(provenance["inputs"].contains("finger.urdf"));
  EXPECT_THAT(stack(), Not(HasSubstr("=\"/"))) << "a case names no place of this machine";
}

TEST_F(GoldenCommandTest, VerifyPassesAndWritesNothing) {
  const auto before = files();
  const Outcome outcome = tactus({"golden", "verify", golden(), "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["cases"][0]["passed"], true);
  EXPECT_EQ(files(), before);
}

TEST_F(GoldenCommandTest, OnePercentOfAGainIsFoundAndNamed) {
  change("stack.xml", "stiffness=\"1\"", "stiffness=\"1.01\"");
  const auto before = files();
  const Outcome outcome = tactus({"golden", "verify", golden(), "--json"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("FAILED"));
  EXPECT_THAT(outcome.err, HasSubstr("first divergence: "));
  EXPECT_THAT(outcome.err, HasSubstr("task/bow/error (task 'bow') at time "));
  EXPECT_THAT(outcome.err, HasSubstr("× its tolerance, first at time "));
  const nlohmann::json failures = outcome.json()["cases"][0]["failures"];
  ASSERT_FALSE(failures.empty());
  EXPECT_TRUE(failures[0].contains("column") && failures[0].contains("time") && failures[0].contains("task"));
  EXPECT_EQ(files(), before) << "verify wrote into the case";
}

TEST_F(GoldenCommandTest, NewLogIsKeptWhereAskedFor) {
  ASSERT_EQ(tactus({"golden", "verify", golden(), "--keep", folder.file("new")}).exit_code, 0);
  EXPECT_EQ(contentOf(folder.file("new/press-short.csv")), contentOf(golden() + "/expected.csv"));
}

TEST_F(GoldenCommandTest, RenewingKeepsStackAndTolerances) {
  change("tolerances.xml", "atol=\"1e-6\"", "atol=\"1e-5\"");
  const auto before = files();
  ASSERT_EQ(tactus({"golden", "record", golden(), "--reason", "renewed"}).exit_code, 0);
  for (const auto& [file, content] : files()) {
    if (!file.ends_with("provenance.json")) {
      EXPECT_EQ(content, before.at(file)) << file;
    }
  }
  EXPECT_THAT(contentOf(golden() + "/provenance.json"), HasSubstr("renewed"));
}

TEST_F(GoldenCommandTest, RenewingTakesOptionsToo) {
  ASSERT_EQ(tactus({"golden", "record", golden(), "--duration", "0.2", "--reason", "shorter"}).exit_code, 0);
  EXPECT_THAT(stack(), HasSubstr("duration=\"0.2\""));
  EXPECT_EQ(tactus({"golden", "verify", golden()}).exit_code, 0);
}

TEST_F(GoldenCommandTest, AFailedRecordingLeavesTheCaseAsItWas) {
  const auto before = files();
  const auto expectUntouched = [&] {
    EXPECT_EQ(files(), before);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1) << "something was left over";
  };
  Settings small;
  small.largest_file = 8000;
  const Outcome full = tactus({"golden", "record", golden(), "--duration", "1", "--reason", "full disk"}, small);
  EXPECT_EQ(full.exit_code, 6);
  EXPECT_THAT(full.err, HasSubstr("cannot be written"));
  expectUntouched();

  const TemporaryFolder elsewhere;
  const std::string broken = changedStack(elsewhere, "stiffness=\"1\"", "stiffness=\"nan\"");
  EXPECT_EQ(tactus({"golden", "record", golden(), "--stack", broken, "--reason", "broken"}).exit_code, 3);
  expectUntouched();

  RunningProgram program({"golden", "record", golden(), "--duration", "3600", "--reason", "too long"});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  program.send(SIGINT);
  EXPECT_EQ(program.wait().exit_code, 130);
  expectUntouched();
}

TEST_F(GoldenCommandTest, RecordingKeepsOtherFilesOfTheCase) {
  folder.write("press-short/notes.md", "why this case is here");
  ASSERT_EQ(tactus({"golden", "record", golden() + "/", "--reason", "renewed"}).exit_code, 0);
  EXPECT_EQ(contentOf(golden() + "/notes.md"), "why this case is here");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 1);
}

TEST(GoldenCommand, FilesOfShapesAreNamedFromTheCase) {
  const TemporaryFolder folder;
  folder.write("wedge.obj", contentOf(TACTUS_SOURCE_DIR "/tests/conformance/every_shape.obj"));
  const std::string stack = folder.write(
      "stack.xml",
      "<stack format='1'><robot model='lwr_4plus'/><scene><object name='wedge' pose='1 0 0'><mesh file='wedge.obj' "
      "scale='0.001' cell='0.01'/></object></scene><level priority='1'><posture name='rest' joints='arm'/></level>"
      "<controller backend='null-space'/></stack>");
  const Outcome recorded =
      tactus({"golden", "record", folder.file("case"), "--stack", stack, "--duration", "0.01", "--reason", "to see"});
  ASSERT_EQ(recorded.exit_code, 0) << recorded.err;
  EXPECT_THAT(contentOf(folder.file("case/stack.xml")), HasSubstr("file=\"../wedge.obj\""));
  EXPECT_TRUE(nlohmann::json::parse(contentOf(folder.file("case/provenance.json")))["inputs"].contains("wedge.obj"));
  EXPECT_EQ(tactus({"golden", "verify", folder.file("case")}).exit_code, 0);
}

TEST(GoldenCommand, ForeignFolderIsLeftAlone) {
  const TemporaryFolder folder;
  folder.write("thesis.tex", "years of work");
  const Outcome outcome = tactus({"golden", "record", folder.path(), "--stack", data("press.xml"), "--reason", "to see"});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("holds files that are not of a golden case"));
  EXPECT_EQ(contentOf(folder.file("thesis.tex")), "years of work");
}

TEST_F(GoldenCommandTest, TolerancesAreChecked) {
  change("tolerances.xml", "rtol=", "rtoll=");
  const Outcome outcome = tactus({"golden", "verify", golden()});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("<tolerance> has no attribute 'rtoll'; expected columns, atol, rtol"));
}

TEST(GoldenCommand, RecordingWantsAReason) {
  const TemporaryFolder folder;
  EXPECT_EQ(tactus({"golden", "record", folder.file("case"), "--stack", data("press.xml")}).exit_code, 2);
  const Outcome outcome =
      tactus({"golden", "record", folder.file("case"), "--stack", data("press.xml"), "--reason", " "});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--reason must say why"));
  EXPECT_FALSE(fs::exists(folder.file("case")));
}

TEST(GoldenCommand, MissingCase) {
  const Outcome outcome = tactus({"golden", "verify", "no-such-case"});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("tests/golden/no-such-case/expected.csv"));
}

/// The project's own cases.
TEST(GoldenCases, AllPass) {
  std::vector<std::string> arguments{"golden", "verify"};
  for (const auto& entry : fs::directory_iterator(std::string(TACTUS_SOURCE_DIR) + "/tests/golden")) {
    if (entry.is_directory()) arguments.push_back(entry.path().string());
  }
  ASSERT_GT(arguments.size(), 2u) << "no golden case";
  const Outcome outcome = tactus(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
}

TEST(GoldenCases, ShortMainJobFeelsOnePercentOfAGain) {
  const TemporaryFolder folder;
  const std::string golden = std::string(TACTUS_SOURCE_DIR) + "/tests/golden/explore-table-short";
  fs::copy(golden, folder.file("changed"));
  std::string stack = contentOf(golden + "/stack.xml");
  const size_t elbow = stack.find("<posture name=\"elbow\""), gain = stack.find("stiffness=\"20\"", elbow);
  ASSERT_NE(gain, std::string::npos);
  folder.write("changed/stack.xml", stack.replace(gain, 14, "stiffness=\"20.2\""));
  const Outcome outcome = tactus({"golden", "verify", folder.file("changed")});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("first divergence: "));
  EXPECT_THAT(outcome.err, ::testing::ContainsRegex("task/[a-z-]+/[a-z_]+ [(]task '[a-z-]+'[)] at time [0-9.]+ s"));
}

}  // namespace
}  // namespace tactus::testing
