// Experiments 2 and 3 of the thesis as their user runs them, cut short: one cup, and one sweep of each hand.

#include <gmock/gmock.h>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

nlohmann::json metricsOf(const std::string& example, const std::vector<std::string>& options) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments{"run", TACTUS_SOURCE_DIR "/examples/" + example + "/stack.xml", "--seed", "1",
                                     "--out", folder.file("run"), "--json"};
  arguments.insert(arguments.end(), options.begin(), options.end());
  const Outcome outcome = tactus(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome.json()["metrics"];
}

TEST(ExploreCups, ActiveFingersTouchMoreThanSpringsAndPressLessThanStiffOnes) {
  // Until the middle of the turn.
  const auto with = [](const std::string& method) {
    return metricsOf("explore_cups", {"--duration", "12", "--set", "cup=4", "--set", "method=" + method});
  };
  const nlohmann::json active = with("active"), low = with("low"), high = with("high");
  EXPECT_GE(active["links_in_contact_mean"], 5.0);
  EXPECT_NEAR(active["contact_force_mean_N"], 0.5, 0.05);
  EXPECT_LE(active["contact_force_max_mean_N"], 0.85);
  EXPECT_LE(active["contact_force_peak_N"], 3.0);
  EXPECT_GE(active["links_in_contact_mean"].get<double>(), low["links_in_contact_mean"].get<double>() + 0.5);
  EXPECT_GE(active["links_in_contact_mean"].get<double>(), high["links_in_contact_mean"].get<double>() + 0.5);
  EXPECT_LE(active["contact_force_max_mean_N"], low["contact_force_max_mean_N"]);
}

TEST(ExploreHands, EachHandSweepsTheMailboxWithLightContacts) {
  for (const char* hand : {"1", "2"}) {
    const nlohmann::json metrics =
        metricsOf("explore_hands", {"--duration", "10", "--set", "object=mailbox", "--set", std::string("hand=") + hand});
    EXPECT_GE(metrics["links_in_contact_mean"], hand[0] == '1' ? 5.0 : 7.0) << hand;
    EXPECT_NEAR(metrics["contact_force_mean_N"], 0.5, 0.05) << hand;
    EXPECT_LE(metrics["contact_force_max_mean_N"], 0.8) << hand;
    EXPECT_LE(metrics["contact_force_peak_N"], 3.0) << hand;
    EXPECT_GE(metrics["keys_passed"], 1) << hand;
  }
}

}  // namespace
}  // namespace tactus::testing
