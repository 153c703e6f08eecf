#include <gmock/gmock.h>

#include <map>
#include <set>

#include "framework/runtime/file_error.h"
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
  EXPECT_THAT(tactus({"explain", "level"}).out, HasSubstr("children\n  any task\n  any controller (at most 1)\n"));
  EXPECT_THAT(tactus({"explain", "record"}).out, HasSubstr("columns: choice; one of default | all; default default"));
  EXPECT_THAT(tactus({"explain", "controller"}).out, HasSubstr("and the options of the back end that `backend` names"));
  EXPECT_THAT(tactus({"explain", "null-space"}).out,
              AllOf(HasSubstr("backend=\"null-space\": "), HasSubstr("projection: choice; one of successive | augmented")));
}

TEST(ExplainCommand, TellsWhichLinksDoNotTouchEachOther) {
  const TemporaryFolder folder;
  const std::string text =
      "<stack format=\"1\"><robot model=\"lwr_allegro\" self-contact=\"palm index_base index_distal thumb_distal\"/>"
      "<level priority=\"1\"><posture name=\"p\" joints=\"arm\"/></level><controller backend=\"null-space\"/></stack>";
  const std::string stack = folder.write("stack.xml", text);
  const Outcome outcome = tactus({"explain", stack});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("\nself-contact: 5 pairs of links may touch; these do not:\n"
                                     "  palm and index_base: joint 'index_abduction' joins them\n"));
  const nlohmann::json json = tactus({"explain", stack, "--json"}).json()["self_contact"];
  EXPECT_EQ(json["touching"].size(), 5u);
  EXPECT_EQ(json["left_out"][0]["links"], (nlohmann::json{"palm", "index_base"}));
  EXPECT_EQ(tactus({"explain", TACTUS_SOURCE_DIR "/examples/explore_table/stack.xml"}).out.find("self-contact:"),
            std::string::npos);
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
  EXPECT_EQ(kinds, (std::set<std::string>{"back-end", "controller", "measure", "sensor", "shape", "signal", "structure",
                                          "task"})) << "no shipped part is a recorder";
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
  EXPECT_EQ(outcome.err, "tactus: no element is called 'impedence'; did you mean 'impedance'?\n");
  EXPECT_THAT(tactus({"explain", "zzzzzz"}).err,
              HasSubstr("no element is called 'zzzzzz'; 'tactus explain' lists what there is"));
}

TEST(ExplainCommand, AttributesAndPortsLeadToTheirElements) {
  EXPECT_THAT(tactus({"explain", "held"}).err,
              HasSubstr("no element is called 'held'; 'held' is a port of contacts\n"));
  EXPECT_THAT(tactus({"explain", "touch.held"}).err, HasSubstr("'held' is a port of contacts\n"));
  EXPECT_THAT(tactus({"explain", "posture.among"}).err, HasSubstr("'among' is an attribute of posture\n"));
  EXPECT_THAT(tactus({"explain", "amogn"}).err,
              HasSubstr("did you mean 'among'? 'among' is an attribute of posture\n"));
  EXPECT_THAT(tactus({"explain", "name"}).err, HasSubstr(", …\n"));
}

TEST(ExplainCommand, LongNamesStandInTheColumnsToo) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "<controller ", "<controller torque-limits-priority=\"1\" ");
  std::stringstream out(tactus({"explain", stack, "--backend", "hqp"}).out);
  std::set<size_t> value_columns, origin_columns;
  bool inside = false;
  for (std::string line; std::getline(out, line);) {
    if (line.starts_with("  <")) inside = line.starts_with("  <controller>");
    if (!inside || line.starts_with("  <")) continue;
    const size_t name = line.find_first_not_of(' '), gap = line.find("  ", name);
    const size_t value = line.find_first_not_of(' ', gap), end = line.find("  ", value);
    value_columns.insert(value);
    origin_columns.insert(line.find_first_not_of(' ', end));
  }
  EXPECT_EQ(value_columns.size(), 1u);
  EXPECT_EQ(origin_columns.size(), 1u);
}

