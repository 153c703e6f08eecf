#include "bench/peers/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tactus::bench {
namespace {

using testing::HasSubstr;

Figure figure(const std::string& model, const std::string& engine, double median_us) {
  Figure f;
  f.model = model;
  f.engine = engine;
  f.operation = Operation::rnea;
  f.timing = {median_us, 2 * median_us, 3000, 20};
  return f;
}

TEST(Report, ATargetIsMetOrMissed) {
  Figure f = figure("lwr_allegro", "Tactus", 1.5);
  f.target = targetRatio("lwr_allegro", Operation::rnea);
  f.ratio = 0.37;
  EXPECT_THAT(table({f}), HasSubstr("<= 0.38 met"));
  EXPECT_EQ(toJson({f})[0]["met"], true);
  f.ratio = 0.39;
  EXPECT_THAT(table({f}), HasSubstr("<= 0.38 MISSED"));
  EXPECT_EQ(toJson({f})[0]["met"], false);
}

TEST(Report, OnlySomeFiguresHaveTargets) {
  EXPECT_EQ(targetRatio("humanoid", Operation::mass_matrix), 0.38);
  EXPECT_EQ(targetRatio("humanoid", Operation::bias), std::nullopt);
  EXPECT_EQ(targetRatio("arm", Operation::rnea), std::nullopt);
}

TEST(Report, DisagreementNamesEngineOperationAndModel) {
  Figure f = figure("arm", "KDL 1.5.1", 1);
  f.difference = 0.5e-6;
  EXPECT_EQ(disagreement(f), "");
  f.difference = 2e-6;
  EXPECT_EQ(disagreement(f),
            "KDL 1.5.1: rnea of arm differs from Tactus's by 2.0e-06, more than 1e-06: its time means nothing");
}

TEST(Report, GrowthIsTheExponentOfTheNumberOfJoints) {
  const std::vector<Figure> figures = {figure("chain_10", "Tactus", 0.6), figure("chain_20", "Tactus", 1.3),
                                       figure("chain_100", "Tactus", 60), figure("chain_100", "Simbody 3.7", 1)};
  EXPECT_THAT(growth(figures), HasSubstr("time ~ joints^2.000 from 10 to 100"));
  EXPECT_THAT(growth(figures), HasSubstr("20: 65.0"));
  EXPECT_EQ(growth({figures[0]}), "");
}

}  // namespace
}  // namespace tactus::bench
