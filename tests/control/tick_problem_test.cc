#include "framework/control/tick_problem.h"

#include <gtest/gtest.h>

namespace tactus::control {
namespace {

TEST(TickProblem, ATaskStartsEmptyWithItsCapacity) {
  const TickTask task("reach", 3, 5);
  EXPECT_EQ(task.name, "reach");
  EXPECT_EQ(task.rows, 0);
  EXPECT_EQ(task.capacity(), 3);
  EXPECT_EQ(task.jacobian, Eigen::MatrixXd::Zero(3, 5));
  EXPECT_EQ(task.force.size(), 3);
  EXPECT_EQ(task.acceleration.size(), 3);
  EXPECT_EQ(task.J().rows(), 0);
}

TEST(TickProblem, RowCapacityCountsEveryTaskOfEveryLevel) {
  TickProblem problem;
  problem.levels = {{1, {}, {TickTask("a", 3, 2), TickTask("b", 1, 2)}}, {2, {}, {}}, {3, {}, {TickTask("c", 4, 2)}}};
  EXPECT_EQ(problem.rowCapacity(), 8);
  EXPECT_EQ(TickProblem{}.rowCapacity(), 0);
}

}  // namespace
}  // namespace tactus::control
