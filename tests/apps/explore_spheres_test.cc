// The shape of spheres as its user explores it, cut short: what must hold in every part of a run.

#include <gmock/gmock.h>

#include <algorithm>

#include "framework/runtime/csv_table.h"
#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

const std::string kStack = TACTUS_SOURCE_DIR "/examples/explore_spheres/stack.xml";

class ExploreSpheres : public ::testing::TestWithParam<const char*> {};

TEST_P(ExploreSpheres, KeepsManyLightContactsAndKnowsWhatItHasTouched) {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"run", kStack, "--seed", "101", "--duration", "15", "--set",
                                  std::string("goals=") + GetParam(), "--out", folder.file("run"), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json metrics = outcome.json()["metrics"];
  EXPECT_NEAR(metrics["contact_force_mean_N"], 0.5, 0.1);
  EXPECT_LE(metrics["contact_force_max_mean_N"], 1.0);
  EXPECT_LE(metrics["contact_force_peak_N"], 4.6);
  EXPECT_GE(metrics["links_in_contact_mean"], 4.5);
  EXPECT_GE(metrics["map_points"], 20);
  EXPECT_GT(metrics["surface_covered"], 0.3) << "45 s bring 0.9, on average";
  EXPECT_LE(metrics["surface_covered"], 1);
  EXPECT_GT(metrics["surface_reachable"], 0.9) << "nothing stands in the way of an arm above";

  const runtime::CsvTable log = runtime::CsvTable::read(folder.file("run/log.csv"));
  const auto covered = log.numbers(log.column("measure/surface/covered"));
  ASSERT_GE(covered.size(), 1000u);
  EXPECT_EQ(covered.front(), 0);
  EXPECT_TRUE(std::is_sorted(covered.begin(), covered.end())) << "what was touched stays touched";
}

INSTANTIATE_TEST_SUITE_P(Goals, ExploreSpheres, ::testing::Values("keys", "map"));

}  // namespace
}  // namespace tactus::testing
