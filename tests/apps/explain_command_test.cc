#include <gmock/gmock.h>

#include <set>

#include "tests/apps/program.h"

namespace tactus::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(ExplainCommand, TellsEverythingOfAnAttribute) {
  const Outcome outcome = tactus({"explain", "posture"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("<posture>: Springs and dampers on joints"), HasSubstr("source: thesis 4.3.1"),
                    HasSubstr("  stiffness: numbers; N m/rad; ≥ 0; default 1\n      k; one number, or one a joint.\n"),
                    HasSubstr("  joints: joints or groups; or free; required\n"),
                    HasSubstr("  on: port of type contact-set; default touch.all\n")));
}

TEST(ExplainCommand, TellsPortsChildrenAndChoices) {
  EXPECT_THAT(tactus({"explain", "contacts"}).out, HasSubstr("  held: contact-set\n      Contacts on desired links"));
  EXPECT_THAT(tactus({"explain", "level"}).out, HasSubstr("children\n  any task (at least 1)\n"));
  EXPECT_THAT(tactus({"explain", "record"}).out, HasSubstr("columns: choice; one of default | all; default default"));
  EXPECT_THAT(tactus({"explain", "controller"}).out, HasSubstr("and the options of the back end that `backend` names"));
  EXPECT_THAT(tactus({"explain", "null-space"}).out,
              AllOf(HasSubstr("backend=\"null-space\": "), HasSubstr("projection: choice; one of successive | augmented")));
}

TEST(ExplainCommand, JsonHoldsTheSame) {
  const nlohmann::json json = tactus({"explain", "contact-force", "--json"}).json()["elements"].at(0);
  EXPECT_EQ(json["kind"], "task");
  for (const nlohmann::json& attribute : json["attributes"]) {
    if (attribute["name"] != "force") continue;
    EXPECT_EQ(attribute["unit"], "N");
    EXPECT_EQ(attribute["default"], "0.5");
    EXPECT_EQ(attribute["required"], false);
    return;
  }
  FAIL() << json;
}

TEST(ExplainCommand, EveryElementOfTheListIsExplained) {
  const Outcome list = tactus({"explain", "--json"});
  ASSERT_EQ(list.exit_code, 0) << list.err;
  std::set<std::string> kinds;
  const nlohmann::json elements = list.json()["elements"];
  for (const nlohmann::json& element : elements) {
    kinds.insert(element["kind"]);
    const std::string name = element["name"];
    const Outcome outcome = tactus({"explain", name});
    EXPECT_EQ(outcome.exit_code, 0) << name;
    EXPECT_THAT(outcome.out, HasSubstr(element["description"].get<std::string>()));
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"back-end", "shape", "signal", "structure", "task"}));
  EXPECT_THAT(tactus({"explain"}).out, AllOf(HasSubstr("tasks, in <level>\n"), HasSubstr("\n  qp: ")));
}

TEST(ExplainCommand, PluginsElementsToo) {
  EXPECT_EQ(tactus({"explain", "naughty.task"}).exit_code, 2);
  const std::string plugin = std::string(TEST_PLUGINS) + "/naughty.so";
  EXPECT_THAT(tactus({"explain", "naughty.task", "--plugin", plugin}).out, HasSubstr("<naughty.task>: Goes wrong."));
}

TEST(ExplainCommand, UnknownNameTellsTheNearest) {
  const Outcome outcome = tactus({"explain", "impedence"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_EQ(outcome.err, "tactus: nothing is called 'impedence'; did you mean 'impedance'?\n");
  EXPECT_THAT(tactus({"explain", "zzzzzz"}).err,
              HasSubstr("nothing is called 'zzzzzz'; 'tactus explain' lists what there is"));
}

}  // namespace
}  // namespace tactus::testing
