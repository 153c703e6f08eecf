// A report is made of what a run left, however it ended, and of what people did to the files since.

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

class ReportCommandTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const Outcome outcome = tactus({"run", data("press.xml"), "--out", run(), "--duration", "0.3"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  std::string run() const { return folder.file("run"); }
  Outcome report() const { return tactus({"report", run()}); }
  std::string file(const std::string& name) const { return run() + "/" + name; }
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(file(name), std::ios::binary) << content;
  }
  void change(const std::string& name, const std::string& from, const std::string& to) const {
    std::string content = contentOf(file(name));
    const size_t at = content.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(name, content.replace(at, from.size(), to));
  }
  /// What run.json holds from the beginning of a run on.
  void cutOff() const {
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(contentOf(file("run.json")));
    nlohmann::ordered_json start;
    for (const char* key : {"format", "stack", "file", "backend", "backend_options", "seed"}) start[key] = json[key];
    start["status"] = "running";
    write("run.json", start.dump(2));
  }

  TemporaryFolder folder;
};

TEST_F(ReportCommandTest, OfARunThatWasCutOff) {
  cutOff();
  fs::remove(file("report.html"));
  EXPECT_EQ(report().exit_code, 0);
  const std::string html = contentOf(file("report.html"));
  EXPECT_THAT(html, HasSubstr("This run was cut off, or is still going"));
  EXPECT_THAT(html, HasSubstr("Error of task bow"));
}

TEST_F(ReportCommandTest, OfARunThatWasCutOffBeforeItsFirstRow) {
  cutOff();
  fs::remove(file("log.csv"));
  fs::remove(file("touched_points.csv"));
  const Outcome outcome = report();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(contentOf(file("report.html")), HasSubstr("No tick was logged."));
  EXPECT_THAT(contentOf(file("touched_points.svg")), HasSubstr("Nothing was touched."));
}

TEST_F(ReportCommandTest, AFinishedRunNeedsItsLog) {
  fs::remove(file("log.csv"));
  const Outcome outcome = report();
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("log.csv: cannot be opened"));
}

TEST_F(ReportCommandTest, MalformedFilesAreLocated) {
  const std::string good = contentOf(file("run.json"));
  const auto says = [&](const std::string& from, const std::string& to) {
    write("run.json", good);
    change("run.json", from, to);
    const Outcome outcome = report();
    EXPECT_EQ(outcome.exit_code, 6) << from;
    return outcome.err;
  };
  EXPECT_THAT(says("\"stack\": ", "\"stack\" "), HasSubstr("run.json: line 3, column 17: is not JSON"));
  EXPECT_THAT(says("\"stack\": \"press\"", "\"stack\": 3"), HasSubstr("run.json: at '/stack': expected a text, found number"));
  EXPECT_THAT(says("\"stack\": \"press\",", ""), HasSubstr("run.json: at '/stack': expected a text, found nothing"));
  EXPECT_THAT(says("\"metrics\": {", "\"metrics\": 7, \"x\": {"),
              HasSubstr("run.json: at '/metrics': expected an object, found number"));
  EXPECT_THAT(says("\"seed\": 1", "\"seed\": 1e999"), HasSubstr("run.json: holds a number that cannot be represented"));
  EXPECT_THAT(says("\"tactus-run/1\"", "[]"), HasSubstr("run.json: at '/format': expected a text, found array"));

  write("run.json", good);
  const std::string log = contentOf(file("log.csv"));
  change("log.csv", "time,", "tide,");
  EXPECT_THAT(report().err, HasSubstr("log.csv: has no column 'time'"));
  write("log.csv", log);
  change("log.csv", "\n0,", "\nx,");
  EXPECT_THAT(report().err, HasSubstr("log.csv: row 1, column time: 'x' is not a number"));
  write("log.csv", log);
  change("touched_points.csv", "x,y,z", "x,y,w");
  EXPECT_THAT(report().err, HasSubstr("touched_points.csv: has no column 'z'"));
}

TEST_F(ReportCommandTest, ValuesBeyondEveryAxisAreLeftOut) {
  change("log.csv", "\n0.1,", "\n1e300,");
  change("log.csv", "\n0.2,", "\n-inf,");
  const Outcome outcome = report();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* picture : {"contacts.svg", "touched_points.svg"})
    EXPECT_THAT(contentOf(file(picture)), Not(HasSubstr("inf"))) << picture;
}

