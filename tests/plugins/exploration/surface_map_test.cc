// The map of a ball that is touched, and the places that it names.
#include "plugins/exploration/surface_map.h"

#include <gtest/gtest.h>

#include "tests/plugins/exploration/figure_of.h"
#include "tests/tasks/task_world.h"

namespace tactus::exploration {
namespace {

const Eigen::Vector3d centre(0.7, 0, 0.1);
constexpr double radius = 0.1;

class SurfaceMapTest : public ::testing::Test {
 protected:
  void SetUp() override {
    SurfaceMap::registerIn(world.registry);
    make({});
  }
  void make(test::Attributes more) {
    more.insert({{"name", "map"}, {"from", "touch.points"}, {"on", "touch.held"}, {"frame", "palm"},
                 {"within", "0.5 -0.3 0 0.9 0.3 0.4"}, {"every", "1"}, {"facing-angle", "1.2"}});
    values = control::makeValues(*world.registry.elements().find("surface-map"), more);
    signal = world.registry.makeSignal(world.context(values));
    next = static_cast<const control::Place*>(signal->port("next"));
  }
  void touch(const Eigen::Vector3d& outward) {
    control::ContactRecord record;
    record.link = world.link("middle_distal");
    record.object = 0;
    record.point_W = centre + radius * outward.normalized();
    record.normal_W = -outward.normalized();
    record.force_N = 0.5;
    world.sensed.contacts = {record};
    tick(4);
  }
  void tick(int count) {
    for (int k = 0; k < count; ++k) {
      world.feel();
      signal->update(world.tick());
      world.sensed.time += world.dt;
    }
  }
  double metric(const std::string& name) { return testing::figureOf(*signal, name); }

  test::TaskWorld world;
  control::ElementValues touch_values = control::makeValues(*world.registry.elements().find("contacts"),
                                                            {{"name", "touch"}, {"desired", "fingers"}, {"hold", "0"}});
  control::ElementValues values;
  std::unique_ptr<control::Signal> signal;
  const control::Place* next = nullptr;
};

TEST_F(SurfaceMapTest, KnowsNoPlaceBeforeTheFirstTouch) {
  tick(10);
  EXPECT_FALSE(next->known);
}

TEST_F(SurfaceMapTest, NamesAPlaceOnTheSurfaceAwayFromWhatIsKnown) {
  for (double x = -0.5; x <= 0; x += 0.1)
    for (double y = -0.5; y <= 0.5; y += 0.1) touch({x, y, 1});
  touch({0, 0, 1});
  tick(3000);
  ASSERT_TRUE(next->known);
  // The middle of the contacts, not the palm, shall come there.
  const Eigen::Vector3d palm = world.cache.framePose(world.link("palm")).translation();
  const Eigen::Vector3d place = next->position_W + (centre + Eigen::Vector3d(0, 0, radius)) - palm;
  EXPECT_NEAR((place - centre).norm(), radius, 0.01);
  const Eigen::Vector3d out = (place - centre).normalized();
  EXPECT_TRUE(out.x() > 0.1 || std::abs(out.y()) > 0.5 || out.x() < -0.5) << "what was touched is known: " << out.transpose();
  EXPECT_GT(out.z(), std::cos(1.2) - 0.15) << "places face upwards";
}

TEST_F(SurfaceMapTest, KeepsPointsApartAndReachesWhatIsTouched) {
  for (int k = 0; k < 200; ++k) touch({0.3 * std::sin(k), 0.3 * std::cos(k), 1});
  const double points = metric("map_points");
  EXPECT_GT(points, 3);
  EXPECT_LT(points, 40) << "points 2 cm apart on a cap of 3 cm radius";
  tick(3000);
  ASSERT_TRUE(next->known);
  const int number = next->number;
  const Eigen::Vector3d palm = world.cache.framePose(world.link("palm")).translation();
  const Eigen::Vector3d middle = world.sensed.contacts[0].point_W;
  const Eigen::Vector3d place = next->position_W + middle - palm;
  touch(place - centre);
  tick(3000);
  EXPECT_GT(next->number, number);
  EXPECT_GE(metric("places_reached"), 1);
}

TEST_F(SurfaceMapTest, HeadsOutwardsFromWhatIsKnownAndTurnsTheShiftAlong) {
  make({{"heading", "outwards"}, {"step", "0.06"}});
  for (double x = -0.5; x <= 0.5; x += 0.1)
    for (double y = -0.5; y <= 0; y += 0.1) touch({x, y, 1});
  touch({0, -0.2, 1});
  tick(3000);
  ASSERT_TRUE(next->known);
  const Eigen::Vector3d& heading = next->heading_W;
  EXPECT_NEAR(heading.norm(), 1, 1e-9);
  EXPECT_NEAR(heading.z(), 0, 1e-9) << "across `facing`";
  // Turned to the heading, the hand has its contacts ahead of the palm as before: there lies the place, on the ball.
  const Eigen::Isometry3d palm = world.cache.framePose(world.link("palm"));
  const Eigen::Vector3d ahead = world.sensed.contacts[0].point_W - palm.translation(), forward = palm.linear().col(2);
  const double angle = std::atan2(heading.y(), heading.x()) - std::atan2(forward.y(), forward.x());
  const Eigen::Vector3d place = next->position_W + Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * ahead;
  EXPECT_NEAR((place - centre).norm(), radius, 0.01);
  // Known is a patch about (0, −0.25, 1): the place lies outwards of its middle.
  const Eigen::Vector3d out = place - (centre + radius * Eigen::Vector3d(0, -0.25, 1).normalized());
  EXPECT_GT(heading.dot(out.normalized()), 0.5);
}

TEST_F(SurfaceMapTest, WhereTheProcessIsSureItStillGoesWhereNoTouchWas) {
  // Sure of everything: nothing is left to know, unless a touch must have been near.
  for (const bool asks : {false, true}) {
    world.touch = world.registry.makeSignal(world.context(touch_values));
    if (asks) make({{"known", "1"}, {"step", "0.03"}, {"met-within", "0.01"}});
    else make({{"known", "1"}, {"step", "0.03"}});
    std::vector<Eigen::Vector3d> touched;
    for (double x = -0.25; x <= 0.3; x += 0.25)
      for (double y = -0.25; y <= 0.3; y += 0.25) {
        touch({x, y, 1});
        touched.push_back(world.sensed.contacts[0].point_W);
      }
    tick(1000);
    ASSERT_EQ(next->known, asks);
    if (!asks) continue;
    const Eigen::Vector3d palm = world.cache.framePose(world.link("palm")).translation();
    const Eigen::Vector3d place = next->position_W + touched.back() - palm;
    EXPECT_NEAR((place - centre).norm(), radius, 0.01);
    for (const Eigen::Vector3d& point : touched) EXPECT_GT((place - point).norm(), 0.01);
  }
}

TEST_F(SurfaceMapTest, GivesUpAPlaceThatItDoesNotComeNearTo) {
  touch({0, 0, 1});
  touch({0.3, 0, 1});
  tick(500);
  ASSERT_TRUE(next->known);
  const Eigen::Vector3d first = next->position_W;
  tick(2100);
  EXPECT_GE(metric("places_given_up"), 1) << "2 s without progress";
  tick(500);
  if (next->known) {
    EXPECT_GT((next->position_W - first).norm(), 0.02) << "another place";
  }
}

}  // namespace
}  // namespace tactus::exploration
