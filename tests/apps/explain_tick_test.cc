// `tactus explain STACK --at T` and `tactus explain RUN --at T`, and the x-rays in a run folder.

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const nlohmann::json& task(const nlohmann::json& xray, const std::string& name) {
  for (const nlohmann::json& task : xray["tasks"])
    if (task["name"] == name) return task;
  throw std::runtime_error("no task " + name);
}

/// A stack in which a posture of one joint stands above one of all three.
std::string twoPostures(const TemporaryFolder& folder) {
  return changedStack(folder, "<level priority=\"2\">",
                      "<level priority=\"2\"><posture name=\"stiff\" joints=\"knee\" stiffness=\"3\"/></level>"
                      "<level priority=\"3\">");
}

TEST(ExplainTick, SaysWhoTookWhatFromWhom) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"explain", twoPostures(folder), "--at", "0.01", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json xray = outcome.json();
  EXPECT_NEAR(xray["time"].get<double>(), 0.01, 1e-12);
  EXPECT_EQ(xray["backend"], "null-space");
  EXPECT_EQ(xray["joints"], nlohmann::json({"hip", "knee", "tip"}));
  EXPECT_EQ(xray["rank_tolerance"], 1e-8);
  EXPECT_EQ(xray["levels"][1]["granted"], 1);
  EXPECT_EQ(xray["levels"][2]["wanted"], 3);
  EXPECT_EQ(xray["levels"][2]["granted"], 2);
  EXPECT_EQ(xray["levels"][2]["freedom_left"], 0);
  const nlohmann::json& bow = task(xray, "bow");
  EXPECT_EQ(bow["granted"], 2);
  ASSERT_EQ(bow["lost"].size(), 1u);
  EXPECT_NEAR(bow["lost"][0]["share"].get<double>(), 1, 1e-9);
  EXPECT_NEAR(std::abs(bow["lost"][0]["joints"]["knee"].get<double>()), 1, 1e-9);
  EXPECT_EQ(bow["lost"][0]["takers"].size(), 1u);
  EXPECT_EQ(bow["lost"][0]["takers"][0]["task"], "stiff");
  EXPECT_EQ(bow["place"], folder.file("stack.xml") + ":13:102");
  // The cascade is this back end's: what is left adds up.
  ASSERT_TRUE(bow.contains("torque_left"));
  EXPECT_TRUE(xray["limits"].empty());
}

TEST(ExplainTick, AsATableForPeople) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"explain", twoPostures(folder), "--at", "0.01"});
  EXPECT_THAT(outcome.out, HasSubstr("press with null-space at t = 0.01 s\n"));
  EXPECT_THAT(outcome.out, HasSubstr("freedom left"));
  EXPECT_THAT(outcome.out, HasSubstr("stiff 1"));
  EXPECT_THAT(outcome.out, HasSubstr("'bow' loses 100 % of "));
  EXPECT_THAT(outcome.out, HasSubstr("knee to 'stiff' (100 %)\n"));
}

TEST(ExplainTick, LimitsShow) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "stiffness=\"1\"", "stiffness=\"1e5\"");
  const Outcome outcome = tactus({"explain", stack, "--at", "0"});
  EXPECT_THAT(outcome.out, HasSubstr(" torque limit, "));
  EXPECT_THAT(outcome.out, HasSubstr("the torque was scaled by "));
}

