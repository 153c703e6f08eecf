// Experiment 4 of the thesis as its user runs it: one finger complies with a thing, and the measure of the best it could.

#include <gmock/gmock.h>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

const std::string kStack = TACTUS_SOURCE_DIR "/examples/comply/stack.xml";

nlohmann::json metricsOf(const std::string& object, const std::string& pose, const std::string& bound = "1") {
  const TemporaryFolder folder;
  const Outcome outcome = tactus({"run", kStack, "--set", "object=" + object, "--set", "pose=" + pose, "--set",
                                  "bound=" + bound, "--seed", "11", "--out", folder.file("run"), "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return outcome.json()["metrics"];
}

TEST(Comply, TouchesWithAsManyLinksAsAnyPostureCould) {
  for (const auto& [object, optimum] : {std::pair{"ball", 3}, {"statuette", 2}, {"tablet", 3}}) {
    const nlohmann::json metrics = metricsOf(object, "c");
    EXPECT_EQ(metrics["best_reached"], optimum) << object;
    EXPECT_EQ(metrics["best_optimum"], optimum) << object;
    EXPECT_EQ(metrics["best_missed"], 0) << object;
    EXPECT_LE(metrics["contact_force_peak_N"], 1.6) << object;
    EXPECT_GE(metrics["best_q_index_proximal"], -0.196) << object;
    EXPECT_LE(metrics["best_q_index_proximal"], 1.61) << object;
  }
}

// The figure tells a finger that gives up from one that does not: pulled with 0.5 N, the last link sticks on foam.
TEST(Comply, FigureSeesALinkThatIsMissing) {
  const nlohmann::json metrics = metricsOf("ball", "c", "0.1");
  EXPECT_EQ(metrics["best_reached"], 2);
  EXPECT_EQ(metrics["best_optimum"], 3);
  EXPECT_EQ(metrics["best_missed"], 1);
}

TEST(ContactOptimum, SaysWhatIsWrongWithItsChain) {
  const TemporaryFolder folder;
  const auto check = [&](const std::string& measure) {
    folder.write("stack.xml", R"(<stack format="1" name="wrong"><plugin name="posture-search"/>
  <robot model="allegro_right"/>
  <scene><object name="ball" pose="0.1 0 0.2"><sphere radius="0.02"/></object></scene>
  <level priority="1"><posture name="rest" joints="hand"/></level>
  <controller backend="null-space"/>
  <run duration="1">)" + measure + "</run></stack>");
    return tactus({"run", folder.file("stack.xml"), "--out", folder.file("run")});
  };
  const Outcome other = check(R"(<contact-optimum name="best" links="ring_distal" joints="index_proximal index_medial"/>)");
  EXPECT_NE(other.exit_code, 0);
  EXPECT_THAT(other.err, ::testing::HasSubstr("no joint moves link 'ring_distal'"));
  const Outcome fingers =
      check(R"(<contact-optimum name="best" links="index_distal" joints="index_distal ring_distal"/>)");
  EXPECT_NE(fingers.exit_code, 0);
  EXPECT_THAT(fingers.err, ::testing::HasSubstr("the joints are no chain"));
  const Outcome fine = check(R"(<contact-optimum name="best" links="index_distal" step="0.002"
                                joints="index_abduction index_proximal index_medial index_distal"/>)");
  EXPECT_NE(fine.exit_code, 0);
  EXPECT_THAT(fine.err, ::testing::HasSubstr("take fewer joints or a larger step"));
  const Outcome nowhere =
      check(R"(<contact-optimum name="best" links="index_distal" joints="index_distal" facing="0 0 0"/>)");
  EXPECT_NE(nowhere.exit_code, 0);
  EXPECT_THAT(nowhere.err, ::testing::HasSubstr("a direction is not 0 0 0"));
}

}  // namespace
}  // namespace tactus::testing
