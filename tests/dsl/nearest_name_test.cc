#include "dsl/nearest_name.h"

#include <gtest/gtest.h>

namespace tactus::dsl {
namespace {

const std::vector<std::string> names{"stiffness", "damping", "force", "joints", "x"};

TEST(NearestName, FindsSlipsOfTheFinger) {
  EXPECT_EQ(nearestName("stifness", names), "stiffness");
  EXPECT_EQ(nearestName("dampping", names), "damping");
  EXPECT_EQ(nearestName("froce", names), "force");  // neighbours swapped
  EXPECT_EQ(nearestName("Joints", names), "joints");
  EXPECT_EQ(nearestName("jionst", names), "joints");
}

TEST(NearestName, StaysSilentWhenNothingIsNear) {
  EXPECT_EQ(nearestName("colour", names), "");
  EXPECT_EQ(nearestName("y", names), "");
  EXPECT_EQ(nearestName("", names), "");
  EXPECT_EQ(nearestName("stifness", {}), "");
  EXPECT_EQ(nearestName(std::string(100000, 'a'), names), "");
}

TEST(NearestName, TheNearestWinsAndTiesGoToTheFirst) {
  EXPECT_EQ(nearestName("posturr", {"pasture", "posture"}), "posture");
  EXPECT_EQ(nearestName("arn", {"arm", "art"}), "arm");
}

}  // namespace
}  // namespace tactus::dsl
