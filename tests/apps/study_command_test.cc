// Studies of a small stack, a finger on a floor whose height is drawn from the seed.
//
// Strategy: one study is run whole and undisturbed; whatever happens to another of the same kind (kill, interrupt,
// shards, more processes), its tables must have the same bytes in the end.

#include <gmock/gmock.h>
#include <signal.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <thread>

#include "framework/runtime/csv_table.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kPlugin = std::string(TEST_PLUGINS) + "/naughty.so";
const std::vector<std::string> kTables{"trials.csv",      "trials.json",      "summary.csv", "summary.json",
                                       "comparisons.csv", "comparisons.json", "index.html",
                                       "contact_force_mean_N.svg"};

/// A folder with the stack and a study of it.
struct Case {
  TemporaryFolder folder;
  std::string file;

  explicit Case(const std::string& inside, const std::string& attributes = "") {
    changedStack(folder, "name=\"floor\"", "name=\"floor\" jitter=\"0 0 0.01\"");
    write(inside, attributes);
  }
  void write(const std::string& inside, const std::string& attributes = "") {
    file = folder.write("study.xml", "<study format=\"1\" name=\"presses\" stack=\"stack.xml\" " + attributes + ">\n" +
                                         inside + "\n</study>\n");
  }
  Outcome run(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"study", file, "--out", folder.file(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return tactus(arguments);
  }
  std::string content(const std::string& name) const { return contentOf(folder.file(name)); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(content(name)); }
};

const std::string kInside = R"(  <factor parameter="press" values="0.3 0.6"/>
  <seeds from="3" count="4"/>
  <backends names="null-space qp/active-set"/>
  <metric name="contact_force_mean_N"/><metric name="contact_force_peak_N"/>
  <compare metric="contact_force_peak_N" by="press" baseline="0.3"/>
  <compare metric="contact_force_peak_N" baseline="null-space"/>
  <compare metric="contact_force_peak_N" baseline="null-space" over="press"/>)";
const std::string kShort = "duration=\"0.6\"";

void expectSameTables(const Case& one, const std::string& here, const std::string& there) {
  for (const std::string& table : kTables) {
    EXPECT_FALSE(one.content(here + "/" + table).empty()) << table;
    EXPECT_EQ(one.content(here + "/" + table), one.content(there + "/" + table)) << table;
  }
}

long finishedTrials(const std::string& folder) {
  long count = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    count += entry.path().filename().string().starts_with("trial-");
  return count;
}

bool waitForTrials(const std::string& folder, long count) {
  for (int i = 0; i < 3000 && finishedTrials(folder) < count; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return finishedTrials(folder) >= count;
}

std::vector<std::string> filesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  return names;
}

/// When each finished trial's run was written: another time tells that it ran again.
std::map<std::string, fs::file_time_type> timesOf(const std::string& folder) {
  std::map<std::string, fs::file_time_type> times;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().starts_with("trial-"))
      times[entry.path().filename()] = fs::last_write_time(entry.path() / "run.json");
  return times;
}

