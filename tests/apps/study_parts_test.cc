// The order of trials, what is told on the way, and the picture of boxes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <cmath>
#include <set>

#include "apps/tactus/plot.h"
#include "apps/tactus/study_plan.h"
#include "apps/tactus/study_progress.h"
#include "framework/runtime/file_error.h"

namespace tactus::app {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

StudyPlan somePlan() {
  StudyPlan plan;
  plan.name = "some";
  plan.factors = {{"press", {"0.3", "0.5", "0.8"}}, {"speed", {"1"}}, {"backend", {"null-space", "hqp"}}};
  plan.first_seed = 4;
  plan.seeds = 5;
  plan.metrics = {"contact_force_mean_N"};
  plan.comparisons = {{"contact_force_mean_N", "backend", "hqp"}};
  plan.inputs = {{"stack.xml", "a"}, {"robot.urdf", "b"}};
  return plan;
}

TEST(StudyPlan, EveryConditionMeetsEverySeedOnce) {
  const StudyPlan plan = somePlan();
  ASSERT_EQ(plan.trials(), 30);
  std::set<std::pair<std::vector<size_t>, std::uint64_t>> seen;
  for (long number = 1; number <= plan.trials(); ++number) {
    const Trial trial = plan.trial(number);
    EXPECT_EQ(trial.number, number);
    EXPECT_EQ(plan.conditionOf(trial.levels), plan.conditionOfTrial(number));
    EXPECT_TRUE(trial.seed >= 4 && trial.seed < 9);
    EXPECT_TRUE(seen.insert({trial.levels, trial.seed}).second) << number;
  }
  EXPECT_EQ(plan.trial(1).seed, 4u);
  EXPECT_EQ(plan.trial(6).levels, (std::vector<size_t>{0, 0, 1}));  // seeds run fastest, then the back ends
  EXPECT_EQ(plan.label(plan.trial(30).levels), "press=0.8, hqp");
}

TEST(StudyPlan, ReadsBackFromItsFile) {
  const StudyPlan plan = somePlan(), again = planFromJson("study.json", toJson(plan));
  EXPECT_EQ(toJson(again), toJson(plan));
  EXPECT_TRUE(differencesOf(plan, again).empty());
  auto broken = toJson(plan);
  broken["seeds"]["count"] = 0;
  EXPECT_THROW(planFromJson("study.json", broken), runtime::FileError);
  broken = toJson(plan);
  broken["factors"][0]["levels"] = nlohmann::ordered_json::array();
  EXPECT_THROW(planFromJson("study.json", broken), runtime::FileError);
}

TEST(StudyPlan, SaysWhatHasChanged) {
  StudyPlan now = somePlan();
  now.inputs = {{"stack.xml", "other"}, {"plugin 'qp'", "c"}};
  now.seeds = 6;
  EXPECT_THAT(differencesOf(somePlan(), now),
              ElementsAre("plugin 'qp' is new", "stack.xml has changed", "robot.urdf is gone", "its seeds is another"));
}

TEST(StudyProgress, TellsTimeLeftFromThisRunAlone) {
  EXPECT_EQ(progressText({60, 12, 0, 0, 2}, 5), "12 of 60 trials, 2 running");
  EXPECT_EQ(progressText({60, 20, 1, 8, 2}, 49), "20 of 60 trials, 1 failed, 2 running, 4:05 left");
  EXPECT_EQ(progressText({5000, 1, 0, 1, 2}, 1), "1 of 5000 trials, 2 running, 1:23:19 left");
  EXPECT_EQ(progressText({60, 60, 0, 48, 0}, 49), "60 of 60 trials");
}

TEST(GroupPlot, ShowsEveryValueOfEveryGroup) {
  const GroupPlot plot{
      "force", "N", {{"a < b", {1, 2, 3, 4, 100}, 2, 3, 4}, {"none", {}, NAN, NAN, NAN}, {"one", {5}, 5, 5, 5}}};
  const std::string svg = svgDocument(900, heightOf(plot), draw(plot, {0, 0, 900, heightOf(plot)}));
  tinyxml2::XMLDocument document;
  EXPECT_EQ(document.Parse(svg.c_str()), tinyxml2::XML_SUCCESS) << document.ErrorStr();
  for (const char* text : {"a &lt; b", "none", "one", "force"}) EXPECT_THAT(svg, HasSubstr(text));
  size_t points = 0;
  for (size_t at = svg.find("h0"); at != std::string::npos; at = svg.find("h0", at + 1)) ++points;
  EXPECT_EQ(points, 6u);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace tactus::app
