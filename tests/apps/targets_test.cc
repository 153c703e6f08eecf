#include "apps/tactus/targets.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::app {
namespace {

TEST(Targets, AreMetWithinTheirBounds) {
  const Target target{0.45, 0.55};
  EXPECT_TRUE(target.metBy(0.45));
  EXPECT_TRUE(target.metBy(0.55));
  EXPECT_FALSE(target.metBy(0.56));
  EXPECT_FALSE(target.metBy(0.44));
  EXPECT_FALSE(target.metBy(std::nan("")));
  EXPECT_EQ(target.text(), "0.45 – 0.55");
  EXPECT_EQ((Target{{}, 2}).text(), "≤ 2");
  EXPECT_FALSE((Target{0.45, {}}).metBy(std::nan("")));
}

TEST(Targets, SurviveAFile) {
  const Target target{0.1, {}};
  const auto json = nlohmann::ordered_json::parse(toJson(target).dump());
  const Target back = targetFromJson(JsonPlace("run.json", json));
  EXPECT_EQ(back.lower, target.lower);
  EXPECT_EQ(back.upper, target.upper);
}

}  // namespace
}  // namespace tactus::app