TEST(StudyCommand, TablesSayWhatTheRunsSaid) {
  const Case study(kInside, kShort);
  const Outcome outcome = study.run("out", {"--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, Not(HasSubstr("\r"))) << "progress is for terminals";
  const nlohmann::json trials = study.json("out/trials.json");
  ASSERT_EQ(trials.size(), 16u);
  std::map<std::string, std::vector<double>> forces;
  for (const auto& trial : trials) {
    const nlohmann::json run = study.json("out/trial-" + trial["trial"].dump() + "/run.json");
    EXPECT_EQ(run["seed"], trial["seed"]);
    EXPECT_EQ(run["duration_s"], 0.6);
    EXPECT_EQ(trial["backend"] == "null-space", run["backend"] == "null-space");
    EXPECT_EQ(run["wanted_force_N"].get<double>(), std::stod(trial["press"].get<std::string>()));
    EXPECT_EQ(trial["contact_force_peak_N"], run["metrics"]["contact_force_peak_N"]);
    EXPECT_EQ(trial["status"], "done");
    const std::string condition = trial["press"].get<std::string>() + trial["backend"].get<std::string>();
    forces[condition].push_back(trial["contact_force_peak_N"]);
  }
  const nlohmann::json summary = study.json("out/summary.json");
  ASSERT_EQ(summary.size(), 8u);
  for (const auto& row : summary) {
    if (row["metric"] != "contact_force_peak_N") continue;
    const std::vector<double>& values = forces[row["press"].get<std::string>() + row["backend"].get<std::string>()];
    ASSERT_EQ(values.size(), 4u);
    const double mean = (values[0] + values[1] + values[2] + values[3]) / 4;
    EXPECT_NEAR(row["mean"].get<double>(), mean, 1e-12);
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    EXPECT_NEAR(row["sd"].get<double>(), std::sqrt(squares / 3), 1e-12);
    EXPECT_GT(row["sd"].get<double>(), 0);
    EXPECT_EQ(row["max"].get<double>(), *std::max_element(values.begin(), values.end()));
  }
  const nlohmann::json comparisons = study.json("out/comparisons.json");
  ASSERT_EQ(comparisons.size(), 5u);
  const nlohmann::json& first = comparisons.front();
  EXPECT_EQ(first["level"], "0.6");
  EXPECT_EQ(first["at_backend"], "null-space");
  EXPECT_EQ(first["pairs"], 4);
  double difference = 0;
  for (int i = 0; i < 4; ++i) difference += forces["0.6null-space"][i] - forces["0.3null-space"][i];
  EXPECT_NEAR(first["mean_difference"].get<double>(), difference / 4, 1e-12);
  EXPECT_NEAR(first["t"].get<double>(), first["d_z"].get<double>() * 2, 1e-9);
  EXPECT_EQ(first["wilcoxon_p"], 0.125) << "four differences of one sign: 2 of 16 sums";
  const double over_both = comparisons.back()["wilcoxon_p"];
  EXPECT_EQ(first["wilcoxon_p_holm"], over_both < 0.125 ? std::max(5 * over_both, 4 * 0.125) : 5 * 0.125) << "of five";
  EXPECT_GE(first["t_p_holm"].get<double>(), first["t_p"].get<double>());
  // Over both presses: the pairs of two comparisons in one.
  const nlohmann::json& pooled = comparisons.back();
  EXPECT_TRUE(pooled["at_press"].is_null());
  EXPECT_EQ(pooled["pairs"], 8);
  EXPECT_EQ(pooled["left_out"], 0);
  EXPECT_NEAR(pooled["mean_difference"].get<double>(),
              (comparisons[2]["mean_difference"].get<double>() + comparisons[3]["mean_difference"].get<double>()) / 2, 1e-12);
  // The CSV holds the same numbers.
  const runtime::CsvTable table = runtime::CsvTable::read(study.folder.file("out/comparisons.csv"));
  EXPECT_EQ(table.numbers(table.column("mean_difference")).front(), first["mean_difference"].get<double>());
  EXPECT_EQ(outcome.json()["comparisons"], comparisons);
}

TEST(StudyCommand, TablesDependNeitherOnProcessesNorOnShards) {
  const Case study(kInside, kShort);
  ASSERT_EQ(study.run("one", {"--jobs", "1"}).exit_code, 0);
  ASSERT_EQ(study.run("many", {"--jobs", "7"}).exit_code, 0);
  expectSameTables(study, "one", "many");
  // Shards in one folder, and in a folder each.
  for (const char* shard : {"3/3", "1/3", "2/3"}) {
    const Outcome outcome = study.run("shared", {"--shard", shard});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_FALSE(fs::exists(study.folder.file("shared/trials.csv"))) << "no shard knows all trials";
    ASSERT_EQ(study.run(std::string("own") + shard[0], {"--shard", shard}).exit_code, 0);
  }
  ASSERT_EQ(tactus({"study", "merge", study.folder.file("shared")}).exit_code, 0);
  expectSameTables(study, "one", "shared");
  const Outcome merged = tactus({"study", "merge", study.folder.file("own1"), study.folder.file("own2"),
                                 study.folder.file("own3"), "--out", study.folder.file("merged")});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  expectSameTables(study, "one", "merged");
}

TEST(StudyCommand, MergeTellsWhatIsMissingAndWhatContradicts) {
  const Case study(kInside, kShort);
  ASSERT_EQ(study.run("a", {"--shard", "1/2"}).exit_code, 0);
  const Outcome partly = tactus({"study", "merge", study.folder.file("a")});
  EXPECT_EQ(partly.exit_code, 1);
  EXPECT_THAT(partly.err, HasSubstr("8 of 16 trials have not run"));
  EXPECT_EQ(study.json("a/summary.json")[0]["missing"], 2);
  EXPECT_EQ(study.json("a/summary.json")[0]["n"], 2);

  fs::copy(study.folder.file("a"), study.folder.file("b"), fs::copy_options::recursive);
  nlohmann::json run = study.json("b/trial-3/run.json");
  run["metrics"]["contact_force_mean_N"] = 7;
  study.folder.write("b/trial-3/run.json", run.dump());
  const Outcome other = tactus({"study", "merge", study.folder.file("a"), study.folder.file("b")});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("trial 3 has come out otherwise in " + study.folder.file("b")));

  const Case another(kInside, "duration=\"0.5\"");
  ASSERT_EQ(another.run("c", {"--shard", "2/2"}).exit_code, 0);
  const Outcome foreign = tactus({"study", "merge", study.folder.file("a"), another.folder.file("c")});
  EXPECT_EQ(foreign.exit_code, 6);
  EXPECT_THAT(foreign.err, HasSubstr("study.xml has changed"));
}

/// Killed again and again wherever it is, each time after one trial more at least.
TEST(StudyCommand, AKillLosesAndRepeatsNothing) {
  const Case study(kInside, kShort);
  ASSERT_EQ(study.run("whole").exit_code, 0);
  std::map<std::string, fs::file_time_type> before;
  int kills = 0;
  for (; kills < 20 && finishedTrials(study.folder.file("killed")) < 14; ++kills) {
    const long had = finishedTrials(study.folder.file("killed"));
    RunningProgram program({"study", study.file, "--out", study.folder.file("killed"), "--jobs", "2"});
    ASSERT_TRUE(waitForTrials(study.folder.file("killed"), had + 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(7 * kills));
    program.send(SIGKILL);
    const int code = program.wait().exit_code;
    if (code == 0) break;                                          // on a busy machine the rest was done before the kill came
    EXPECT_EQ(code, 128 + SIGKILL);
    for (const auto& [trial, time] : before) EXPECT_EQ(timesOf(study.folder.file("killed")).at(trial), time) << trial;
    before = timesOf(study.folder.file("killed"));
  }
  EXPECT_GE(kills, 2);
  const Outcome rest = study.run("killed");
  ASSERT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr(" of 16 trials are finished already\n"));
  for (const auto& [trial, time] : before) EXPECT_EQ(timesOf(study.folder.file("killed")).at(trial), time) << trial;
  expectSameTables(study, "whole", "killed");
}

TEST(StudyCommand, CtrlCKeepsWhatIsFinished) {
  const Case study(kInside);
  RunningProgram program({"study", study.file, "--out", study.folder.file("out"), "--jobs", "1"});
  ASSERT_TRUE(waitForTrials(study.folder.file("out"), 2));
  program.send(SIGINT);
  const Outcome outcome = program.wait();
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_THAT(outcome.err, HasSubstr("interrupted; finished trials are kept, the same command goes on"));
  EXPECT_GE(finishedTrials(study.folder.file("out")), 2);
  EXPECT_LT(finishedTrials(study.folder.file("out")), 16);
  EXPECT_EQ(filesIn(study.folder.file("out/.shard-1-of-1")), std::vector<std::string>{"lock"}) << "trials that were under way are gone";
}

TEST(StudyCommand, OneShardIsForOneProcess) {
  const Case study(kInside);
  RunningProgram program({"study", study.file, "--out", study.folder.file("out"), "--jobs", "1"});
  ASSERT_TRUE(waitForTrials(study.folder.file("out"), 1));
  const Outcome second = study.run("out");
  EXPECT_EQ(second.exit_code, 6);
  EXPECT_THAT(second.err, HasSubstr("another process runs shard 1/1 of this study here"));
  program.send(SIGTERM);
  EXPECT_EQ(program.wait().exit_code, 130);
}

TEST(StudyCommand, OtherInputsAreRefusedByName) {
  Case study(kInside, kShort);
  ASSERT_EQ(study.run("out", {"--shard", "1/8"}).exit_code, 0);
  const std::string stack = study.content("stack.xml");
  study.folder.write("stack.xml", stack + "<!-- -->");
  Outcome outcome = study.run("out");
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("holds trials of another study than this one: stack.xml has changed. Give "));
  study.folder.write("stack.xml", stack);
  study.write(kInside, "duration=\"0.7\"");
  outcome = study.run("out");
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("study.xml has changed"));
  study.write(kInside, kShort);
  outcome = study.run("out", {"--plugin", kPlugin});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("plugin 'naughty' is new"));
  EXPECT_EQ(study.run("out").exit_code, 0);
  study.folder.write("other/notes.txt", "");
  fs::create_directory(study.folder.file("other"));
  study.folder.write("other/notes.txt", "mine");
  EXPECT_THAT(study.run("other").err, HasSubstr("holds files that are not of a study"));
}

