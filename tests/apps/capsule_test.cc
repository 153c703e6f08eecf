// Failure capsules: what a run leaves of a tick that went wrong, and what `tactus solve` makes of it.

#include <gmock/gmock.h>

#include <filesystem>
#include <limits>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kPlugin = std::string(TEST_PLUGINS) + "/naughty.so";

std::vector<std::string> capsulesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("capsule")) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A run of the small stack with the back end that fails when it likes to.
struct MoodyRun {
  TemporaryFolder folder;
  Outcome outcome;
  nlohmann::json run;

  explicit MoodyRun(const std::string& options) {
    outcome = tactus({"run", data("press.xml"), "--plugin", kPlugin, "--backend", "naughty.moody" + options,
                      "--duration", "0.05", "--out", folder.file("run")});
    run = nlohmann::json::parse(contentOf(folder.file("run/run.json")));
  }
  std::string capsule(const std::string& name) const { return folder.file("run/" + name); }
};

TEST(Capsule, OfTheFirstFiveFailedTicks) {
  const MoodyRun moody("");
  EXPECT_THAT(capsulesIn(moody.folder.file("run")),
              ElementsAre("capsule-20.json", "capsule-21.json", "capsule-22.json", "capsule-23.json",
                          "capsule-24.json"));
  EXPECT_EQ(moody.run["capsules"].size(), 5u);
  EXPECT_EQ(moody.run["capsules"][0], "capsule-20.json");
  EXPECT_EQ(moody.outcome.exit_code, 0) << "20 ticks were solved";
  EXPECT_THAT(moody.outcome.err, HasSubstr("failed ticks are kept: tactus solve " + moody.folder.file("run") +
                                           "/capsule-20.json\n"));
}

TEST(Capsule, HoldsWhatTheTickWasMadeOf) {
  const MoodyRun moody("/until=21");
  const nlohmann::json file = nlohmann::json::parse(contentOf(moody.capsule("capsule-20.json")));
  EXPECT_EQ(file["format"], "tactus-tick/1");
  EXPECT_EQ(file["dof"], 3);
  const nlohmann::json& capsule = file["capsule"];
  EXPECT_EQ(capsule["backend"], "naughty.moody");
  EXPECT_EQ(capsule["options"], nlohmann::json({{"fault", "fail"}, {"from", "20"}, {"until", "21"}}));
  EXPECT_EQ(capsule["warm_start"], nlohmann::json({20})) << "that before the tick";
  EXPECT_EQ(capsule["status"], "failed");
  EXPECT_EQ(capsule["message"], "not in the mood");
  EXPECT_EQ(capsule["tick"], 20);
  EXPECT_NEAR(capsule["time"].get<double>(), 0.02, 1e-12);
  EXPECT_EQ(capsule["joints"], nlohmann::json({"hip", "knee", "tip"}));
  EXPECT_EQ(capsule["q"].size(), 3u);
  EXPECT_EQ(capsule["stack"], contentOf(moody.folder.file("run/stack.resolved.xml")));
  EXPECT_EQ(capsule["places"]["hold"], data("press.xml") + ":12:23");
}

class CapsuleOfAFault : public ::testing::TestWithParam<const char*> {};

TEST_P(CapsuleOfAFault, IsReproducedToTheBit) {
  const MoodyRun moody(std::string("/until=22/fault=") + GetParam());
  for (const std::string name : {"capsule-20.json", "capsule-21.json"}) {
    const Outcome outcome = tactus({"solve", moody.capsule(name), "--plugin", kPlugin, "--json"});
    EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("naughty.moody: reproduced to the bit\n"));
    const nlohmann::json json = outcome.json();
    EXPECT_EQ(json["capsule"]["reproduced"], true);
    EXPECT_EQ(json["capsule"]["difference_Nm"], 0.0);
    EXPECT_EQ(json["torque"], nlohmann::json::parse(contentOf(moody.capsule(name)))["capsule"]["torque"]);
  }
}