TEST(ExplainTick, ARunFolderRunsAgainAndItsLogIsMet) {
  const TemporaryFolder folder;
  const std::string stack = twoPostures(folder), run = folder.file("run");
  ASSERT_EQ(
      tactus({"run", stack, "--duration", "0.3", "--seed", "4", "--backend", "qp/nlopt", "--out", run}).exit_code, 0);
  const Outcome outcome = tactus({"explain", run, "--at", "0.2", "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("the run repeats: its log is met to the byte"));
  EXPECT_EQ(outcome.json()["log"]["met"], true);
  EXPECT_EQ(outcome.json()["backend"], "qp");
  EXPECT_FALSE(task(outcome.json(), "bow").contains("torque_left")) << "this back end's torque is no cascade's";
  // The end of the run is its last tick.
  EXPECT_NEAR(tactus({"explain", run, "--at", "0.3", "--json"}).json()["time"].get<double>(), 0.299, 1e-9);

  std::string log = contentOf(run + "/log.csv");
  const size_t row = log.find("\n0.1,");
  log.replace(row + 5, 1, "9");
  folder.write("run/log.csv", log);
  const Outcome changed = tactus({"explain", run, "--at", "0.2", "--json"});
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_THAT(changed.err, HasSubstr("the run does not repeat: at t = 0.1 s level/1/rank was 9"));
  EXPECT_EQ(changed.json()["log"]["met"], false);
  EXPECT_EQ(tactus({"explain", run, "--at", "0.05"}).exit_code, 0) << "before the change";
}

TEST(ExplainTick, RunsKeepTwoXraysAndShowThem) {
  const TemporaryFolder folder;
  const std::string run = folder.file("run");
  ASSERT_EQ(tactus({"run", twoPostures(folder), "--duration", "0.6", "--out", run}).exit_code, 0);
  const nlohmann::json kept = nlohmann::json::parse(contentOf(run + "/xray.json"));
  EXPECT_EQ(kept["format"], "tactus-xray/1");
  ASSERT_EQ(kept["xrays"].size(), 2u);
  EXPECT_EQ(kept["xrays"][0]["why"], "largest loss of rank");
  EXPECT_EQ(kept["xrays"][1]["why"], "last tick");
  EXPECT_NEAR(kept["xrays"][1]["time"].get<double>(), 0.599, 1e-9);
  // What the run kept is what explain finds again.
  nlohmann::json again = tactus({"explain", run, "--at", "0.599", "--json"}).json();
  EXPECT_EQ(again["tasks"].dump(), [&] {
    nlohmann::json tasks = kept["xrays"][1]["tasks"];
    for (size_t i = 0; i < tasks.size(); ++i) tasks[i]["place"] = again["tasks"][i]["place"];
    return tasks.dump();
  }());
  const std::string page = contentOf(run + "/report.html");
  EXPECT_THAT(page, HasSubstr("Priority x-ray at t = 0.599 s: last tick"));
  EXPECT_THAT(page, HasSubstr("<td class='task'>  bow</td>"));
  // A folder of an earlier version has none.
  std::filesystem::remove(run + "/xray.json");
  EXPECT_EQ(tactus({"report", run}).exit_code, 0);
  EXPECT_THAT(contentOf(run + "/report.html"), Not(HasSubstr("x-ray")));
}

TEST(ExplainTick, AnEmptyLogAndNoPlaceForTemporaryFilesAreSaid) {
  const TemporaryFolder folder;
  const std::string run = folder.file("run");
  ASSERT_EQ(tactus({"run", data("press.xml"), "--duration", "0.01", "--out", run}).exit_code, 0);
  folder.write("run/log.csv", "");
  const Outcome empty = tactus({"explain", run, "--at", "0"});
  EXPECT_EQ(empty.exit_code, 1);
  EXPECT_THAT(empty.err, HasSubstr("the run does not repeat: the log is empty\n"));
  Settings nowhere;
  nowhere.environment = {"TMPDIR=/nowhere"};
  const Outcome homeless = tactus({"explain", data("press.xml"), "--at", "0"}, nowhere);
  EXPECT_EQ(homeless.exit_code, 6);
  EXPECT_THAT(homeless.err, HasSubstr("tactus: TMPDIR: is no folder for temporary files: "));
}

TEST(ExplainTick, WhatCannotBeAsked) {
  const TemporaryFolder folder;
  const auto error = [](const std::vector<std::string>& arguments) {
    const Outcome outcome = tactus(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(error({"explain", data("press.xml"), "--at", "1.5"}),
              HasSubstr("--at 1.5 is after the end of the run, 1 s"));
  EXPECT_THAT(error({"explain", data("press.xml"), "--at", "-1"}), HasSubstr("'-1' is not a number from 0 to"));
  EXPECT_THAT(error({"explain", "--at", "1"}), HasSubstr("--at needs the stack or the run folder"));
  EXPECT_THAT(error({"explain", TACTUS_SOURCE_DIR}), HasSubstr("is a folder: --at SECONDS says which tick"));
  EXPECT_EQ(tactus({"explain", "/nowhere.xml", "--at", "1"}).exit_code, 6);
  EXPECT_EQ(tactus({"explain", folder.path(), "--at", "1"}).exit_code, 6);
  const std::string run = folder.file("run");
  ASSERT_EQ(tactus({"run", data("press.xml"), "--duration", "0.01", "--out", run}).exit_code, 0);
  EXPECT_THAT(error({"explain", run, "--at", "0", "--seed", "3"}),
              HasSubstr("a run folder says its back end, seed and parameters itself"));
  EXPECT_THAT(error({"explain", run, "--at", "0.02"}), HasSubstr("after the end of the run, 0.01 s"));
}

}  // namespace
}  // namespace tactus::testing