/// Values of the stack, with who gave them: attribute, class, --set or the table.
TEST(ExplainCommand, TellsWhereAStacksValuesComeFrom) {
  const TemporaryFolder folder;
  const std::string stack = changedStack(folder, "<level priority=\"2\"><posture ",
                                         "<defaults class=\"soft\"><posture stiffness=\"3\"/></defaults>\n"
                                         "<level priority=\"2\"><posture class=\"soft\" ");
  const Outcome outcome = tactus({"explain", stack, "--set", "press=0.7"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("      force +0.7 N +--set press=0.7, .*stack.xml:12:73\n"));
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("      damping +0.4 N m s/rad +[^ ]*stack.xml:14:"));
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("    ramp +0.1 s +default\n"));
  EXPECT_THAT(outcome.out, ::testing::ContainsRegex("    projection +[a-z]+ +default\n"));

  const nlohmann::json json = tactus({"explain", stack, "--resolved", "--json"}).json();
  EXPECT_EQ(json["stack"], "press");
  std::map<std::string, std::string> origins;
  for (const nlohmann::json& element : json["elements"])
    if (element["element"] == "posture")
      for (const nlohmann::json& value : element["values"]) origins[value["name"]] = value["origin"];
  EXPECT_EQ(origins["stiffness"], "attribute") << "its own attribute goes before the class's";
  EXPECT_EQ(origins["active"], "default");
  EXPECT_EQ(tactus({"explain", "/nowhere.xml"}).exit_code, 6);
  EXPECT_EQ(tactus({"explain", "--resolved"}).exit_code, 2);
}

TEST(ExplainCommand, TellsWhatACodeMeans) {
  EXPECT_THAT(tactus({"explain", "E034"}).out, HasSubstr("E034: a port gives another type than the attribute takes\n"));
  EXPECT_EQ(tactus({"explain", "E999"}).exit_code, 2);
}

TEST(GraphCommand, DrawsInThreeForms) {
  const Outcome svg = tactus({"graph", data("press.xml")});
  ASSERT_EQ(svg.exit_code, 0) << svg.err;
  EXPECT_THAT(svg.out, AllOf(HasSubstr("<svg xmlns="), HasSubstr("touch.held (contact-set) → hold on")));
  EXPECT_THAT(tactus({"graph", data("press.xml"), "--format", "dot"}).out, HasSubstr("\"signal/touch\" -> \"task/hold\""));
  EXPECT_EQ(tactus({"graph", data("press.xml"), "--json"}).json()["edges"][0]["attribute"], "on");
  EXPECT_EQ(tactus({"graph", data("press.xml"), "--format", "png"}).exit_code, 2);
  EXPECT_EQ(tactus({"graph", data("press.xml"), "--out", "/no/where.svg"}).exit_code, 6);
  const TemporaryFolder folder;
  EXPECT_EQ(tactus({"graph", data("press.xml"), "--out", folder.file("g.dot")}).exit_code, 0);
  EXPECT_THAT(contentOf(folder.file("g.dot")), HasSubstr("digraph"));
  EXPECT_EQ(tactus({"graph", data("press.xml"), "--out", folder.file("g.png")}).exit_code, 2);
}

TEST(FormatCommand, PrintsChecksOrWrites) {
  const TemporaryFolder folder;
  const std::string file = folder.file("a.xml");
  runtime::writeFile(file, "<a><b/>\n</a>");
  EXPECT_EQ(tactus({"fmt", file}).out, "<a>\n  <b/>\n</a>\n");
  EXPECT_EQ(tactus({"fmt", "--check", file}).exit_code, 1);
  EXPECT_EQ(tactus({"fmt", "--write", file}).exit_code, 0);
  EXPECT_EQ(tactus({"fmt", "--check", file}).exit_code, 0);
  EXPECT_EQ(contentOf(file), "<a>\n  <b/>\n</a>\n");
  runtime::writeFile(file, "<a><b></a>");
  const Outcome broken = tactus({"fmt", "--write", file});
  EXPECT_EQ(broken.exit_code, 3);
  EXPECT_THAT(broken.err, HasSubstr("a.xml:1:7: error[E003]"));
  EXPECT_EQ(contentOf(file), "<a><b></a>") << "what cannot be read is not rewritten";
  EXPECT_EQ(tactus({"fmt", "/nowhere.xml"}).exit_code, 6);
}

TEST(MigrateCommand, SaysThatThereIsNothingToRewrite) {
  const Outcome outcome = tactus({"migrate", data("press.xml")});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_THAT(outcome.err, HasSubstr("press.xml: nothing to rewrite"));
  EXPECT_EQ(outcome.out, contentOf(data("press.xml"))) << "so that its output can take the file's place";
}

TEST(SchemaCommand, HasThreeForms) {
  EXPECT_THAT(tactus({"schema", "xsd"}).out, HasSubstr("<xs:element name=\"posture\">"));
  EXPECT_THAT(tactus({"schema", "md"}).out, HasSubstr("| `stiffness` | numbers | N m/rad |"));
  EXPECT_EQ(nlohmann::json::parse(tactus({"schema", "json"}).out)["format"], 1);
  EXPECT_EQ(tactus({"schema", "yaml"}).exit_code, 2);
}

}  // namespace
}  // namespace tactus::testing
