// Every file of tests/dsl/broken is refused, with this code at this place and in these words.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <ostream>

#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

struct Expected {
  std::string file;
  std::string code;
  int line;
  int column;
  std::string message;
  std::string suggestion = "";
  std::string place_file = "";                                     ///< where it is not in the stack itself
};

std::ostream& operator<<(std::ostream& out, const Expected& expected) { return out << expected.file; }

/// What reading, and if that goes well compiling, finds.
std::vector<dsl::Diagnostic> diagnose(const std::string& file) {
  control::Registry registry = makeRegistry();
  try {
    dsl::compile(dsl::readStack(file, registry, readOptions()), registry);
  } catch (const dsl::InvalidStack& invalid) {
    return invalid.diagnostics;
  }
  return {};
}

const std::string folder = testFile("broken/");

class BrokenStack : public testing::TestWithParam<Expected> {};

TEST_P(BrokenStack, IsRefusedAtItsPlace) {
  const Expected& expected = GetParam();
  const auto found = diagnose(testFile("broken/" + expected.file));
  ASSERT_EQ(found.size(), 1u) << (found.empty() ? "nothing was found" : dsl::render(found[1]));
  const dsl::Diagnostic& diagnostic = found.front();
  EXPECT_EQ(diagnostic.severity, dsl::Severity::error);
  EXPECT_EQ(diagnostic.code, expected.code);
  EXPECT_EQ(diagnostic.place.line, expected.line);
  EXPECT_EQ(diagnostic.place.column, expected.column);
  EXPECT_EQ(diagnostic.message, expected.message);
  EXPECT_EQ(diagnostic.suggestion, expected.suggestion);
  EXPECT_EQ(diagnostic.place.file,
            testFile("broken/" + (expected.place_file.empty() ? expected.file : expected.place_file)));
  EXPECT_EQ(diagnostic.exit_code, expected.file == "missing_plugin.xml" ? 4 : 3);
}