TEST(StudyCommand, FailedTrialsAreToldAndCountNowhere) {
  Case study(R"(<factor parameter="fault" values="throw abort nan"/><factor parameter="from" values="0.02 9"/>
                <seeds count="2"/><metric name="contact_force_mean_N"/>
                <compare metric="contact_force_mean_N" by="from" baseline="9"/>)", kShort);
  std::string stack = study.content("stack.xml");
  const auto insert = [&](const std::string& before, const std::string& text) {
    stack.insert(stack.find(before), text);
  };
  insert("<robot", "<parameter name=\"fault\" value=\"nan\"/><parameter name=\"from\" value=\"9\"/>");
  insert("<posture", "<naughty.task name=\"imp\" fault=\"${fault}\" from=\"${from}\"/>");
  study.folder.write("stack.xml", stack);
  const Outcome outcome = study.run("out", {"--plugin", kPlugin, "--jobs", "3"});
  EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("12 of 12 trials, 6 failed"));
  EXPECT_THAT(outcome.err, HasSubstr("6 of 12 trials failed; no figure counts them"));
  EXPECT_THAT(outcome.err, HasSubstr("trial 1 (fault=throw, from=0.02, seed 1): tick-error: task 'imp'"));
  EXPECT_THAT(outcome.err, HasSubstr("trial 5 (fault=abort, from=0.02, seed 1): crashed: ended by signal 6"));
  EXPECT_THAT(contentOf(study.folder.file("out/index.html")), HasSubstr("ended by signal 6"));
  for (const auto& row : study.json("out/summary.json")) {
    EXPECT_EQ(row["failed"], row["from"] == "9" ? 0 : 2);
    EXPECT_EQ(row["n"], row["from"] == "9" ? 2 : 0);
    EXPECT_EQ(row["mean"].is_number(), row["from"] == "9");
  }
  for (const auto& row : study.json("out/trials.json"))
    EXPECT_EQ(row["contact_force_mean_N"].is_number(), row["status"] == "done" && row["exit_code"] == 0) << row;
  for (const auto& row : study.json("out/comparisons.json")) {
    EXPECT_EQ(row["pairs"], 0);
    EXPECT_EQ(row["left_out"], 2);
    EXPECT_TRUE(row["t_p"].is_null());
  }
  // Failed trials are finished trials, unless they are to run again.
  const auto before = timesOf(study.folder.file("out"));
  EXPECT_EQ(study.run("out", {"--plugin", kPlugin}).exit_code, 4);
  EXPECT_EQ(timesOf(study.folder.file("out")), before);
  EXPECT_EQ(study.run("out", {"--plugin", kPlugin, "--retry"}).exit_code, 4);
  const auto after = timesOf(study.folder.file("out"));
  for (const auto& [trial, time] : before) {
    const long number = std::stol(trial.substr(6));
    EXPECT_EQ(after.at(trial) == time, (number - 1) / 2 % 2 == 1) << trial;
  }
}

