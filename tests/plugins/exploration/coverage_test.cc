// What the measure of coverage says of touches that are known.
#include "plugins/exploration/coverage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "framework/geometry/primitives.h"
#include "tests/plugins/exploration/figure_of.h"
#include "tests/runtime/pendulum.h"
#include "tests/tasks/task_world.h"

namespace tactus::exploration {
namespace {

const Eigen::Vector3d centre(0.7, 0, 0.15);
constexpr double radius = 0.05;

class CoverageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    description::Object ball;
    ball.name = "ball";
    ball.pose.translation() = centre;
    ball.primitives.push_back({std::make_shared<geometry::Sphere>(radius)});
    scene.objects = {ball};
    Coverage::registerIn(world.registry);
    values = control::makeValues(*world.registry.elements().find("coverage"),
                                 {{"name", "seen"}, {"from", "touch.points"}, {"links", "fingers"}, {"samples", "200"}});
    measure = make();
  }
  std::unique_ptr<control::Measure> make() {
    return world.registry.makeMeasure(
        control::MeasureContext(world.context(values), *controller, scene, test::handOverTable()));
  }
  void touch(const Eigen::Vector3d& outward) {
    control::ContactRecord record;
    record.link = world.link("middle_distal");
    record.object = 0;
    record.point_W = centre + radius * outward.normalized();
    record.normal_W = -outward.normalized();
    record.force_N = 0.5;
    world.sensed.contacts = {record};
    world.feel();
    world.sensed.time += world.dt;
    measure->observe({world.sensed, world.sensed, *controller, torque, 1});
  }
  double figure(const std::string& name) { return testing::figureOf(*measure, name); }

  test::TaskWorld world;
  description::Scene scene;
  control::ElementValues values;
  std::unique_ptr<control::Controller> controller = testing::pendulumController(0);  // nobody looks at it
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(23);
  std::unique_ptr<control::Measure> measure;
};

TEST_F(CoverageTest, ATouchCoversTheCapWithinItsRadius) {
  EXPECT_EQ(figure("covered"), 0);
  EXPECT_TRUE(std::isnan(figure("half_covered_s")));
  touch({0, 0, 1});
  // A chord of r about a point of a ball cuts off a cap of area πr²: r²/4R² of the ball.
  const double cap = 0.01 * 0.01 / (4 * radius * radius);
  EXPECT_NEAR(figure("covered_all"), cap, 0.015);
  EXPECT_GT(figure("covered_upward"), figure("covered"));
  EXPECT_EQ(figure("covered_sideward"), 0);
  touch({0, 0, 1});
  EXPECT_NEAR(figure("covered_all"), cap, 0.015) << "the same again";
}

TEST_F(CoverageTest, TouchesAllOverCoverAllAndTheTimeOfHalfStays) {
  for (int k = 0; k < 400; ++k) {
    const double z = 1 - (k + 0.5) / 200, turn = 2.399963 * k, across = std::sqrt(1 - z * z);
    touch({across * std::cos(turn), across * std::sin(turn), z});  // a Fibonacci spiral from above
  }
  EXPECT_EQ(figure("covered"), 1);
  EXPECT_EQ(figure("covered_all"), 1);
  EXPECT_GT(figure("reachable"), 0.3);
  EXPECT_LE(figure("reachable"), 1);
  const double half = figure("half_covered_s");
  EXPECT_GT(half, 0.05);
  EXPECT_LT(half, 0.3);
  touch({0, 0, 1});
  EXPECT_EQ(figure("half_covered_s"), half);
}

TEST_F(CoverageTest, ItsStateGoesOnElsewhere) {
  touch({0, 0, 1});
  touch({1, 0, 1});
  control::State state;
  auto saving = control::Archive::saving(state);
  measure->archive(saving);
  const double covered = figure("covered");
  measure = make();
  EXPECT_EQ(figure("covered"), 0);
  auto restoring = control::Archive::restoring(state);
  measure->archive(restoring);
  EXPECT_EQ(figure("covered"), covered);
  EXPECT_GT(covered, 0);
}

}  // namespace
}  // namespace tactus::exploration
