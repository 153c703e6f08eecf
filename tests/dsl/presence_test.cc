// Rules between attributes of one element, as the table declares them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dsl/element_text.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using control::Presence;
using control::ValueType;
using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> errors(Presence kind, const std::string& given) {
  control::Registry registry = makeRegistry();
  registry.addTask({.name = "test.pair",
                    .description = "A task of the tests.",
                    .attributes = {{.name = "x", .type = ValueType::real},
                                   {.name = "y", .type = ValueType::real},
                                   {.name = "z", .type = ValueType::real, .default_text = "1"}},
                    .presence = {{kind, {"x", "y", "z"}}}},
                   [](const control::BuildContext&) { return nullptr; });
  std::vector<std::string> found;
  try {
    dsl::readStack(writeFile("stack.xml", smallStack("<defaults class=\"c\"><test.pair y=\"2\"/></defaults>"
                                                     "<level priority=\"1\"><test.pair name=\"p\" " + given + "/></level>")),
                   registry, readOptions());
  } catch (const dsl::InvalidStack& invalid) {
    for (const auto& diagnostic : invalid.diagnostics) found.push_back(diagnostic.code + " " + diagnostic.message);
  }
  return found;
}

TEST(Presence, AtMostOne) {
  EXPECT_THAT(errors(Presence::exclusive, ""), IsEmpty()) << "what the table gives does not count";
  EXPECT_THAT(errors(Presence::exclusive, "x=\"1\""), IsEmpty());
  EXPECT_THAT(errors(Presence::exclusive, "x=\"1\" y=\"1\""), ElementsAre("E022 <test.pair> takes at most one of 'x', 'y', 'z'"));
  EXPECT_THAT(errors(Presence::exclusive, "x=\"1\" class=\"c\""), ElementsAre("E022 <test.pair> takes at most one of 'x', 'y', 'z'"))
      << "what a class gives does count";
}

TEST(Presence, AllOrNone) {
  EXPECT_THAT(errors(Presence::together, ""), IsEmpty());
  EXPECT_THAT(errors(Presence::together, "x=\"1\" y=\"1\" z=\"1\""), IsEmpty());
  EXPECT_THAT(errors(Presence::together, "x=\"1\" z=\"1\""),
              ElementsAre("E022 <test.pair> takes 'x', 'y', 'z' together: 'y' is missing"));
}

TEST(Presence, AtLeastOneAndExactlyOne) {
  EXPECT_THAT(errors(Presence::any_of, ""), ElementsAre("E013 <test.pair> needs at least one of 'x', 'y', 'z'"));
  EXPECT_THAT(errors(Presence::any_of, "x=\"1\" y=\"1\""), IsEmpty());
  EXPECT_THAT(errors(Presence::one_of, ""), ElementsAre("E013 <test.pair> needs one of 'x', 'y', 'z'"));
  EXPECT_THAT(errors(Presence::one_of, "y=\"1\""), IsEmpty());
  EXPECT_THAT(errors(Presence::one_of, "x=\"1\" y=\"1\""), ElementsAre("E022 <test.pair> takes only one of 'x', 'y', 'z'"));
}

TEST(Presence, OneNeedsOthers) {
  EXPECT_THAT(errors(Presence::needs, "y=\"1\""), IsEmpty());
  EXPECT_THAT(errors(Presence::needs, "x=\"1\" y=\"1\""), ElementsAre("E022 'x' needs 'z', too"));
  EXPECT_THAT(errors(Presence::needs, "x=\"1\" y=\"1\" z=\"1\""), IsEmpty());
}

TEST(Presence, IsSaidInWords) {
  EXPECT_EQ(dsl::presenceText({Presence::any_of, {"lower", "upper"}}), "at least one of 'lower', 'upper'");
  EXPECT_EQ(dsl::presenceText({Presence::needs, {"x", "y"}}), "'x' needs 'y', too");
}

}  // namespace
}  // namespace tactus::dsl_test
