// Experiment 5 in short: closing round something by touch, and by positions.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

nlohmann::json figuresOf(const std::string& method, const std::string& duration, const std::string& object = "cylinder") {
  const TemporaryFolder folder;
  const Outcome outcome =
      tactus({"run", std::string(TACTUS_SOURCE_DIR) + "/examples/enclose/stack.xml", "--set", "method=" + method, "--set",
              "object=" + object, "--set", "duration=" + duration, "--out", folder.file("run")});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return nlohmann::json::parse(contentOf(folder.file("run/run.json")))["metrics"];
}

TEST(Enclose, ActiveAdaptationHoldsWithMoreLinksThanPositionsDo) {
  const nlohmann::json active = figuresOf("active", "5"), first = figuresOf("enclose1", "5"), second = figuresOf("enclose2", "5");
  EXPECT_GE(active["grasp_contacts"], 9);
  EXPECT_NEAR(active["grasp_force_mean_N"], 0.5, 0.05);
  EXPECT_LT(active["contact_force_peak_N"], 1.5);
  EXPECT_GT(active["grasp_epsilon"], 0.05) << "it holds against any push and turn";
  for (const nlohmann::json& other : {first, second}) {
    EXPECT_GE(other["grasp_contacts"], 3);
    EXPECT_GE(active["grasp_contacts"].get<double>(), other["grasp_contacts"].get<double>() + 2);
    EXPECT_GT(active["grasp_volume"], other["grasp_volume"]);
  }
}

// The object is pushed 2 cm away, and after a second the hand has followed.
TEST(Enclose, ActiveAdaptationFollowsWhatIsPushedAbout) {
  const nlohmann::json figures = figuresOf("active", "7");
  EXPECT_GE(figures["grasp_contacts"], 7);
  EXPECT_LT(figures["grasp_force_max_N"], 0.95);
}

}  // namespace
}  // namespace tactus::testing