INSTANTIATE_TEST_SUITE_P(
    All, BrokenStack,
    testing::Values(
        Expected{"bad_activity.xml", "E014", 14, 36,
                 "attribute 'active': 'yes' does not name a port: expected signal.port, such as 'touch.held', or 'true' "
                 "or 'false'"},
        Expected{"bad_choice.xml", "E014", 17, 48,
                 "attribute 'projection': 'augmentd' is not one of the choices: expected 'successive' or "
                 "'augmented'",
                 "augmented"},
        Expected{"bad_deadline.xml", "E014", 17, 57,
                 "attribute 'deadline-iterations': '0' is out of range: expected an integer ≥ 1"},
        Expected{"bad_number.xml", "E014", 11, 55,
                 "attribute 'force': '0.5N' is not a number: expected a number ≥ 0 (N)"},
        Expected{"bad_torque_rate.xml", "E014", 17, 49,
                 "attribute 'torque-rate': '0' is out of range: expected a number > 0 (1/s)"},
        Expected{"ball_joint.xml", "E054", 3, 3,
                 "joint 'shoulder' has several degrees of freedom: a stack runs robots whose joints are revolute, "
                 "continuous, prismatic or fixed and move on their own",
                 "", "ball.urdf"},
        Expected{"broken_robot.xml", "E081", 3, 3, "link 'two' has no parent, but 'one' is the root already", "",
                 "two_roots.urdf"},
        Expected{"carrier_cycle.xml", "E039", 6, 29, "object 'bump' stands on itself, directly or through others"},
        Expected{"class_cycle.xml", "E039", 3, 32, "class 'soft' is its own base, directly or through others"},
        Expected{"coupled_robot.xml", "E054", 10, 3,
                 "joint 'elbow' follows joint 'shoulder': a stack runs robots whose joints are revolute, continuous, "
                 "prismatic or fixed and move on their own; 1 more of this one are not like that",
                 "", "coupled.urdf"},
        Expected{"duplicate_attribute.xml", "E003", 11, 32, "attribute 'name' is given twice"},
        Expected{"duplicate_name.xml", "E020", 15, 20, "the name 'hand' is taken by the <impedance> in line 14"},
        Expected{"empty_window.xml", "E014", 13, 55,
                 "attribute 'active-until': 2 s is not after 2.5 s, where active-from opens the window"},
        Expected{"empty.xml", "E002", 1, 1, "the file holds no element"},
        Expected{"error_in_include.xml", "E030", 3, 49, "the robot has no link or group of links 'fngers'", "fingers",
                 "included.xml"},
        Expected{"fault_delay.xml", "E014", 8, 51,
                 "attribute 'delay': 0.0025 s is not a whole number of ticks of 0.001 s"},
        Expected{"fault_no_body.xml", "E013", 8, 5, "<shove> needs one of 'link', 'object'"},
        Expected{"fault_on_fixed_link.xml", "E056", 8, 30,
                 "link 'lwr_base' is fixed to the world: forces and masses change nothing for it"},
        Expected{"fault_on_fixed_object.xml", "E056", 8, 32,
                 "object 'table' is fixed: forces and masses change nothing for it. Give it mobility=\"free\" or "
                 "\"held\""},
        Expected{"fault_over_before.xml", "E014", 8, 60,
                 "attribute 'until': 2 s is not after 2.5 s, where it begins"},
        Expected{"fault_unknown_joint.xml", "E031", 8, 42,
                 "the robot has no moving joint or group of joints 'fngers'", "fingers"},
        Expected{"fault_unknown_object.xml", "E032", 8, 38,
                 "the scene has no object 'tabel'", "table"},
        Expected{"fault_with_gain.xml", "E014", 8, 40,
                 "attribute 'factor': '1.5' is out of range: expected a number ≥ 0 and ≤ 1"},
        Expected{"fault_without_end.xml", "E022", 8, 36, "'impulse' needs 'until', too"},
        Expected{"include_cycle.xml", "E039", 3, 18, "'include_cycle.xml' includes itself, directly or through others"},
        Expected{"level_order.xml", "E021", 13, 20,
                 "priority 1 is that of the level before: the levels of a stack rise strictly"},
        Expected{"mismatched_tag.xml", "E003", 12, 3,
                 "</levl> stands where </level> was expected: <level> was opened in line 10, column 3"},
        Expected{"misplaced_element.xml", "E015", 6, 5, "<posture> must not stand in <scene>: it belongs in <level>"},
        Expected{"missing_attribute.xml", "E013", 11, 5, "<contact-force> needs the attribute 'on'"},
        Expected{"missing_include.xml", "E001", 3, 18,
                 "the file 'nowhere.xml' cannot be read: looked for '" + folder + "nowhere.xml'"},
        Expected{"missing_model.xml", "E050", 3, 17,
                 "there is no robot model 'lwr_alegro': looked for " + folder +
                     "lwr_alegro.urdf, " TACTUS_SOURCE_DIR "/models/lwr_alegro.urdf",
                 "lwr_allegro"},
        Expected{"missing_name.xml", "E013", 15, 5, "<posture> needs the attribute 'name'"},
        Expected{"missing_plugin.xml", "E070", 3, 17,
                 "the plugin 'no-such-plugin' cannot be loaded: looked for no-such-plugin.so in no folder at all"},
        Expected{"missing_robot.xml", "E016", 2, 1, "<stack> needs a <robot>"},
        Expected{"negative_fault_time.xml", "E014", 8, 37,
                 "attribute 'from': '-1' is out of range: expected a number ≥ 0 (s)"},
        Expected{"negative_ramp.xml", "E014", 15, 67,
                 "attribute 'active-ramp': '-0.1' is out of range: expected a number ≥ 0 (s)"},
        Expected{"nan_gain.xml", "E014", 15, 50,
                 "attribute 'stiffness': 'nan' is not a finite number: expected a number ≥ 0 (N m/rad)"},
        Expected{"no_mass.xml", "E062", 9, 3,
                 "link 'upper' moves but has no mass: give it an <inertial> with mass and inertia, or join it by "
                 "a fixed joint to a link that has them",
                 "", "no_mass.urdf"},
        Expected{"not_xml.xml", "E003", 1, 1, "text stands before the outermost element"},
        Expected{"out_of_range.xml", "E014", 11, 55,
                 "attribute 'force': '-0.5' is out of range: expected a number ≥ 0 (N)"},
        Expected{"start_length.xml", "E051", 4, 15, "the robot has 23 moving joints, but q gives 3 values"},
        Expected{"start_limits.xml", "E052", 4, 23,
                 "joint 'a4' cannot start at 3.5: its limits are -2.96706 and 2.96706"},
        Expected{"stray_text.xml", "E018", 6, 5, "text must not stand in <scene>: values are given as attributes"},
        Expected{"tilted_carrier.xml", "E053", 6, 29, "'table' is tilted: an object stands only on a level top"},
        Expected{"two_roots.xml", "E004", 19, 1, "<stack> is a second outermost element: a file has one"},
        Expected{"unknown_attribute.xml", "E012", 14, 41, "<impedance> has no attribute 'stifness'", "stiffness"},
        Expected{"unknown_back_end.xml", "E037", 17, 24,
                 "there is no back end 'nullspace': there are null-space, all, none, first", "null-space"},
        Expected{"unknown_class.xml", "E035", 15, 33, "the stack has no class 'soft'"},
        Expected{"unknown_element.xml", "E011", 14, 5,
                 "there is no element <impedence>; here may stand: contact-force, contact-limit, joint-limits, "
                 "make-contact, follow-surface, impedance, posture, ds, test.pull, test.guard, test.press, include",
                 "impedance"},
        Expected{"unknown_joint.xml", "E031", 15, 38, "the robot has no moving joint or group of joints 'fngers'",
                 "fingers"},
        Expected{"unknown_link.xml", "E030", 14, 35, "the robot has no link 'plam'", "palm"},
        Expected{"unknown_object.xml", "E032", 6, 29, "the scene has no object 'tabel'", "table"},
        Expected{"unknown_option.xml", "E012", 17, 36, "back end 'null-space' has no option 'projecton'", "projection"},
        Expected{"unknown_parameter.xml", "E036", 12, 55, "the stack has no parameter 'pres'", "press"},
        Expected{"unknown_port.xml", "E033", 11, 36,
                 "signal 'touch' has no port 'hold': its ports are held, undesired, all, missing, points, desired, "
                 "touching, self",
                 "touch.held"},
        Expected{"unknown_signal.xml", "E033", 11, 36, "the stack has no signal 'tuoch'", "touch.held"},
        Expected{"wrong_count.xml", "E014", 14, 52, "attribute 'stiffness': expected 3 numbers, found 2"},
        Expected{"wrong_format.xml", "E019", 2, 16, "format '2' is not one that this version reads: expected '1'"},
        Expected{"wrong_port_type.xml", "E034", 11, 36,
                 "'touch.missing' is a missing-set, but 'on' takes a contact-set"},
        Expected{"wrong_activity_port.xml", "E034", 13, 31,
                 "'touch.held' is a contact-set, but 'active' takes a scalar", ""},
        Expected{"wrong_root.xml", "E010", 2, 1, "a stack has <stack> outermost, not <stac>", "stack"}),
    [](const auto& info) { return std::filesystem::path(info.param.file).stem().string(); });