INSTANTIATE_TEST_SUITE_P(Faults, CapsuleOfAFault, ::testing::Values("fail", "late", "nan"),
                         [](const auto& info) { return std::string(info.param); });

class CapsuleOfAThrow : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(CapsuleOfAThrow, EndsTheRunAndIsReproduced) {
  const auto& [fault, what] = GetParam();
  const MoodyRun moody(std::string("/fault=") + fault);
  const std::string message = std::string("back end 'naughty.moody' failed at t = 0.02 s: ") + what;
  EXPECT_EQ(moody.outcome.exit_code, 4);
  EXPECT_THAT(moody.outcome.err, HasSubstr("tactus run: " + message + "; the log is kept\n"));
  EXPECT_EQ(moody.run["status"], "tick-error");
  EXPECT_EQ(moody.run["capsules"], nlohmann::json({"capsule-20.json"}));
  const nlohmann::json file = nlohmann::json::parse(contentOf(moody.capsule("capsule-20.json")));
  EXPECT_EQ(file["capsule"]["threw"], true);
  EXPECT_EQ(file["capsule"]["message"], what);
  EXPECT_EQ(file["capsule"]["warm_start"], nlohmann::json({20})) << "that before the tick, not what the throw left";
  EXPECT_EQ(file["capsule"]["stack"], contentOf(moody.folder.file("run/stack.resolved.xml")));
  EXPECT_EQ(file["levels"].size(), 2u);

  const Outcome again = tactus({"solve", moody.capsule("capsule-20.json"), "--plugin", kPlugin, "--json"});
  EXPECT_EQ(again.exit_code, 5);
  EXPECT_THAT(again.err, HasSubstr("naughty.moody: reproduced: the back end threw again\n"));
  EXPECT_THAT(again.err, HasSubstr(std::string("failed: the back end threw: ") + what + "\n"));
  EXPECT_EQ(again.json()["capsule"]["reproduced"], true);
  EXPECT_EQ(again.json()["message"], std::string("the back end threw: ") + what);

  const Outcome other =
      tactus({"solve", moody.capsule("capsule-20.json"), "--plugin", kPlugin, "--option", "from=30"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr(std::string("not reproduced: in the run the back end threw: ") + what + "\n"));

  const Outcome all = tactus({"solve", moody.capsule("capsule-20.json"), "--plugin", kPlugin, "--backend", "any"});
  EXPECT_EQ(all.exit_code, 0) << "the others solve it";
  EXPECT_THAT(all.err, HasSubstr(std::string("naughty.moody: the back end threw: ") + what + "\n"));
}

INSTANTIATE_TEST_SUITE_P(Faults, CapsuleOfAThrow,
                         ::testing::Values(std::pair{"throw", "no licence for tick 20"},
                                           std::pair{"throw-other", "it threw something that is not a std::exception"}),
                         [](const auto& info) { return std::string(info.index ? "NoException" : "Exception"); });

TEST(Capsule, OfATaskThatThrewThereIsNone) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "<level priority=\"2\">",
                                         "<level priority=\"2\"><naughty.task name=\"imp\" fault=\"throw\"/>");
  EXPECT_EQ(tactus({"run", stack, "--plugin", kPlugin, "--out", folder.file("run")}).exit_code, 4);
  EXPECT_THAT(capsulesIn(folder.file("run")), ElementsAre()) << "its problem is not whole";
}

