#include <gmock/gmock.h>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::HasSubstr;

TEST(SolveCommand, CascadeByHand) {
  const Outcome outcome = tactus({"solve", data("two_levels.json"), "--backend", "null-space", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = outcome.json();
  EXPECT_EQ(json["backend"], "null-space");
  EXPECT_EQ(json["status"], "ok");
  // The second level may not touch the first joint: of its torque (5, 5, 0) the second joint's part is left.
  EXPECT_NEAR(json["torque"][0].get<double>(), 3, 1e-12);
  EXPECT_NEAR(json["torque"][1].get<double>(), 5, 1e-12);
  EXPECT_NEAR(json["torque"][2].get<double>(), 0, 1e-12);
  ASSERT_EQ(json["levels"].size(), 2u);
  EXPECT_EQ(json["levels"][0]["rank"], 1);
  EXPECT_EQ(json["levels"][0]["nullity"], 2);
  EXPECT_EQ(json["levels"][1]["nullity"], 1);
  // a = J M⁻¹ Jᵀ F = 5 (1 + ½); reached is 3 + 2.5.
  EXPECT_NEAR(json["levels"][1]["residual"].get<double>(), 2, 1e-12);
  EXPECT_TRUE(json.contains("solve_us"));
}

TEST(SolveCommand, EveryVariantOfTheCascade) {
  for (const char* projection : {"successive", "augmented"}) {
    for (const char* inequalities : {"one-pass", "exact"}) {
      const Outcome outcome = tactus({"solve", data("two_levels.json"), "--backend", "null-space", "--projection",
                                      projection, "--inequalities", inequalities, "--json"});
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_NEAR(outcome.json()["torque"][0].get<double>(), 3, 1e-12);
    }
  }
}

TEST(SolveCommand, BothSolversOfTheProgramme) {
  for (const char* solver : {"ipopt", "nlopt"}) {
    const Outcome outcome = tactus({"solve", data("two_levels.json"), "--backend", "qp", "--solver", solver, "--json"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(outcome.json()["backend"], "qp");
    EXPECT_NEAR(outcome.json()["torque"][0].get<double>(), 3, 0.05);  // a weight of 100, not strictness
  }
}

TEST(SolveCommand, InfeasibleIsJsonAllTheSame) {
  const Outcome outcome = tactus({"solve", data("infeasible.json"), "--backend", "qp", "--json"});
  EXPECT_EQ(outcome.exit_code, 5);
  EXPECT_EQ(outcome.json()["status"], "infeasible");
  EXPECT_EQ(outcome.json()["torque"].size(), 2u);
  EXPECT_THAT(outcome.err, HasSubstr("infeasible"));
}

TEST(SolveCommand, InfeasibleSaysWhoContradictsWhomAndWhatWouldDo) {
  const Outcome outcome = tactus({"solve", data("infeasible.json"), "--backend", "qp", "--json"});
  // τ₁ ≥ 1, but the wall may neither be pressed nor approached.
  const std::string sentence =
      "task 'wall' and the torque limit of joint 1 contradict each other; any one of these would do: let 'wall' be "
      "accelerated by 1 m/s², allow the force of 'wall' 1 N more, or allow joint 1 1 N m beyond its lower limit";
  EXPECT_THAT(outcome.err, HasSubstr("tactus solve: " + sentence + "\n"));
  const nlohmann::json conflict = outcome.json()["conflict"];
  EXPECT_EQ(conflict["sentence"], sentence);
  EXPECT_EQ(conflict["groups"], nlohmann::json::parse(R"([{"what": "rows", "task": "wall"},
      {"what": "forces", "task": "wall"}, {"what": "torque-limit", "joint": 1}])"));
  ASSERT_EQ(conflict["relaxations"].size(), 3u);
  EXPECT_EQ(conflict["relaxations"][2]["unit"], "N m");
  EXPECT_NEAR(conflict["relaxations"][2]["amount"].get<double>(), 1, 1e-9);
  EXPECT_EQ(conflict["relaxations"][2]["enough"], true);
  EXPECT_EQ(conflict["beyond"], nlohmann::json::parse(R"([{"joint": 1, "beyond_Nm": 1.0}])"));
  EXPECT_FALSE(tactus({"solve", data("two_levels.json"), "--backend", "qp", "--json"}).json().contains("conflict"));
}

TEST(SolveCommand, OptionOfAnotherBackEnd) {
  const Outcome outcome = tactus({"solve", data("two_levels.json"), "--backend", "null-space", "--solver", "ipopt"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err,
              HasSubstr("back end 'null-space' has no option 'solver'; its options: projection, inequalities"));
}

TEST(SolveCommand, MisspelledOption) {
  const Outcome outcome =
      tactus({"solve", data("two_levels.json"), "--backend", "null-space", "--option", "rank-tolerence=1e-6"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("did you mean 'rank-tolerance'?"));
}

TEST(SolveCommand, ValueThatIsNoChoice) {
  const Outcome outcome =
      tactus({"solve", data("two_levels.json"), "--backend", "null-space", "--projection", "sideways"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("'sideways'"));
  EXPECT_THAT(outcome.err, HasSubstr("'successive'"));
}

TEST(SolveCommand, UnknownBackEnd) {
  const Outcome outcome = tactus({"solve", data("two_levels.json"), "--backend", "hopq"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("there is no back end 'hopq'; back ends: hqp, null-space, qp"));
}

TEST(SolveCommand, NumbersAtTheEndOfTheirRangeFailInWords) {
  const TemporaryFolder folder;
  const std::string file = folder.write("tick.json", R"({"format": "tactus-tick/1", "dof": 2,
      "mass_matrix": [[1, 0], [0, 1]], "torque_limits": {"lower": [1e-188, -1], "upper": [1e-160, 1e-193]},
      "levels": [{"priority": 1, "weight": 1e-308, "tasks": [{"name": "wall", "relation": "inequality",
      "jacobian": [[1, 0]], "force": [0], "contact": true, "force_max": 0}]}]})");
  for (const std::string solver : {"qp/ipopt", "qp/nlopt"}) {
    const Outcome outcome = tactus({"solve", file, "--backend", solver});
    EXPECT_EQ(outcome.exit_code, 5) << solver;
    EXPECT_THAT(outcome.err, HasSubstr("failed: the solver's answer is not optimal (its programme overflows)\n"));
  }
}

TEST(SolveCommand, AMessageThatIsNotUtf8IsJsonAllTheSame) {
  const TemporaryFolder folder;
  const Outcome outcome =
      tactus({"solve", folder.write("tick.json", "{\"format\": \xff"), "--backend", "hqp", "--json"});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.json()["errors"][0]["message"].get<std::string>(), HasSubstr("not JSON: parse error"));
  EXPECT_EQ(tactus({"run", "/nowhere/\xff.xml", "--json"}).json()["errors"].size(), 1u);
}

TEST(SolveCommand, FileThatIsNoTickProblem) {
  const TemporaryFolder folder;
  EXPECT_EQ(tactus({"solve", "/nowhere.json", "--backend", "null-space"}).exit_code, 6);
  const Outcome outcome = tactus({"solve", folder.write("t.json", "{\"format\": \"tactus-tick/9\"}"), "--backend",
                                  "null-space"});
  EXPECT_EQ(outcome.exit_code, 6);
  EXPECT_THAT(outcome.err, HasSubstr(folder.file("t.json") + ": "));
}

}  // namespace
}  // namespace tactus::testing
