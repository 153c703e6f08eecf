#include "apps/tactus/targets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::app {
namespace {

const Target* find(const std::vector<Target>& targets, const std::string& metric) {
  for (const Target& target : targets) {
    if (target.metric == metric) return &target;
  }
  return nullptr;
}

TEST(Targets, OfTheMainJob) {
  const std::vector<control::Metric> metrics{{"contact_force_mean_N", 0.5}, {"contact_force_peak_N", 1.5},
                                             {"links_in_contact_mean", 6.4}, {"keys_passed", 7}, {"keys_total", 8},
                                             {"bump_position_error_m", 0.001}, {"bump_height_error_m", 0.001}};
  const std::vector<Target> targets = explorationTargets(metrics, 0.5, 9);
  EXPECT_DOUBLE_EQ(*find(targets, "contact_force_mean_N")->lower, 0.45);
  EXPECT_DOUBLE_EQ(*find(targets, "contact_force_mean_N")->upper, 0.55);
  EXPECT_DOUBLE_EQ(*find(targets, "contact_force_peak_N")->upper, 2.0);
  EXPECT_DOUBLE_EQ(*find(targets, "links_in_contact_mean")->lower, 6.0);
  EXPECT_DOUBLE_EQ(*find(targets, "keys_passed")->lower, 7.0);
  EXPECT_DOUBLE_EQ(*find(targets, "bump_position_error_m")->upper, 0.005);
  EXPECT_DOUBLE_EQ(*find(targets, "bump_height_error_m")->upper, 0.002);
  EXPECT_EQ(find(targets, "keys_total"), nullptr);
  EXPECT_EQ(find(targets, "contact_force_max_mean_N"), nullptr) << "a target without its metric";
}

TEST(Targets, AreMetWithinTheirBounds) {
  const Target target{"x", 0.45, 0.55};
  EXPECT_TRUE(target.metBy(0.45));
  EXPECT_TRUE(target.metBy(0.55));
  EXPECT_FALSE(target.metBy(0.56));
  EXPECT_FALSE(target.metBy(0.44));
  EXPECT_FALSE(target.metBy(std::nan("")));
  EXPECT_EQ(target.text(), "0.45 – 0.55");
  EXPECT_EQ((Target{"x", {}, 2}).text(), "≤ 2");
}

TEST(Targets, SurviveAFile) {
  const Target target{"x", 0.1, {}};
  const Target back = targetFromJson("x", nlohmann::ordered_json::parse(toJson(target).dump()));
  EXPECT_EQ(back.lower, target.lower);
  EXPECT_EQ(back.upper, target.upper);
}

}  // namespace
}  // namespace tactus::app
