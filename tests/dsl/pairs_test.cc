// Materials of pairs and links that touch each other, as a stack says them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dsl/read_stack.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using description::ContactMaterial;
using description::Party;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string things =
    "<object name=\"can\" mobility=\"free\" mass=\"0.3\"><sphere radius=\"0.03\"/></object>"
    "<object name=\"table\"><plane/></object><object name=\"wall\" mobility=\"moved\"><box size=\"1 1 1\"/></object>\n";

std::string stackOf(const std::string& pairs, const std::string& self_contact = "none") {
  return "<stack format=\"1\"><robot model=\"lwr_allegro\" self-contact=\"" + self_contact + "\"/>\n<scene>" + things +
         pairs +
         "</scene>\n<level priority=\"1\"><test.pull name=\"p\"/></level><controller backend=\"first\"/></stack>";
}

dsl::Stack read(const std::string& pairs, const std::string& self_contact = "none") {
  static control::Registry registry = makeRegistry();
  return dsl::readStack(writeFile("stack.xml", stackOf(pairs, self_contact)), registry, readOptions());
}

std::vector<std::string> errors(const std::string& pairs, const std::string& self_contact = "none") {
  std::vector<std::string> found;
  try {
    read(pairs, self_contact);
  } catch (const dsl::InvalidStack& invalid) {
    for (const auto& diagnostic : invalid.diagnostics)
      found.push_back(std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " +
                      diagnostic.code + " " + diagnostic.message +
                      (diagnostic.suggestion.empty() ? "" : " (" + diagnostic.suggestion + "?)"));
  }
  return found;
}

ContactMaterial materialOf(const dsl::Stack& stack, const Party& one, const Party& other) {
  return description::materialOf(stack.scene(1), one, other, {});
}

TEST(Pairs, SayWhatHoldsBetweenTwoObjects) {
  const dsl::Stack stack = read(
      "<pair between=\"table can\" friction=\"0.7\" stiffness=\"900\" dissipation=\"1.5\" rolling=\"0.001\"/>");
  const ContactMaterial material = materialOf(stack, {.object = 0}, {.object = 1});
  EXPECT_EQ(material.friction, 0.7);
  EXPECT_EQ(material.stiffness, 900);
  EXPECT_EQ(material.dissipation, 1.5);
  EXPECT_EQ(material.rolling, 0.001);
  EXPECT_EQ(materialOf(stack, {.object = 0}, {.object = 2}).friction, ContactMaterial().friction);
}

TEST(Pairs, OfALinkGoBeforeThoseOfItsGroupAndTheRobot) {
  const dsl::Stack stack = read(
      "<pair between=\"index_distal can\" friction=\"0.9\"/><pair between=\"can robot\" friction=\"0.3\" "
      "stiffness=\"800\"/>"
      "<pair between=\"fingers can\" friction=\"0.6\"/>");
  const auto on = [&](const char* link) {
    return materialOf(stack, {.link = stack.robot.linkIndex(link)}, {.object = 0});
  };
  EXPECT_EQ(on("palm").friction, 0.3);
  EXPECT_EQ(on("ring_medial").friction, 0.6);
  EXPECT_EQ(on("index_distal").friction, 0.9);
  EXPECT_EQ(on("index_distal").stiffness, 800) << "which the closer ones do not say";
}

TEST(Pairs, OfLinksThatTouchEachOther) {
  const dsl::Stack stack =
      read("<pair between=\"robot robot\" friction=\"0.1\"/><pair between=\"thumb index_distal\" friction=\"0.8\"/>",
           "hand");
  const auto between = [&](const char* one, const char* other) {
    return materialOf(stack, {.link = stack.robot.linkIndex(one)}, {.link = stack.robot.linkIndex(other)}).friction;
  };
  EXPECT_EQ(between("index_distal", "middle_distal"), 0.1);
  EXPECT_EQ(between("index_distal", "thumb_distal"), 0.8);
  EXPECT_EQ(between("thumb_distal", "index_distal"), 0.8);
}

