#include "bench/peers/problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/dynamics/robots.h"

namespace tactus::bench {
namespace {

using description::JointType;

std::string refusal(const description::Robot& robot) {
  try {
    Problem("refused", robot);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Problem, MergesLinksOnFixedJointsAndTheRotor) {
  const description::Robot robot = test_robots::lwrAllegro();
  const Problem problem("lwr_allegro", robot);
  ASSERT_EQ(problem.bodies.size(), 23u);
  double links = -robot.links[robot.root].mass, bodies = 0;        // the root does not move
  for (const description::Link& link : robot.links) links += link.mass;
  for (const Body& body : problem.bodies) bodies += body.mass;
  EXPECT_NEAR(bodies, links, 1e-12);
}

TEST(Problem, BodiesStandAfterTheirParentsAndStatesHaveUnitQuaternions) {
  const Problem problem("humanoid", test_robots::humanoid());
  EXPECT_EQ(problem.dof, 36);
  for (size_t i = 0; i < problem.bodies.size(); ++i) EXPECT_LT(problem.bodies[i].parent, static_cast<int>(i));
  for (const State& state : problem.states) EXPECT_NEAR(state.q.segment<4>(3).norm(), 1, 1e-12);
}

TEST(Problem, RefusesJointsThatNotEveryEngineHas) {
  description::Robot robot = test_robots::chain(2);
  robot.joints[1].type = JointType::planar;
  robot.joints[1].rotor_inertia = 0;
  EXPECT_EQ(refusal(robot), "joint 'joint2': the comparison takes only revolute and floating joints that no other joint "
                            "drives");
}

TEST(Problem, RefusesAFloatingBaseOffTheWorldFrame) {
  description::Robot robot = test_robots::humanoid();
  robot.joints[0].origin.translation().z() = 1;
  EXPECT_EQ(refusal(robot), "joint 'floating_base': the comparison takes a floating joint only where its frame is the "
                            "world's");
}

}  // namespace
}  // namespace tactus::bench