/// A shipped back end in the middle of a run that goes wrong: the finger's motors are weak, its posture is stiff, and
/// three iterations are few.
class CapsuleOfABackEnd : public ::testing::TestWithParam<const char*> {
 protected:
  CapsuleOfABackEnd() {
    std::string stack = contentOf(data("press.xml")), robot = contentOf(data("finger.urdf"));
    const auto replace = [](std::string& text, const std::string& from, const std::string& to) {
      for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    };
    replace(robot, "effort=\"20\"", "effort=\"0.6\"");
    replace(robot, "upper=\"1.5\"", "upper=\"0.45\"");
    replace(stack, "rate=\"1000\"", "rate=\"1000\" deadline-iterations=\"3\"");
    replace(stack, "<level priority=\"1\">", "<level priority=\"1\"><joint-limits name=\"limits\"/>");
    replace(stack, "stiffness=\"1\"", "stiffness=\"30\"");
    folder.write("finger.urdf", robot);
    const Outcome outcome = tactus({"run", folder.write("stack.xml", stack), "--backend", GetParam(), "--duration",
                                    "0.3", "--out", folder.file("run")});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const std::string& name : capsulesIn(folder.file("run"))) capsules.push_back(folder.file("run/" + name));
  }
  TemporaryFolder folder;
  std::vector<std::string> capsules;
};

TEST_P(CapsuleOfABackEnd, IsReproducedToTheBitAndAcceptedByOthers) {
  ASSERT_EQ(capsules.size(), 5u);
  const bool starts_warm = std::string(GetParam()) != "null-space";
  int late = 0, warm = 0;
  for (const std::string& capsule : capsules) {
    nlohmann::json file = nlohmann::json::parse(contentOf(capsule));
    const nlohmann::json recorded = file["capsule"];
    // As it stands, and with the back end named as a user would.
    for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--backend", GetParam()}}) {
      std::vector<std::string> arguments{"solve", capsule, "--json"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      const Outcome outcome = tactus(arguments);
      EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
      EXPECT_THAT(outcome.err, HasSubstr(": reproduced to the bit\n"));
      EXPECT_EQ(outcome.json()["torque"], recorded["torque"]);
      EXPECT_EQ(outcome.json()["iterations"], recorded["iterations"]);
      EXPECT_EQ(outcome.json()["status"], recorded["status"]);
    }
    late += recorded["late"] == true;
    const auto& start = recorded["warm_start"];
    warm += std::any_of(start.begin(), start.end(), [](const nlohmann::json& number) { return number != 0; });
    const Outcome any = tactus({"solve", capsule, "--backend", "any", "--json"});
    EXPECT_EQ(any.exit_code, 0) << any.err;
    ASSERT_EQ(any.json().size(), 3u);
    EXPECT_EQ(any.json()[0]["capsule"]["reproduced"], true);
    int solved = 0;
    for (const nlohmann::json& entry : any.json()) {
      EXPECT_EQ(entry["torque"].size(), 3u);
      solved += entry["status"] == "ok";
    }
    EXPECT_GE(solved, 1) << "without its deadline, or by another back end";
  }
  EXPECT_EQ(late > 0, starts_warm);
  EXPECT_EQ(warm > 0, starts_warm);
}

// Rows that no programme has: 0, beyond the last, and the integer that has no positive twin.
TEST_P(CapsuleOfABackEnd, TakesNoHarmFromAForgedWarmStart) {
  nlohmann::json file = nlohmann::json::parse(contentOf(capsules.at(0)));
  for (const int forged : {0, 99, -99, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()}) {
    nlohmann::json& start = file["capsule"]["warm_start"];
    start = {3, 3, forged, forged};
    const Outcome outcome = tactus({"solve", folder.write("forged.json", file.dump()), "--json"});
    EXPECT_LE(outcome.exit_code, 6) << forged << " " << outcome.err;
    EXPECT_TRUE(outcome.json().contains("torque") || outcome.json().contains("errors")) << forged;
  }
}

INSTANTIATE_TEST_SUITE_P(BackEnds, CapsuleOfABackEnd, ::testing::Values("hqp", "qp/active-set", "null-space"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase_if(name, [](char c) { return c == '-' || c == '/'; });
                           return name;
                         });

