// Objects that move, as a stack says them: mass, holder, path; what makes no sense is refused at its place.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dsl/read_stack.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using description::Mobility;
using Eigen::Vector3d;
using testing::ElementsAre;

std::string with(const std::string& object) {
  return smallStack("<scene>\n" + object + "</scene><level priority=\"1\"><test.pull name=\"p\"/></level>");
}

dsl::Stack read(const std::string& object) {
  static control::Registry registry = makeRegistry();
  return dsl::readStack(writeFile("stack.xml", with(object)), registry, readOptions());
}

std::vector<std::string> errors(const std::string& object) {
  std::vector<std::string> found;
  try {
    read(object);
  } catch (const dsl::InvalidStack& invalid) {
    for (const auto& diagnostic : invalid.diagnostics)
      found.push_back(std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " +
                      diagnostic.code + " " + diagnostic.message);
  }
  return found;
}

TEST(Objects, WithoutAMobilityStay) { EXPECT_EQ(read("<object name=\"o\"><plane/></object>").objects[0].object.mobility, Mobility::fixed); }

TEST(Objects, ThatForcesMoveWeighAsMuchAsASolidOfTheirShapes) {
  const description::Object ball =
      read("<object name=\"o\" mobility=\"free\" mass=\"0.5\"><sphere radius=\"0.03\" pose=\"0.1 0 0\"/></object>").objects[0].object;
  EXPECT_EQ(ball.mobility, Mobility::free);
  EXPECT_EQ(ball.mass.mass, 0.5);
  EXPECT_LT((ball.mass.centre - Vector3d(0.1, 0, 0)).norm(), 1e-4);
  EXPECT_NEAR(ball.mass.inertia(0, 0), 0.4 * 0.5 * 9e-4, 0.02 * 0.4 * 0.5 * 9e-4);
}

TEST(Objects, WeighWhatTheyAreSaidTo) {
  const description::Object ball =
      read("<object name=\"o\" mobility=\"free\" mass=\"0.5\" centre=\"0 0 0.01\" inertia=\"0.002 0.003 0.004\">"
           "<sphere radius=\"0.03\"/></object>").objects[0].object;
  EXPECT_EQ(ball.mass.centre, Vector3d(0, 0, 0.01));
  EXPECT_EQ(ball.mass.inertia.diagonal(), Vector3d(0.002, 0.003, 0.004));
}

TEST(Objects, FollowPathsFromWhereTheyAre) {
  const dsl::Stack stack = read("<object name=\"o\" mobility=\"moved\" pose=\"1 0 0 0 0 1.5707963267948966\" jitter=\"0.1 0 0\">"
                                "<box size=\"1 1 1\"/><at time=\"2\" by=\"0 0 0.5\"/><at time=\"3\" by=\"0 0 0.5 0 0 1\"/></object>");
  const std::vector<description::Waypoint>& path = stack.objects[0].object.path;
  ASSERT_EQ(path.size(), 3u);
  EXPECT_EQ(path[0].pose.translation(), Vector3d(1, 0, 0));
  EXPECT_EQ(path[1].pose.translation(), Vector3d(1, 0, 0.5));
  EXPECT_LT((path[2].pose.linear() * Vector3d::UnitX() - Vector3d(std::cos(1 + M_PI / 2), std::sin(1 + M_PI / 2), 0)).norm(), 1e-12);
  const description::Object drawn = stack.scene(3).objects[0];
  EXPECT_NE(drawn.pose.translation().x(), 1);
  EXPECT_EQ(drawn.path[1].pose.translation().x(), drawn.pose.translation().x()) << "the path moves along with the draw";
}

TEST(Objects, ThatMakeNoSenseAreRefused) {
  const auto held = [](const std::string& inside) {
    return errors("<object name=\"o\" mobility=\"held\" mass=\"1\">\n<sphere radius=\"1\"/>" + inside + "</object>");
  };
  EXPECT_THAT(errors("<object name=\"o\" mobility=\"free\"><sphere radius=\"1\"/></object>"),
              ElementsAre("4:1 E013 a free object needs the attribute 'mass'"));
  EXPECT_THAT(errors("<object name=\"o\"><sphere radius=\"1\"/>\n<at time=\"1\" by=\"0 0 0\"/></object>"),
              ElementsAre("5:1 E015 a fixed object follows no path"));
  EXPECT_THAT(held("<at time=\"1\" by=\"0 0 0\"/>\n<at time=\"1\" by=\"0 0 0\"/>"),
              ElementsAre("6:11 E014 attribute 'time': the times of a path rise, and this one is not after 1 s"));
  EXPECT_THAT(held("\n<at time=\"1\" by=\"0 0\"/>"),
              ElementsAre("6:18 E014 attribute 'by': expected 3 numbers (x y z) or 6 (x y z roll pitch yaw), found 2"));
  EXPECT_THAT(errors("<object name=\"o\" mobility=\"free\" mass=\"1\" centre=\"0 0 0\"\ninertia=\"1 1 3\"><sphere radius=\"1\"/></object>"),
              ElementsAre("5:10 E014 attribute 'inertia': no body has one that is larger than the other two together"));
  EXPECT_THAT(errors("<object name=\"o\" mobility=\"free\" mass=\"1\" centre=\"0 0 0\"><sphere radius=\"1\"/></object>"),
              ElementsAre(testing::HasSubstr("E022")));
}

TEST(Objects, AreWrittenAndReadBack) {
  control::Registry registry = makeRegistry();
  const std::string once = dsl::writeResolved(
      read("<object name=\"o\" mobility=\"held\" mass=\"0.2\"><sphere radius=\"0.03\"/><at time=\"2\" by=\"0 0 0.5\"/></object>"));
  EXPECT_THAT(once, testing::HasSubstr("<at time=\"2\" by=\"0 0 0.5\"/>"));
  EXPECT_EQ(dsl::writeResolved(dsl::readStack(writeFile("again.xml", once), registry, readOptions())), once);
}

}  // namespace
}  // namespace tactus::dsl_test
