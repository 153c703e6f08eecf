#include <gmock/gmock.h>

#include "framework/runtime/file_error.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::HasSubstr;

TEST(CompareCommand, SameStatesAndClosedLoop) {
  const Outcome outcome =
      tactus({"compare", data("press.xml"), "--backends", "null-space,null-space/successive,qp/ipopt", "--duration",
              "0.4", "--every", "10", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["reference"], "null-space");
  EXPECT_EQ(json["sampled_ticks"], 40);
  ASSERT_EQ(json["backends"].size(), 3u);
  for (const nlohmann::json& back_end : json["backends"]) {
    const nlohmann::json same = back_end["same_states"], closed = back_end["closed_loop"];
    EXPECT_EQ(same["compared"], 40);
    EXPECT_EQ(same["unsolved"], 0);
    EXPECT_GT(same["solve_us"]["median"].get<double>(), 0);
    EXPECT_LT(same["violation_max"].get<double>(), 1e-6);
    EXPECT_EQ(closed["fallbacks"], 0);
    EXPECT_EQ(closed["duration_s"], 0.4);
    EXPECT_GT(closed["tick_us"]["p99"].get<double>(), 0);
    EXPECT_TRUE(closed["metrics"].contains("contact_force_mean_N"));
    EXPECT_GT(closed["task_errors"]["bow"].get<double>(), 0);
  }
  // The reference differs from itself in nothing; with two levels the two cascades are one.
  EXPECT_EQ(json["backends"][0]["same_states"]["torque_difference"]["max"], 0.0);
  EXPECT_LT(json["backends"][1]["same_states"]["torque_difference_relative"]["max"].get<double>(), 1e-9);
  EXPECT_GT(json["backends"][2]["same_states"]["torque_difference"]["max"].get<double>(), 0);
  EXPECT_TRUE(json["backends"][0]["closed_loop"]["kkt_max"].is_null());
  EXPECT_TRUE(json["backends"][2]["closed_loop"]["kkt_max"]["primal"].is_number());
}

TEST(CompareCommand, SaysWhereBackEndsDifferAndWhy) {
  // So stiff that the torque is limited: the cascade scales it, the programme holds some joints at their limits.
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "stiffness=\"1\"", "stiffness=\"500\"");
  const std::vector<std::string> arguments{"compare", stack, "--backends", "null-space,qp/nlopt", "--duration", "0.1",
                                           "--every", "10"};
  std::vector<std::string> with_json = arguments;
  with_json.push_back("--json");
  const nlohmann::json same = tactus(with_json).json()["backends"][1]["same_states"];
  ASSERT_EQ(same["ticks"].size(), 10u);
  EXPECT_GT(same["other_limits"].get<int>(), 0);
  bool told = false;
  for (const nlohmann::json& tick : same["ticks"]) {
    EXPECT_GT(tick["solve_us"].get<double>(), 0);
    told |= !tick["limits_here"].empty();
  }
  EXPECT_TRUE(told);
  const Outcome table = tactus(arguments);
  EXPECT_THAT(table.out, HasSubstr("where qp/nlopt is furthest from null-space\n  t = "));
  EXPECT_THAT(table.out, HasSubstr(" % apart: at their torque limits here alone: "));
}

TEST(CompareCommand, TableForPeople) {
  const Outcome outcome =
      tactus({"compare", data("press.xml"), "--backends", "null-space,qp/nlopt", "--duration", "0.05"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  for (const char* line : {"null-space", "qp/nlopt", "torque difference, mean (M⁻¹ norm)", "constraint violation",
                           "KKT stationarity", "tick, median (µs)", "tick, p99 (µs)", "fallbacks", "mean task error"}) {
    EXPECT_THAT(outcome.out, HasSubstr(line));
  }
}

TEST(CompareCommand, ThePageShowsWhereAndWhy) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "stiffness=\"1\"", "stiffness=\"500\"");
  const std::string page = folder.path() + "/compare.html";
  const Outcome outcome = tactus({"compare", stack, "--backends", "null-space,hqp", "--duration", "0.1", "--every", "10",
                                  "--page", page, "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("page: " + page));
  const std::string html = runtime::readFile(page);
  const nlohmann::json hqp = outcome.json()["backends"][1];
  ASSERT_FALSE(hqp["same_states"]["furthest"].empty());
  EXPECT_EQ(hqp["closed_loop"]["traces"]["time"].size(), hqp["closed_loop"]["traces"]["links"].size());
  EXPECT_GT(hqp["closed_loop"]["traces"]["time"].size(), 20u);
  const std::string furthest = hqp["same_states"]["furthest"][0];
  EXPECT_THAT(html, HasSubstr("<li>" + furthest.substr(0, furthest.find('\''))));
  for (const char* text : {"back ends compared", "Torque apart from null-space", "at a bound in one of the two alone",
                           "Time of the solve", "Links in contact", "Time of a tick", "where hqp is furthest from"})
    EXPECT_THAT(html, HasSubstr(text));
  for (const char* elsewhere : {"src=", "href=", "@import", "url("})
    EXPECT_THAT(html, ::testing::Not(HasSubstr(elsewhere)));
}

TEST(CompareCommand, APageThatCannotBeWrittenIsRefusedBeforeTheFirstRun) {
  const Outcome outcome = tactus({"compare", data("press.xml"), "--page", "/no/such/folder/compare.html"});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr("/no/such/folder/compare.html"));
  EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("null-space:")));
}

TEST(CompareCommand, UnknownVariantIsRefusedBeforeTheFirstRun) {
  const Outcome outcome = tactus({"compare", data("press.xml"), "--backends", "null-space,qp/ipopd"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("back end 'qp' has no variant 'ipopd'; variants: "));
}

}  // namespace
}  // namespace tactus::testing