TEST(Capsule, IsReproducedBecauseOfItsWarmStart) {
  const MoodyRun moody("/until=21");
  nlohmann::json file = nlohmann::json::parse(contentOf(moody.capsule("capsule-20.json")));
  file["capsule"]["warm_start"] = {19};
  const std::string other = moody.folder.write("other.json", file.dump());
  const Outcome outcome = tactus({"solve", other, "--plugin", kPlugin});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("not reproduced: the run had status failed, this is ok; the torque is off by "));
  EXPECT_THAT(outcome.err, Not(HasSubstr("by the clock")));
  EXPECT_THAT(outcome.err, HasSubstr(" N m at joint "));
}

TEST(Capsule, WhoseWarmStartTheBackEndRefuses) {
  const MoodyRun moody("/until=21");
  nlohmann::json file = nlohmann::json::parse(contentOf(moody.capsule("capsule-20.json")));
  file["capsule"]["warm_start"] = nlohmann::json::array();
  const std::string other = moody.folder.write("other.json", file.dump());
  const Outcome outcome = tactus({"solve", other, "--plugin", kPlugin});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr(other + ": capsule.warm_start: the back end refuses it: "));
}

TEST(Capsule, OfAPluginThatIsNotThere) {
  const MoodyRun moody("/until=21");
  const Outcome outcome = tactus({"solve", moody.capsule("capsule-20.json")});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_THAT(outcome.err, HasSubstr("naughty"));
}