TEST(Pairs, ThatMakeNoSenseAreRefused) {
  EXPECT_THAT(errors("<pair between=\"can tabel\" friction=\"1\"/>"),
              ElementsAre("3:20 E032 neither the scene has an object nor the robot a link or group 'tabel' (table?)"));
  EXPECT_THAT(errors("<pair between=\"can index_distl\" friction=\"1\"/>"), ElementsAre(HasSubstr("(index_distal?)")));
  EXPECT_THAT(errors("<pair between=\"can\" friction=\"1\"/>"),
              ElementsAre("3:16 E014 attribute 'between': expected two names, found 1"));
  EXPECT_THAT(errors("<pair between=\"can table\"/>"), ElementsAre(HasSubstr("E013 <pair> needs at least one of")));
  EXPECT_THAT(errors("<pair between=\"can table\" friction=\"-1\"/>"), ElementsAre(HasSubstr("E014")));
  EXPECT_THAT(errors("<pair between=\"can table\" friction=\"1\"/>\n<pair between=\"table can\" rolling=\"1\"/>"),
              ElementsAre("4:16 E058 the material of 'table' and 'can' is given in line 3 already"));
  EXPECT_THAT(errors("<pair between=\"can fingers\" friction=\"1\"/>\n<pair between=\"can hand\" rolling=\"1\"/>"),
              ElementsAre("4:16 E058 the material of 'can' and 'index_proximal' is given in line 3 already"));
  EXPECT_THAT(errors("<pair between=\"table wall\" friction=\"1\"/>"),
              ElementsAre("3:16 E057 'table' and 'wall' never touch: no force moves either of them"));
  EXPECT_THAT(errors("<pair between=\"can can\" friction=\"1\"/>"),
              ElementsAre("3:16 E057 'can' and 'can' never touch: an object does not touch itself"));
  EXPECT_THAT(errors("<pair between=\"robot robot\" friction=\"1\"/>"),
              ElementsAre(HasSubstr("E057 'robot' and 'robot' never")));
  EXPECT_THAT(errors("<pair between=\"index_medial index_distal\" friction=\"1\"/>", "all"),
              ElementsAre(HasSubstr("E057 'index_medial' and 'index_distal' never touch: these links pass")));
}

TEST(Pairs, OfLinksThatTouchNoObjectAreRefused) {
  EXPECT_THAT(errors("<pair between=\"index_tip can\" friction=\"1\"/>"),
              ElementsAre("3:16 E057 'index_tip' and 'can' never touch: link 'index_tip' has no shape"));
  EXPECT_THAT(errors("<pair between=\"can lwr_base\" friction=\"1\"/>"),
              ElementsAre(HasSubstr("never touch: link 'lwr_base' ")));
  EXPECT_THAT(errors("<pair between=\"can hand\" friction=\"1\"/>"), ElementsAre()) << "some of its links do";
}

TEST(Pairs, AreWrittenAndReadBack) {
  control::Registry registry = makeRegistry();
  const std::string once = dsl::writeResolved(read("<pair between=\"can  hand\" friction=\"0.5\"/>", "thumb  fingers"));
  EXPECT_THAT(once, HasSubstr(" self-contact=\"thumb fingers\""));
  EXPECT_THAT(once, HasSubstr("<pair between=\"can  hand\" friction=\"0.5\"/>"));
  EXPECT_EQ(dsl::writeResolved(dsl::readStack(writeFile("again.xml", once), registry, readOptions())), once);
}

TEST(SelfContactOfAStack, IsNoneUnlessAskedFor) {
  EXPECT_TRUE(read("").robot.self_contact.empty());
  const dsl::Stack fingers = read("", "fingers");
  EXPECT_FALSE(fingers.robot.self_contact.empty());
  for (const description::LinkPair& pair : fingers.robot.self_contact)
    for (const int link : {pair.one, pair.other})
      EXPECT_THAT(fingers.robot.links[static_cast<std::size_t>(link)].name,
                  testing::MatchesRegex("(index|middle|ring)_(proximal|medial|distal)"));
  EXPECT_GT(read("", "all").robot.self_contact.size(), read("", "hand").robot.self_contact.size());
  EXPECT_EQ(read("", "index_distal thumb_distal").robot.self_contact.size(), 1u);
}

TEST(SelfContactOfAStack, OfUnknownLinksIsRefused) {
  EXPECT_THAT(errors("", "hnad"),
              ElementsAre(HasSubstr("E030 the robot has no link or group of links 'hnad' (hand?)")));
  EXPECT_THAT(errors("", "all palm"), ElementsAre(HasSubstr("E014 'all' stands alone")));
}

TEST(Holders, LetGoOfWhatTheyHoldOnly) {
  const auto object = [](const std::string& mobility) {
    return "<object name=\"o\" mobility=\"" + mobility +
           "\" mass=\"1\" hold-until=\"2.5\"><sphere radius=\"1\"/></object>";
  };
  EXPECT_EQ(read(object("held")).objects[3].object.holder.until, 2.5);
  EXPECT_THAT(errors(object("free")),
              ElementsAre(HasSubstr("E022 attribute 'hold-until': a free object is held by nothing")));
}

}  // namespace
}  // namespace tactus::dsl_test