TEST(StudyCommand, KeepsFiguresAlone) {
  const Case study("<seeds count=\"2\"/>", kShort + " keep=\"metrics\"");
  ASSERT_EQ(study.run("out").exit_code, 0);
  const std::vector<std::string> files = filesIn(study.folder.file("out/trial-1"));
  EXPECT_THAT(files, ::testing::IsSupersetOf({"run.json", "trial.json"}));
  EXPECT_THAT(files, Not(::testing::Contains("log.csv")));
  EXPECT_THAT(contentOf(study.folder.file("out/summary.csv")), HasSubstr("contact_switches_per_s,null-space,2,0,0,0,"))
      << "without <metric> all figures are reported";
}

TEST(StudyCommand, SeedsWithoutEffectAreTold) {
  const Case study("<seeds count=\"3\"/>", kShort);
  study.folder.write("stack.xml", contentOf(data("press.xml")));
  const Outcome outcome = study.run("out");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("the seed changes nothing in 1 of 1 conditions"));
}

TEST(StudyCommand, ADiskThatIsFullEndsIt) {
  const Case study("<seeds count=\"2\"/>", kShort);
  Settings settings;
  settings.largest_file = 3000;
  const Outcome outcome = tactus({"study", study.file, "--out", study.folder.file("out"), "--jobs", "1"}, settings);
  EXPECT_EQ(outcome.exit_code, 6) << outcome.err;
  EXPECT_EQ(finishedTrials(study.folder.file("out")), 0) << "what could not be written is no trial";
}