TEST_F(ReportCommandTest, WhatTheReplayNeedsIsLocatedToo) {
  const auto says = [&](const std::string& name, const std::string& from, const std::string& to) {
    const std::string good = contentOf(file(name));
    change(name, from, to);
    const Outcome outcome = report();
    EXPECT_EQ(outcome.exit_code, 6) << name << ": " << from;
    write(name, good);
    return outcome.err;
  };
  EXPECT_THAT(says("scene.json", "tactus-scene/1", "tactus-scene/0"), HasSubstr("scene.json: is not of the format tactus-scene/1"));
  EXPECT_THAT(says("scene.json", "\"radius\":", "\"girth\":"), HasSubstr("/capsules/0/radius': expected a number, found nothing"));
  EXPECT_THAT(says("scene.json", "\"triangles\":[", "\"triangles\":[-1,0,0,"),
              HasSubstr("/triangles/0': expected the index of a vertex"));
  EXPECT_THAT(says("replay.csv", "time,", "tide,"), HasSubstr("replay.csv: has no column 'time'"));
  EXPECT_THAT(says("replay_contacts.csv", "link,on", "link,at"), HasSubstr("replay_contacts.csv: has no column"));
}

/// The page of an old run, of which nothing was kept to replay.
TEST_F(ReportCommandTest, ARunWithoutAReplayHasItsTables) {
  for (const char* name : {"scene.json", "replay.csv", "replay_contacts.csv", "timing.csv"}) fs::remove(file(name));
  EXPECT_EQ(report().exit_code, 0);
  EXPECT_THAT(contentOf(file("report.html")), HasSubstr("\"scene\":null"));
}

TEST_F(ReportCommandTest, NoNameEndsTheScript) {
  change("scene.json", "\"robot\":\"", "\"robot\":\"</script><b>");
  EXPECT_EQ(report().exit_code, 0);
  EXPECT_THAT(contentOf(file("report.html")), Not(HasSubstr("</script><b>")));
}

TEST_F(ReportCommandTest, TwoRunsBesideEachOther) {
  const Outcome outcome = tactus({"report", run(), "--beside", run()});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(contentOf(file("beside-run.html")), HasSubstr("run beside run"));
  EXPECT_EQ(tactus({"report", run(), "--beside", folder.file("none")}).exit_code, 6);
}

TEST_F(ReportCommandTest, PicturesSayWhatTheyNeed) {
  Settings settings;
  settings.environment = {"PATH=/nonexistent"};
  const Outcome outcome = tactus({"report", run(), "--png", folder.file("scene.png")}, settings);
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("pictures need Chromium, and there is none on the path; on Debian: apt-get install chromium"));
  EXPECT_EQ(tactus({"report", run(), "--png", "x.png", "--camera", "moon"}).exit_code, 2);
}

/// Whatever stands in the files, the end is a report or a message about a file.
TEST_F(ReportCommandTest, NoFileBringsItDown) {
  std::mt19937 random(7);
  const std::vector<std::string> pieces{"\"", "{", "}", "[", "]", ":", ",", "null", "-1e308", "1e999", "nan", "\n", "0"};
  for (const char* name : {"run.json", "log.csv", "touched_points.csv", "scene.json", "replay.csv", "replay_contacts.csv",
                           "timing.csv"}) {
    const std::string good = contentOf(file(name));
    for (int i = 0; i < 40; ++i) {
      std::string bad = good;
      for (int changes = 0; changes <= i % 4; ++changes) {
        const size_t at = random() % bad.size();
        if (random() % 3 == 0) {
          bad.erase(at, random() % 40);
        } else {
          bad.insert(at, pieces[random() % pieces.size()]);
        }
      }
      write(name, bad);
      const Outcome outcome = report();
      EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 6) << name << ":\n" << bad.substr(0, 2000) << outcome.err;
      EXPECT_THAT(outcome.err, Not(HasSubstr("internal")));
    }
    write(name, good);
  }
}

}  // namespace
}  // namespace tactus::testing