TEST(BrokenStacks, EachHasItsExpectation) {
  std::vector<std::string> expected;
  const auto& suite = *testing::UnitTest::GetInstance();
  for (int i = 0; i < suite.total_test_suite_count(); ++i)
    for (int k = 0; k < suite.GetTestSuite(i)->total_test_count(); ++k) {
      const testing::TestInfo& test = *suite.GetTestSuite(i)->GetTestInfo(k);
      if (test.value_param()) expected.push_back(test.value_param());
    }
  expected.insert(expected.end(), {"included.xml", "several_errors.xml"});  // tested below
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".xml")) {
      EXPECT_THAT(expected, testing::Contains(name));
    }
  }
}

TEST(BrokenStacks, AllErrorsAreGatheredInTheOrderOfTheFile) {
  std::vector<std::string> found;
  for (const auto& diagnostic : diagnose(testFile("broken/several_errors.xml")))
    found.push_back(std::to_string(diagnostic.place.line) + " " + diagnostic.code);
  EXPECT_THAT(found, testing::ElementsAre("5 E014", "11 E014", "14 E030", "15 E013", "15 E012"));
}

TEST(BrokenStacks, AnErrorShowsItsLineItsNearestNameAndItsPath) {
  EXPECT_EQ(dsl::render(diagnose(folder + "unknown_attribute.xml").front()),
            folder + "unknown_attribute.xml:14:41: error[E012]: <impedance> has no attribute 'stifness'\n"
            "  14 |     <impedance name=\"hand\" frame=\"palm\" stifness=\"300 300 300\"/>\n"
            "     |                                         ^^^^^^^^ did you mean 'stiffness'?\n"
            "  in /stack/level[@priority=2]/impedance[@name=hand]\n");
}

TEST(BrokenStacks, ARobotThatStacksCannotRunIsShownAtItsJoint) {
  EXPECT_EQ(dsl::render(diagnose(folder + "ball_joint.xml").front()),
            folder + "ball.urdf:3:3: error[E054]: joint 'shoulder' has several degrees of freedom: a stack runs robots "
            "whose joints are revolute, continuous, prismatic or fixed and move on their own\n"
            "  3 |   <joint name=\"shoulder\" type=\"spherical\">\n"
            "    |   ^^^^^^\n"
            "  in /robot/joint[@name=shoulder], included from " + folder + "ball_joint.xml:3:3\n");
}

TEST(BrokenStacks, AnErrorInAnIncludedFileSaysWhoIncludedIt) {
  EXPECT_EQ(dsl::render(diagnose(folder + "error_in_include.xml").front()),
            folder + "included.xml:3:49: error[E030]: the robot has no link or group of links 'fngers'\n"
            "  3 |   <signals><contacts name=\"feel\" desired=\"thumb fngers\"/></signals>\n"
            "    |                                                 ^^^^^^ did you mean 'fingers'?\n"
            "  in /stack/signals/contacts[@name=feel], included from " + folder + "error_in_include.xml:3:3\n");
}

}  // namespace
}  // namespace tactus::dsl_test
