// The signal `contacts`: sets, hysteresis, means, and what is remembered.

#include <gtest/gtest.h>

#include "tests/tasks/task_world.h"

namespace tactus::test {
namespace {

using control::ContactSet;
using control::MissingSet;
using control::TouchedPoints;

const Eigen::Vector3d kDown(0, 0, -1);

class ContactsSignal : public ::testing::Test {
 protected:
  TaskWorld world;
  void makeTouch(Attributes attributes) {
    attributes.insert({"name", "touch"});
    values = control::makeValues(*world.registry.elements().find("contacts"), attributes);
    world.touch = world.registry.makeSignal(world.context(values));
  }
  void step() {
    world.sensed.time += world.dt;
    world.feel();
  }
  control::ElementValues values;
};

TEST_F(ContactsSignal, SortsContactsIntoHeldUndesiredAndMissing) {
  world.sensed.contacts = {world.contactOn("palm", kDown, 1), world.contactOn("index_distal", kDown, 0.5),
                           world.contactOn("thumb_distal", kDown, 0.3)};
  world.feel();
  ASSERT_EQ(port<ContactSet>(world, "held").contacts.size(), 1u);
  EXPECT_EQ(port<ContactSet>(world, "held").contacts[0].frame, world.link("index_distal"));
  EXPECT_EQ(port<ContactSet>(world, "undesired").contacts.size(), 2u);
  EXPECT_EQ(port<ContactSet>(world, "all").contacts.size(), 3u);
  EXPECT_EQ(port<MissingSet>(world, "missing").points.size(), 8u);
}

TEST_F(ContactsSignal, OneContactALinkIsTheForceWeightedMean) {
  control::ContactRecord a = world.contactOn("index_distal", kDown, 1);
  control::ContactRecord b = a;
  b.force_N = 3;
  b.point_W = a.point_W + Eigen::Vector3d(0.004, 0, 0);
  b.normal_W = Eigen::Vector3d(1, 0, 0);
  world.sensed.contacts = {a, b};
  world.feel();
  const control::Contact& contact = port<ContactSet>(world, "held").contacts.at(0);
  EXPECT_NEAR(contact.force_N, 4, 1e-12);
  EXPECT_NEAR((contact.point_W - a.point_W).x(), 0.003, 1e-12);
  const Eigen::Vector3d expected = Eigen::Vector3d(3, 0, -1).normalized();
  EXPECT_LT((contact.normal_W - expected).norm(), 1e-12);
}

/// Records of one link at these places along it.
std::vector<control::ContactRecord> along(TaskWorld& world, const std::vector<std::pair<double, double>>& at_and_force) {
  std::vector<control::ContactRecord> records;
  for (const auto& [at, force] : at_and_force) {
    control::ContactRecord record = world.contactOn("index_proximal", kDown, force);
    record.point_W = world.cache.framePose(record.link) * Eigen::Vector3d(0, 0, at);
    records.push_back(record);
  }
  return records;
}

TEST_F(ContactsSignal, SeveralContactsALinkAreThoseThatAreApart) {
  makeTouch({{"desired", "fingers"}, {"hold", "0"}, {"per-link", "3"}, {"apart", "0.01"}});
  world.sensed.contacts = along(world, {{0, 1}, {0.004, 3}, {0.03, 0.5}});
  step();
  const ContactSet& held = port<ContactSet>(world, "held");
  ASSERT_EQ(held.contacts.size(), 2u);
  EXPECT_EQ(held.per_link, 3);
  EXPECT_EQ(held.capacity, 27);
  EXPECT_NEAR(held.contacts[0].force_N, 4, 1e-12);
  EXPECT_NEAR((held.contacts[0].point_W - world.sensed.contacts[0].point_W).norm(), 0.003, 1e-12) << "weighted by force";
  EXPECT_NEAR(held.contacts[1].force_N, 0.5, 1e-12);
  EXPECT_EQ(held.contacts[0].frame, held.contacts[1].frame);
  EXPECT_EQ(port<double>(world, "touching"), 1) << "links, not contacts";
  EXPECT_EQ(port<MissingSet>(world, "missing").points.size(), 8u);

  // What is left of them keeps its number, whatever the order of the records, and moves with its touch.
  world.sensed.contacts = along(world, {{0.033, 0.5}});
  step();
  ASSERT_EQ(held.contacts.size(), 1u);
  EXPECT_EQ(held.contacts[0].number, 1);
  world.sensed.contacts = along(world, {{0.033, 0.5}, {0, 1}});
  step();
  ASSERT_EQ(held.contacts.size(), 2u);
  EXPECT_EQ(held.contacts[0].number, 0);
  EXPECT_NEAR(held.contacts[0].force_N, 1, 1e-12);
  EXPECT_NEAR(held.contacts[1].force_N, 0.5, 1e-12);
}

TEST_F(ContactsSignal, MoreTouchesThanPlacesJoinTheNearest) {
  makeTouch({{"desired", "fingers"}, {"hold", "0"}, {"per-link", "2"}, {"apart", "0.005"}});
  world.sensed.contacts = along(world, {{0, 1}, {0.03, 1}, {0.022, 2}});
  step();
  const ContactSet& held = port<ContactSet>(world, "held");
  ASSERT_EQ(held.contacts.size(), 2u);
  EXPECT_NEAR(held.contacts[0].force_N, 1, 1e-12);
  EXPECT_NEAR(held.contacts[1].force_N, 3, 1e-12);
}

TEST_F(ContactsSignal, EachContactOfALinkWaitsForItsOwnHold) {
  makeTouch({{"desired", "fingers"}, {"hold", "0.005"}, {"per-link", "2"}, {"apart", "0.01"}});
  world.sensed.contacts = along(world, {{0, 1}});
  for (int k = 0; k < 4; ++k) step();
  world.sensed.contacts = along(world, {{0, 1}, {0.03, 1}});
  for (int k = 0; k < 4; ++k) step();
  const ContactSet& held = port<ContactSet>(world, "held");
  ASSERT_EQ(held.contacts.size(), 1u);
  EXPECT_EQ(held.contacts[0].number, 0);
  for (int k = 0; k < 2; ++k) step();
  EXPECT_EQ(held.contacts.size(), 2u);
}

TEST_F(ContactsSignal, TheRobotOnItselfIsInNoSet) {
  control::ContactRecord of_self = world.contactOn("index_distal", kDown, 2);
  of_self.object = -1;
  of_self.other_link = world.link("thumb_distal");
  world.sensed.contacts = {of_self};
  world.feel();
  EXPECT_TRUE(port<ContactSet>(world, "all").contacts.empty());
  EXPECT_TRUE(port<control::TouchedPoints>(world, "points").points.empty());
  EXPECT_EQ(port<MissingSet>(world, "missing").points.size(), 9u) << "the finger still looks for the world";
  EXPECT_EQ(port<double>(world, "touching"), 0);
  EXPECT_EQ(port<double>(world, "self"), 1);

  // Beside a touch of the world on the same link, which stays what it is.
  const control::ContactRecord of_world = world.contactOn("index_distal", kDown, 0.5);
  world.sensed.contacts = {of_self, of_world};
  world.feel();
  ASSERT_EQ(port<ContactSet>(world, "held").contacts.size(), 1u);
  EXPECT_EQ(port<ContactSet>(world, "held").contacts[0].force_N, 0.5);
  world.sensed.contacts.clear();
  world.feel();
  EXPECT_EQ(port<double>(world, "self"), 0);
}

TEST_F(ContactsSignal, AChangeMustLastToCount) {
  makeTouch({{"desired", "fingers"}, {"on-force", "0.05"}, {"off-force", "0.02"}, {"hold", "0.005"}});
  const control::ContactRecord touch = world.contactOn("ring_medial", kDown, 0.06);
  world.sensed.contacts = {touch};
  for (int k = 0; k < 5; ++k) step();
  EXPECT_EQ(port<ContactSet>(world, "held").contacts.size(), 0u) << "on for 4 ms only";
  step();
  EXPECT_EQ(port<ContactSet>(world, "held").contacts.size(), 1u);

  // Between the two thresholds nothing changes, however long.
  world.sensed.contacts[0].force_N = 0.03;
  for (int k = 0; k < 50; ++k) step();
  EXPECT_EQ(port<ContactSet>(world, "held").contacts.size(), 1u);

  // A gap shorter than `hold` is bridged by the last contact, moving with the link.
  world.sensed.contacts.clear();
  for (int k = 0; k < 5; ++k) step();
  ASSERT_EQ(port<ContactSet>(world, "held").contacts.size(), 1u);
  EXPECT_LT((port<ContactSet>(world, "held").contacts[0].point_W - touch.point_W).norm(), 1e-12);
  EXPECT_EQ(port<ContactSet>(world, "held").contacts[0].force_N, 0);
  step();
  EXPECT_EQ(port<ContactSet>(world, "held").contacts.size(), 0u);
}

TEST_F(ContactsSignal, AContactThatFlickersEveryTickStaysAsItIs) {
  makeTouch({{"desired", "fingers"}});
  const control::ContactRecord touch = world.contactOn("ring_medial", kDown, 1);
  const auto flicker = [&](int ticks_on, int ticks_off, int ticks) {
    int switches = 0;
    for (int k = 0; k < ticks; ++k) {
      const std::size_t before = port<ContactSet>(world, "held").contacts.size();
      world.sensed.contacts.clear();
      if (k % (ticks_on + ticks_off) < ticks_on) world.sensed.contacts.push_back(touch);
      step();
      switches += port<ContactSet>(world, "held").contacts.size() != before;
    }
    return switches;
  };
  EXPECT_EQ(flicker(1, 1, 1000), 0);
  EXPECT_EQ(flicker(10, 0, 10), 1) << "a touch that lasts counts";
  EXPECT_EQ(port<double>(world, "touching"), 1);
  EXPECT_EQ(flicker(1, 1, 1000), 0);
  EXPECT_EQ(flicker(1, 4, 1000), 0);
  // However it flickers, a link comes or goes at most once in `hold`, 5 ms.
  for (int on = 1; on < 12; ++on)
    for (int off = 1; off < 12; ++off) EXPECT_LE(flicker(on, off, 1000), 1000 / 5) << on << " " << off;
}

TEST_F(ContactsSignal, LinksWithoutSkinFeelNothing) {
  world.sensed.contacts = {world.contactOn("lwr_2", kDown, 5)};
  world.feel();
  EXPECT_TRUE(port<ContactSet>(world, "all").contacts.empty());
  EXPECT_TRUE(port<TouchedPoints>(world, "points").points.empty());
}

TEST_F(ContactsSignal, PointsAreRememberedOncePerSpacing) {
  control::ContactRecord touch = world.contactOn("middle_distal", kDown, 0.5);
  world.sensed.contacts = {touch};
  for (int k = 0; k < 10; ++k) step();
  EXPECT_EQ(port<TouchedPoints>(world, "points").points.size(), 1u);
  world.sensed.contacts[0].point_W.x() += 0.0019;
  step();
  EXPECT_EQ(port<TouchedPoints>(world, "points").points.size(), 1u);
  world.sensed.contacts[0].point_W.x() += 0.0002;
  step();
  EXPECT_EQ(port<TouchedPoints>(world, "points").points.size(), 2u);
}

TEST_F(ContactsSignal, MissingPointsAreTheMiddlesOfTheLinks) {
  world.feel();
  for (const control::MissingContact& missing : port<MissingSet>(world, "missing").points) {
    const auto& shape = std::get<description::CapsuleShape>(world.robot.links[missing.frame].shapes.at(0));
    const Eigen::Vector3d middle = world.cache.framePose(missing.frame) * Eigen::Vector3d(0.5 * (shape.from + shape.to));
    EXPECT_LT((missing.point_W - middle).norm(), 1e-12);
  }
}

TEST_F(ContactsSignal, RefusesThresholdsTheWrongWayRound) {
  try {
    makeTouch({{"desired", "fingers"}, {"on-force", "0.02"}, {"off-force", "0.05"}});
    FAIL();
  } catch (const control::ElementError& error) {
    EXPECT_EQ(error.attribute, "off-force");
    EXPECT_STREQ(error.what(), "off-force must not be greater than on-force");
  }
}

TEST_F(ContactsSignal, RefusesDesiredLinksWithoutSkin) {
  try {
    makeTouch({{"desired", "lwr_2"}});
    FAIL();
  } catch (const control::ElementError& error) {
    EXPECT_EQ(error.attribute, "desired");
    EXPECT_STREQ(error.what(), "link 'lwr_2' has no skin, so it cannot be desired to touch");
  }
}

}  // namespace
}  // namespace tactus::test
