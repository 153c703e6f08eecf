// Grasp wrench spaces from files.

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::HasSubstr;

constexpr const char* kBall = R"({"friction": 0.5, "contacts": [
  {"position": [1, 0, 0], "normal": [-1, 0, 0]}, {"position": [-1, 0, 0], "normal": [1, 0, 0]},
  {"position": [0, 1, 0], "normal": [0, -1, 0]}]})";

Outcome grasp(const std::string& json, const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  folder.write("grasp.json", json);
  std::vector<std::string> words{"grasp", folder.file("grasp.json")};
  words.insert(words.end(), more.begin(), more.end());
  return tactus(words);
}

TEST(GraspCommand, PrintsEpsilonAndVolume) {
  const Outcome outcome = grasp(kBall, {"--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json answer = nlohmann::json::parse(outcome.out);
  EXPECT_GT(answer["epsilon"], 0);
  EXPECT_GT(answer["volume"], 0);
  EXPECT_EQ(answer["contacts"], 3);
  EXPECT_EQ(answer["rank"], 6);
}

// Torques over twice the length: half the torques, an eighth of the volume.
TEST(GraspCommand, ReadsScaleCentreAndEdges) {
  const auto volumeWith = [](const std::string& options) {
    std::string json = kBall;
    return nlohmann::json::parse(grasp(json.insert(1, options), {"--json"}).out)["volume"].get<double>();
  };
  const double volume = volumeWith("");
  EXPECT_NEAR(volumeWith(R"("scale": 2, )"), volume / 8, 1e-12);
  EXPECT_NEAR(volumeWith(R"("edges": 8, "centre": [0, 0, 0], )"), volume, 0);
  EXPECT_GT(volumeWith(R"("edges": 16, )"), volume);
  EXPECT_NE(volumeWith(R"("centre": [0.5, 0, 0], )"), volume);
}

TEST(GraspCommand, SaysWhatAFlatGraspLacks) {
  const Outcome pair = grasp(R"({"friction": 0.5, "contacts": [
    {"position": [1, 0, 0], "normal": [-1, 0, 0]}, {"position": [-1, 0, 0], "normal": [1, 0, 0]}]})");
  EXPECT_EQ(pair.exit_code, 0);
  EXPECT_THAT(pair.out, HasSubstr("The wrenches span 5 of 6 dimensions"));
}

TEST(GraspCommand, RefusesWhatIsNoGrasp) {
  const auto says = [](const std::string& json) {
    const Outcome outcome = grasp(json);
    EXPECT_EQ(outcome.exit_code, 6) << json;
    return outcome.err;
  };
  EXPECT_THAT(says("{"), HasSubstr("is not JSON"));
  EXPECT_THAT(says("[]"), HasSubstr("expected an object with friction and contacts"));
  EXPECT_THAT(says(R"({"contacts": []})"), HasSubstr("at '/friction': expected a number ≥ 0"));
  EXPECT_THAT(says(R"({"friction": -1, "contacts": []})"), HasSubstr("at '/friction': expected a number ≥ 0"));
  EXPECT_THAT(says(R"({"friction": 1})"), HasSubstr("at '/contacts': expected an array of contacts"));
  EXPECT_THAT(says(R"({"friction": 1, "edges": 2.5, "contacts": []})"), HasSubstr("at '/edges': expected a whole number"));
  EXPECT_THAT(says(R"({"friction": 1, "scale": 0, "contacts": []})"), HasSubstr("at '/scale': expected a number > 0"));
  EXPECT_THAT(says(R"({"friction": 1, "frction": 1, "contacts": []})"), HasSubstr("did you mean 'friction'?"));
  EXPECT_THAT(says(R"({"friction": 1, "contacts": [{"position": [0, 0], "normal": [1, 0, 0]}]})"),
              HasSubstr("at '/contacts/0/position': expected three numbers"));
  EXPECT_THAT(says(R"({"friction": 1, "contacts": [{"position": [0, 0, 0], "normal": [0, 0, 0]}]})"),
              HasSubstr("at '/contacts/0/normal': expected a direction into the object"));
  EXPECT_EQ(tactus({"grasp", "/nowhere.json"}).exit_code, 6);
  EXPECT_EQ(tactus({"grasp"}).exit_code, 2);
}

}  // namespace
}  // namespace tactus::testing