TEST(Capsule, OfARealStackBeyondItsActuators) {
  const TemporaryFolder folder;
  std::string robot = contentOf(data("finger.urdf"));
  for (size_t at; (at = robot.find("effort=\"20\"")) != std::string::npos;) robot.replace(at, 11, "effort=\"0.01\"");
  folder.write("finger.urdf", robot);
  const std::string stack = folder.write("stack.xml", contentOf(data("press.xml")));
  const Outcome run = tactus({"run", stack, "--duration", "0.02", "--out", folder.file("run")});
  const std::vector<std::string> capsules = capsulesIn(folder.file("run"));
  ASSERT_EQ(capsules.size(), 5u) << run.err;
  EXPECT_EQ(run.exit_code, 5) << "no tick was solved";
  EXPECT_THAT(run.err, HasSubstr("warning: 20 of 20 ticks fell back: "));
  EXPECT_THAT(run.err, HasSubstr("warning: first infeasible at t = 0 s: gravity and motion alone ask for more than the "
                                 "actuators have: joint hip by "));
  for (const std::string& name : capsules) {
    const Outcome outcome = tactus({"solve", folder.file("run/" + name), "--json"});
    EXPECT_EQ(outcome.exit_code, 5);
    EXPECT_EQ(outcome.json()["backend"], "null-space");
    EXPECT_EQ(outcome.json()["status"], "infeasible");
    EXPECT_EQ(outcome.json()["capsule"]["reproduced"], true) << outcome.err;
  }
  const Outcome all = tactus({"solve", folder.file("run/" + capsules.front()), "--backend", "any"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_THAT(all.out, HasSubstr("from the recorded (N m)"));
  EXPECT_THAT(all.out, HasSubstr("the same bits"));
  const nlohmann::json list =
      tactus({"solve", folder.file("run/" + capsules.front()), "--backend", "any", "--json"}).json();
  EXPECT_EQ(list[0]["backend"], "null-space");
  EXPECT_EQ(list[0]["capsule"]["reproduced"], true);
  EXPECT_EQ(list[1]["capsule"]["reproduced"], false);

  // Another run into the folder leaves none of the old ones.
  folder.write("finger.urdf", contentOf(data("finger.urdf")));
  EXPECT_EQ(tactus({"run", stack, "--duration", "0.02", "--out", folder.file("run")}).exit_code, 0);
  EXPECT_TRUE(capsulesIn(folder.file("run")).empty());
}

TEST(Capsule, OfARealStackThatHasNoSolutionNamesItsTask) {
  // The finger's motors are too weak to hold it, and its hip falls onto its stop: the row of <joint-limits> forbids that.
  const TemporaryFolder folder;
  const std::string stack =
      changedStack(folder, "<level priority=\"1\">", "<level priority=\"1\"><joint-limits name=\"limits\"/>");
  std::string robot = contentOf(data("finger.urdf"));
  for (size_t at; (at = robot.find("effort=\"20\"")) != std::string::npos;) robot.replace(at, 11, "effort=\"0.01\"");
  robot.replace(robot.find("upper=\"1.5\""), 11, "upper=\"0.25\"");
  folder.write("finger.urdf", robot);
  const Outcome run =
      tactus({"run", stack, "--backend", "qp/nlopt", "--duration", "0.01", "--out", folder.file("run")});
  const std::string why = "task 'limits' (" + stack + ":12:23) and the torque limits of joints hip, knee and tip "
                          "contradict each other; any one of these would do: let 'limits' be accelerated by ";
  EXPECT_THAT(run.err, HasSubstr("warning: first infeasible at t = 0.001 s: " + why));
  const std::vector<std::string> explain{"explain", stack, "--backend", "qp/nlopt", "--at", "0.001"};
  EXPECT_THAT(tactus(explain).out, HasSubstr(why));
  const Outcome outcome = tactus({"solve", folder.file("run/capsule-1.json"), "--json"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_THAT(outcome.err, HasSubstr("qp: reproduced to the bit\n"));
  EXPECT_THAT(outcome.err, HasSubstr(why));
  const nlohmann::json conflict = outcome.json()["conflict"];
  EXPECT_EQ(conflict["groups"].size(), 4u);
  EXPECT_EQ(conflict["groups"][0]["place"], stack + ":12:23");
  EXPECT_EQ(conflict["relaxations"][1]["joint"], "hip");
  EXPECT_EQ(conflict["relaxations"][1]["upper"], false);
  EXPECT_GT(conflict["relaxations"][1]["amount"].get<double>(), 0.1);
}

TEST(Capsule, OfATaskWithoutNumbers) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "<level priority=\"2\">",
                                         "<level priority=\"2\"><naughty.task name=\"imp\" fault=\"nan\"/>");
  for (const std::string back_end : {"null-space", "qp/nlopt"}) {
    const std::string out = folder.file(back_end.substr(0, 2));
    tactus({"run", stack, "--plugin", kPlugin, "--backend", back_end, "--duration", "0.03", "--out", out});
    const Outcome outcome = tactus({"solve", out + "/capsule-21.json", "--json"});
    EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
    EXPECT_EQ(outcome.json()["status"], "failed");
    EXPECT_EQ(outcome.json()["capsule"]["reproduced"], true) << outcome.err;
  }
}

TEST(Capsule, OptionsOfTheCommandLineReplaceRecordedOnes) {
  const MoodyRun moody("/until=21");
  const Outcome outcome =
      tactus({"solve", moody.capsule("capsule-20.json"), "--plugin", kPlugin, "--option", "from=30", "--json"});
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_EQ(outcome.json()["status"], "ok");
  EXPECT_EQ(outcome.json()["capsule"]["difference_Nm"], 0.0) << "only the status differs";
}

TEST(Capsule, ThatIsCutOrWrongIsRefusedWithThePlace) {
  const MoodyRun moody("/until=21");
  const std::string whole = contentOf(moody.capsule("capsule-20.json"));
  const auto error = [&](const std::string& content) {
    const Outcome outcome = tactus({"solve", moody.folder.write("wrong.json", content), "--plugin", kPlugin, "--json"});
    EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(moody.folder.file("wrong.json") + ": "));
    return outcome.json()["errors"][0]["message"].get<std::string>();
  };
  for (const size_t length : {whole.size() - 2, whole.size() / 2, whole.size() / 3, size_t{1}})
    EXPECT_THAT(error(whole.substr(0, length)), HasSubstr("not JSON: parse error"));
  const auto changed = [&](const std::string& pointer, const nlohmann::json& value) {
    nlohmann::json file = nlohmann::json::parse(whole);
    file[nlohmann::json::json_pointer(pointer)] = value;
    return error(file.dump());
  };
  EXPECT_THAT(changed("/capsule", 7), HasSubstr("capsule: expected an object"));
  EXPECT_THAT(changed("/capsule/warm_start", "x"), HasSubstr("capsule.warm_start: expected an array"));
  EXPECT_THAT(changed("/capsule/warm_start", {1.5}), HasSubstr("capsule.warm_start[0]: expected an integer"));
  EXPECT_THAT(changed("/capsule/torque", {1, 2}), HasSubstr("capsule.torque: has 2 numbers, expected 3"));
  EXPECT_THAT(changed("/capsule/status", "tired"), HasSubstr("capsule.status: \"tired\" is none of"));
  EXPECT_THAT(changed("/capsule/capacities", {{1}}), HasSubstr("capsule.capacities: has 1 level, expected 2"));
  EXPECT_THAT(changed("/capsule/capacities/1/0", 0), HasSubstr("capsule.capacities[1][0]: expected an integer from 3"));
  EXPECT_THAT(changed("/capsule/wram_start", 1), HasSubstr("did you mean \"warm_start\"?"));
  EXPECT_THAT(changed("/capsule/options/from", 3), HasSubstr("capsule.options.from: expected a text"));
  nlohmann::json file = nlohmann::json::parse(whole);
  file["capsule"].erase("backend");
  EXPECT_THAT(error(file.dump()), HasSubstr("capsule: \"backend\" is missing"));
}

TEST(Capsule, ABackEndMustBeNamedForAnyOtherFile) {
  const Outcome outcome = tactus({"solve", data("two_levels.json")});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--backend is missing; only a capsule of a run names its own"));
}

TEST(Capsule, AFullDiskIsAWarning) {
  const TemporaryFolder folder;
  const std::string run = folder.file("run");
  Settings full;
  full.largest_file = 13'000;                                      // capsules of 23 joints pass it, the log does not
  const std::string stack = folder.write("stack.xml", R"(<stack format="1" name="still">
  <robot model="lwr_allegro"/>
  <level priority="1"><posture name="rest" joints="arm hand"/></level>
  <level priority="2"><impedance name="place" frame="palm"/></level>
  <controller backend="null-space"/>
  <run duration="0.01"/>
</stack>
)");
  const Outcome outcome =
      tactus({"run", stack, "--plugin", kPlugin, "--backend", "naughty.moody/from=3", "--out", run}, full);
  EXPECT_THAT(capsulesIn(run), ElementsAre());
  EXPECT_THAT(outcome.err, HasSubstr("tactus run: warning: no capsule: " + run + "/capsule-3.json: cannot be written"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("capsule-4.json"))) << "said once";
  EXPECT_THAT(outcome.err, Not(HasSubstr("failed ticks are kept")));
  EXPECT_EQ(nlohmann::json::parse(contentOf(run + "/run.json"))["status"], "done");
}

TEST(SolveCommand, AnyBackEndSideBySide) {
  const Outcome outcome = tactus({"solve", data("two_levels.json"), "--backend", "any", "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json list = outcome.json();
  ASSERT_GE(list.size(), 2u);
  EXPECT_EQ(list[0]["backend"], "hqp");
  for (const nlohmann::json& entry : list) EXPECT_NEAR(entry["torque"][0].get<double>(), 3, 0.05) << entry["backend"];
  // One row against one limit: for the hierarchy the limit stands above, and the row keeps what it then has.
  const Outcome torn = tactus({"solve", data("infeasible.json"), "--backend", "any", "--json"});
  for (const nlohmann::json& entry : torn.json())
    EXPECT_EQ(entry["status"], entry["backend"] == "hqp" ? "ok" : "infeasible") << entry["backend"];
  EXPECT_THAT(tactus({"solve", data("two_levels.json"), "--backend", "any", "--solver", "ipopt"}).err,
              HasSubstr("--backend any takes no options"));
}

}  // namespace
}  // namespace tactus::testing
