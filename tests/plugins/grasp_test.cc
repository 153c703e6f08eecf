// Grasp wrench spaces: cases by hand, and laws over random grasps.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "plugins/grasp/grasp_wrench_space.h"

namespace tactus::plugins {
namespace {

using Eigen::Vector3d;

/// Contacts on a lump, their normals roughly inwards.
std::vector<GraspContact> randomGrasp(unsigned seed, int contacts) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  std::vector<GraspContact> grasp;
  for (int i = 0; i < contacts; ++i) {
    const Vector3d place = vector().normalized();
    grasp.push_back({0.04 * place, (-place + 0.2 * vector()).normalized()});
  }
  return grasp;
}

GraspWrenchOptions optionsOf(double friction, double scale = 0.04) {
  GraspWrenchOptions options;
  options.friction = friction;
  options.scale = scale;
  return options;
}

// Without friction, twelve contacts have the wrenches (± e_x, ± e_y), (± e_y, ± e_z), (± e_z, ± e_x) of force and torque:
// three squares in three planes at right angles.  Their hull is {Σ ‖x_k‖∞ ≤ 1}: volume 4 · 4 · 4 · 2!³/6!, and its facets
// are as far from 0 as (1, 1, 1) · x = 1 is.
TEST(GraspWrenchSpace, ThreeSquaresByHand) {
  std::vector<GraspContact> grasp;
  for (const double s : {1.0, -1.0})
    for (const double r : {1.0, -1.0}) {
      grasp.push_back({Vector3d(0, 0, r * s), s * Vector3d::UnitX()});
      grasp.push_back({Vector3d(r * s, 0, 0), s * Vector3d::UnitY()});
      grasp.push_back({Vector3d(0, r * s, 0), s * Vector3d::UnitZ()});
    }
  const GraspWrenchSpace space = graspWrenchSpace(grasp, optionsOf(0, 1));
  EXPECT_EQ(space.rank, 6);
  EXPECT_NEAR(space.volume, 64.0 * 8 / 720, 1e-12);
  EXPECT_NEAR(space.epsilon, 1 / std::sqrt(3.0), 1e-12);
}

// A hard finger cannot turn a ball about the line through two of them.
TEST(GraspWrenchSpace, AnAntipodalPairLacksADimension) {
  const GraspWrenchSpace space =
      graspWrenchSpace({{Vector3d::UnitX(), -Vector3d::UnitX()}, {-Vector3d::UnitX(), Vector3d::UnitX()}}, optionsOf(0.5, 1));
  EXPECT_EQ(space.rank, 5);
  EXPECT_EQ(space.epsilon, 0);
  EXPECT_EQ(space.volume, 0);
}

TEST(GraspWrenchSpace, NothingHoldsNothing) {
  const GraspWrenchSpace space = graspWrenchSpace({}, optionsOf(0.5));
  EXPECT_EQ(space.rank, 0);
  EXPECT_EQ(space.epsilon, 0);
  EXPECT_EQ(space.volume, 0);
}

// Three fingers on the equator of a ball, 120° apart, hold it with friction; on one side of it they do not.
TEST(GraspWrenchSpace, ThreeFingersHoldABallFromAroundOnly) {
  const auto fingers = [](double apart) {
    std::vector<GraspContact> grasp;
    for (const double angle : {-apart, 0.0, apart}) {
      const Vector3d place(std::cos(angle), std::sin(angle), 0);
      grasp.push_back({place, -place});
    }
    return grasp;
  };
  EXPECT_GT(graspWrenchSpace(fingers(2 * std::numbers::pi / 3), optionsOf(0.5, 1)).epsilon, 0.05);
  const GraspWrenchSpace one_side = graspWrenchSpace(fingers(0.4), optionsOf(0.3, 1));
  EXPECT_EQ(one_side.rank, 6);
  EXPECT_GT(one_side.volume, 0);
  EXPECT_EQ(one_side.epsilon, 0);
}

TEST(GraspWrenchSpace, EdgesOfAConeAreAsWritten) {
  GraspWrenchOptions options = optionsOf(0.5, 2);
  options.edges = 4;
  const auto wrenches = primitiveWrenches({{Vector3d(0, 0, 1), 3 * Vector3d::UnitZ()}}, options);
  ASSERT_EQ(wrenches.cols(), 4);
  // n × x̂ = ŷ = t₁, n × t₁ = −x̂ = t₂; torque (p × f)/2 with p = ẑ.
  Eigen::Matrix<double, 6, 4> expected;
  expected.col(0) << 0, 0.5, 1, -0.25, 0, 0;
  expected.col(1) << -0.5, 0, 1, 0, -0.25, 0;
  expected.col(2) << 0, -0.5, 1, 0.25, 0, 0;
  expected.col(3) << 0.5, 0, 1, 0, 0.25, 0;
  EXPECT_LT((wrenches - expected).cwiseAbs().maxCoeff(), 1e-15);
  const auto along_x = primitiveWrenches({{Vector3d::Zero(), Vector3d::UnitX()}}, options);
  EXPECT_LT((along_x.col(0).head<3>() - Vector3d(1, 0, 0.5)).norm(), 1e-15) << "n × ŷ = ẑ";
}

class GraspLaws : public ::testing::TestWithParam<int> {
 protected:
  std::vector<GraspContact> grasp = randomGrasp(static_cast<unsigned>(GetParam()), 4 + GetParam() % 3);
};

TEST_P(GraspLaws, VolumeGoesWithTheScaleToMinusThree) {
  const double one = graspWrenchSpace(grasp, optionsOf(0.4, 0.04)).volume;
  const double two = graspWrenchSpace(grasp, optionsOf(0.4, 0.08)).volume;
  EXPECT_GT(one, 0);
  EXPECT_NEAR(two, one / 8, 1e-9 * one);
}

TEST_P(GraspLaws, AContactMoreNeverLowers) {
  const GraspWrenchSpace before = graspWrenchSpace(grasp, optionsOf(0.4));
  grasp.push_back(randomGrasp(1000 + static_cast<unsigned>(GetParam()), 1)[0]);
  const GraspWrenchSpace after = graspWrenchSpace(grasp, optionsOf(0.4));
  EXPECT_GE(after.volume, before.volume * (1 - 1e-9));
  EXPECT_GE(after.epsilon, before.epsilon - 1e-12);
}

// About x̂ the tangents turn with the normals, where no normal is near it.
TEST_P(GraspLaws, AGraspThatIsTurnedWithItsTangentsIsTheSame) {
  for (GraspContact& contact : grasp) {
    contact.normal.x() = 0.5 * std::tanh(contact.normal.x());
    contact.normal.tail<2>() *= std::sqrt(1 - contact.normal.x() * contact.normal.x()) / contact.normal.tail<2>().norm();
  }
  const GraspWrenchSpace before = graspWrenchSpace(grasp, optionsOf(0.4));
  const Eigen::AngleAxisd turn(0.7, Vector3d::UnitX());
  for (GraspContact& contact : grasp) contact = {turn * contact.position, turn * contact.normal};
  const GraspWrenchSpace after = graspWrenchSpace(grasp, optionsOf(0.4));
  EXPECT_NEAR(after.volume, before.volume, 1e-9 * before.volume);
  EXPECT_NEAR(after.epsilon, before.epsilon, 1e-9);
}

TEST_P(GraspLaws, LengthsAndScaleTogetherChangeNothing) {
  const GraspWrenchSpace before = graspWrenchSpace(grasp, optionsOf(0.4, 0.04));
  GraspWrenchOptions options = optionsOf(0.4, 0.12);
  options.centre = {1, 2, 3};
  for (GraspContact& contact : grasp) contact.position = 3 * contact.position + options.centre;
  const GraspWrenchSpace after = graspWrenchSpace(grasp, options);
  EXPECT_NEAR(after.volume, before.volume, 1e-9 * before.volume);
  EXPECT_NEAR(after.epsilon, before.epsilon, 1e-9);
}

TEST_P(GraspLaws, BothGrowWithFriction) {
  GraspWrenchSpace last{0, 0};
  for (const double friction : {0.1, 0.2, 0.4, 0.8}) {
    const GraspWrenchSpace space = graspWrenchSpace(grasp, optionsOf(friction));
    EXPECT_GT(space.volume, last.volume);
    EXPECT_GE(space.epsilon, last.epsilon - 1e-12);
    last = space;
  }
}

TEST_P(GraspLaws, TwiceTheEdgesNeverLower) {
  GraspWrenchOptions options = optionsOf(0.4);
  const GraspWrenchSpace eight = graspWrenchSpace(grasp, options);
  options.edges = 16;
  const GraspWrenchSpace sixteen = graspWrenchSpace(grasp, options);
  EXPECT_GE(sixteen.volume, eight.volume * (1 - 1e-9));
  EXPECT_GE(sixteen.epsilon, eight.epsilon - 1e-12);
}

TEST_P(GraspLaws, RepeatsToTheBit) {
  const GraspWrenchSpace one = graspWrenchSpace(grasp, optionsOf(0.4)), two = graspWrenchSpace(grasp, optionsOf(0.4));
  EXPECT_EQ(one.volume, two.volume);
  EXPECT_EQ(one.epsilon, two.epsilon);
}

INSTANTIATE_TEST_SUITE_P(RandomGrasps, GraspLaws, ::testing::Range(0, 8));

TEST(GraspWrenchSpace, RefusesWhatIsNoGrasp) {
  const std::vector<GraspContact> good{{Vector3d::UnitX(), -Vector3d::UnitX()}};
  const double nan = std::nan("");
  EXPECT_THROW(graspWrenchSpace({{Vector3d::UnitX(), Vector3d::Zero()}}, optionsOf(0.5)), std::invalid_argument);
  EXPECT_THROW(graspWrenchSpace({{Vector3d(nan, 0, 0), Vector3d::UnitX()}}, optionsOf(0.5)), std::invalid_argument);
  EXPECT_THROW(graspWrenchSpace(good, optionsOf(-0.1)), std::invalid_argument);
  EXPECT_THROW(graspWrenchSpace(good, optionsOf(nan)), std::invalid_argument);
  EXPECT_THROW(graspWrenchSpace(good, optionsOf(0.5, 0)), std::invalid_argument);
  GraspWrenchOptions two_edges;
  two_edges.edges = 2;
  EXPECT_THROW(graspWrenchSpace(good, two_edges), std::invalid_argument);
}

}  // namespace
}  // namespace tactus::plugins
