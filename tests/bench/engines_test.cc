#include "bench/peers/engine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "bench/peers/measure.h"
#include "bench/peers/report.h"
#include "tests/dynamics/robots.h"

// Every engine that was built in computes what this one does; and one that does not is found.
namespace tactus::bench {
namespace {

void expectAgreement(const Problem& problem) {
  const std::vector<std::unique_ptr<Engine>> engines = makeEngines(problem);
  for (const auto& engine : engines) {
    for (const Operation operation :
         {Operation::rnea, Operation::bias, Operation::mass_matrix, Operation::forward_dynamics,
          Operation::point_jacobians, Operation::tick, Operation::cache_tick}) {
      if (!engine->offers(operation)) continue;
      EXPECT_LE(relativeDifference(*engines[0], *engine, operation), 1e-10)
          << engine->name() << ", " << operationName(operation) << " of " << problem.name;
    }
  }
}

TEST(Engines, AgreeOnTheArmWithHand) { expectAgreement({"lwr_allegro", test_robots::lwrAllegro()}); }
TEST(Engines, AgreeOnAFloatingBase) { expectAgreement({"humanoid", test_robots::humanoid()}); }
TEST(Engines, AgreeOnASerialChain) { expectAgreement({"chain_10", test_robots::chain(10)}); }

/// M of a chain with one entry replaced.
class Wrong : public Engine {
 public:
  Wrong(const Problem& problem, double value) : right_(makeTactus(problem)), value_(value) {}
  std::string name() const override { return "Wrong"; }
  bool offers(Operation) const override { return true; }
  void run(Operation operation, int state) override { right_->run(operation, state); }
  Results results(Operation operation, int state) override {
    Results results = right_->results(operation, state);
    if (state == 7) results.mass_matrix(1, 0) = value_;
    return results;
  }

 private:
  std::unique_ptr<Engine> right_;
  double value_;
};

TEST(Engines, OneWrongNumberInOneStateIsFound) {
  const Problem problem("chain_3", test_robots::chain(3));
  const std::unique_ptr<Engine> tactus = makeTactus(problem);
  for (const double value : {100.0, std::numeric_limits<double>::quiet_NaN()}) {
    Wrong wrong(problem, value);
    EXPECT_GT(relativeDifference(*tactus, wrong, Operation::mass_matrix), 1) << value;
  }
}

TEST(Engines, MujocoSaysWhichProblemItRefuses) {
  if (absentEngines() != std::vector<std::string>() && absentEngines()[0].starts_with("MuJoCo"))
    GTEST_SKIP() << "MuJoCo is not built in";
  Problem problem("weightless", test_robots::chain(3));
  problem.bodies[2].mass = -1;
  EXPECT_THAT([&] { makeEngines(problem); },
              testing::ThrowsMessage<std::runtime_error>(testing::StartsWith("MuJoCo refuses 'weightless': ")));
}

}  // namespace
}  // namespace tactus::bench