TEST(StudyCommand, DryRunListsTrialsAndTouchesNothing) {
  const Case study(kInside);
  const Outcome outcome = study.run("out", {"--dry-run", "--shard", "2/8"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out, "trial  press     backend  seed\n"
                         "2        0.3  null-space     4\n"
                         "10       0.6  null-space     4\n");
  EXPECT_FALSE(fs::exists(study.folder.file("out")));
}

struct Wrong {
  std::string inside;
  std::string message;
};

/// What a study has wrong is told at its place, by check and study alike, before anything runs.
TEST(StudyCommand, ErrorsStandAtTheirPlace) {
  const std::vector<Wrong> wrongs{
      {"<factor parameter=\"pres\" values=\"1\"/>", ":2:20: error[E036]: the stack '"},
      {"<factor parameter=\"press\" values=\"\"/>", ":2:35: error[E014]: attribute 'values': expected one"},
      {"<factor parameter=\"press\" values=\"1 2 1\"/>", ":2:35: error[E020]: '1' stands here twice"},
      {"<factor parameter=\"seed\" values=\"1\"/>", ":2:20: error[E020]: 'seed' names another column"},
      {"<factor parameter=\"press\" values=\"1\"/><factor parameter=\"press\" values=\"2\"/>",
       ":2:58: error[E020]: the study has a factor 'press' already"},
      {"<factor parameter=\"press\" values=\"much\"/>", "error[E014]"},
      {"<seeds count=\"0\"/>", ":2:15: error[E014]"},
      {"<seeds from=\"2147483647\" count=\"2\"/>", "the last seed would be beyond 2147483647"},
      {"<seeds count=\"1000001\"/>", "the study has 1000001 trials, and may have 1000000"},
      {"<backends names=\"null-space qpp\"/>", "error[E037]: there is no back end 'qpp'"},
      {"<backends names=\"qp/fast\"/>", "error[E037]: back end 'qp' has no variant 'fast'"},
      {"<metric name=\"a\"/><metric name=\"a\"/>", ":2:33: error[E020]: the study reports 'a' already"},
      {"<metric name=\"a\"/><compare metric=\"b\" baseline=\"qp\"/>", "the study reports no metric 'b'; there is a"},
      {"<compare metric=\"a\" baseline=\"qp\"/>", "error[E014]: the study has no factor 'backend'; there is none"},
      {"<backends names=\"qp hqp\"/><compare metric=\"a\" baseline=\"hq\"/>",
       "'backend' has no level 'hq'; there is qp, hqp"},
      {"<backends names=\"qp hqp\"/><compare metric=\"a\" baseline=\"qp\" over=\"backend\"/>",
       "there is no other factor 'backend'; there is none"},
      {"<factors/>", "error[E011]"},
      {"<robot model=\"a\"/>", "error[E015]"},
      {"<metric name=\"${press}\"/>", "error[E036]"}};
  for (const Wrong& wrong : wrongs) {
    const Case study(wrong.inside);
    const Outcome checked = tactus({"check", study.file}), run = study.run("out");
    EXPECT_EQ(checked.exit_code, 3) << wrong.inside;
    EXPECT_THAT(checked.err, HasSubstr(wrong.message)) << wrong.inside;
    EXPECT_EQ(run.exit_code, 3) << wrong.inside;
    EXPECT_FALSE(fs::exists(study.folder.file("out"))) << wrong.inside;
  }
  const Case unknown("<metric name=\"contact_force_men_N\"/>");
  const Outcome warned = tactus({"check", unknown.file});
  EXPECT_EQ(warned.exit_code, 0);
  EXPECT_THAT(warned.err, HasSubstr("warning[W013]: no trial of this study has a figure 'contact_force_men_N'"));
  EXPECT_THAT(warned.err, HasSubstr("did you mean 'contact_force_mean_N'?"));
  const TemporaryFolder folder;
  const std::string file = folder.write("s.xml", "<study format=\"2\" stack=\"no.xml\"/>");
  EXPECT_THAT(tactus({"study", file}).err, HasSubstr("error[E019]: format '2' is not one that this version reads"));
  EXPECT_EQ(tactus({"study", data("press.xml")}).exit_code, 3);
  EXPECT_EQ(tactus({"study"}).exit_code, 2);
  EXPECT_EQ(tactus({"study", file, "--shard", "3/2"}).exit_code, 2);
  EXPECT_EQ(tactus({"study", "merge", folder.path()}).exit_code, 6);
}

}  // namespace
}  // namespace tactus::testing
