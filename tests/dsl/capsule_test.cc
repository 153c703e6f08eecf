// A capsule reads back as it was, with every bit of its numbers and the memory of its tasks; broken ones are refused.
#include "dsl/capsule.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "dsl/tick_file.h"
#include "tests/plugins/random_problem.h"

namespace tactus::dsl {
namespace {

Capsule sample(int dof, test::ProblemSource& source) {
  Capsule capsule;
  capsule.back_end = "qp";
  capsule.options = {{"solver", "nlopt"}, {"force-weight", "0.1"}};
  capsule.warm_start = {3, -7, std::numeric_limits<int>::max()};
  capsule.deadline.iterations = 40;
  capsule.deadline.seconds = 1e-4;
  capsule.status = control::Status::infeasible;
  capsule.message = "no \"way\"";
  capsule.late = true;
  capsule.iterations = 12;
  capsule.torque = source.gaussian(dof, 1);
  capsule.torque[0] = -0.0;
  capsule.torque[1] = 5e-324;
  capsule.tick = 4711;
  capsule.time = 0.1 + 0.2;
  capsule.q = source.gaussian(dof, 1);
  capsule.qd = source.gaussian(dof, 1);
  for (int i = 0; i < dof; ++i) capsule.joints.push_back("a" + std::to_string(i));
  capsule.places = {{"task00", "stack.xml:3:5"}};
  capsule.stack = "<stack>\n</stack>\n";
  return capsule;
}

bool sameBits(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<size_t>(a.size())) == 0;
}

TEST(Capsule, ReadsBackBitForBit) {
  test::ProblemSource source(5);
  for (int k = 0; k < 20; ++k) {
    const control::TickProblem problem = source.problem({});
    const Capsule capsule = sample(problem.dof, source);
    const std::string text = capsuleToJson(problem, capsule);
    const TickFile file = parseTickFile(text);
    ASSERT_TRUE(file.capsule);
    const Capsule& read = *file.capsule;
    EXPECT_EQ(read.back_end, capsule.back_end);
    EXPECT_EQ(read.options, capsule.options);
    EXPECT_EQ(read.warm_start, capsule.warm_start);
    EXPECT_EQ(read.deadline.iterations, 40);
    EXPECT_EQ(read.deadline.seconds, 1e-4);
    EXPECT_EQ(read.status, capsule.status);
    EXPECT_EQ(read.message, capsule.message);
    EXPECT_TRUE(read.late);
    EXPECT_EQ(read.iterations, 12);
    EXPECT_TRUE(sameBits(read.torque, capsule.torque));
    EXPECT_EQ(read.tick, 4711);
    EXPECT_EQ(read.time, capsule.time);
    EXPECT_TRUE(sameBits(read.q, capsule.q));
    EXPECT_TRUE(sameBits(read.qd, capsule.qd));
    EXPECT_EQ(read.joints, capsule.joints);
    EXPECT_EQ(read.places, capsule.places);
    EXPECT_EQ(read.stack, capsule.stack);
    EXPECT_EQ(capsuleToJson(file.problem, read), text);
  }
}

TEST(Capsule, GivesTasksTheMemoryThatTheyHad) {
  control::TickProblem problem;
  problem.dof = 2;
  problem.mass_matrix.setIdentity(2, 2);
  problem.levels.resize(1);
  control::TickTask task("touch", 5, 2);
  task.rows = 2;
  task.jacobian.topRows(2) << 1, 2, 3, 4;
  task.force.head(2) << 5, 6;
  problem.levels[0].tasks.push_back(task);
  test::ProblemSource source(1);
  const TickFile file = parseTickFile(capsuleToJson(problem, sample(2, source)));
  const control::TickTask& read = file.problem.levels[0].tasks[0];
  EXPECT_EQ(read.capacity(), 5);
  EXPECT_EQ(read.force.size(), 5);
  EXPECT_EQ(read.acceleration.size(), 5);
  EXPECT_EQ(read.rows, 2);
  EXPECT_EQ(read.J(), task.J());
  EXPECT_EQ(read.F(), task.F());
}

TEST(Capsule, MayHoldNumbersThatAreNone) {
  control::TickProblem problem;
  problem.dof = 2;
  problem.mass_matrix.setIdentity(2, 2);
  problem.mass_matrix(0, 0) = -1;
  problem.levels.resize(1);
  control::TickTask task("imp", 1, 2);
  task.rows = 1;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  task.jacobian << infinity, -infinity;
  task.force << std::numeric_limits<double>::quiet_NaN();
  problem.levels[0].tasks.push_back(task);
  test::ProblemSource source(1);
  const TickFile file = parseTickFile(capsuleToJson(problem, sample(2, source)));
  const control::TickTask& read = file.problem.levels[0].tasks[0];
  EXPECT_EQ(read.jacobian, task.jacobian);
  EXPECT_TRUE(std::isnan(read.force[0]));
  EXPECT_EQ(file.problem.mass_matrix(0, 0), -1);
  // Any other tick file stays strict.
  EXPECT_THROW(parseTickProblem(tickProblemToJson(problem)), JsonFileError);
}

}  // namespace
}  // namespace tactus::dsl
