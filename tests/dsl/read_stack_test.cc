// What is right is read as it stands: references, classes, parameters, includes, carriers, back ends.  What is wrong is
// tried in broken_stacks_test.cc, and here where it takes options or several files.

#include "dsl/read_stack.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "framework/dynamics/kinematics.h"
#include "framework/geometry/primitives.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using control::Origin;
using testing::ElementsAre;

dsl::Stack read(const std::string& text, dsl::ReadOptions options = readOptions(),
                std::vector<dsl::Diagnostic>* warnings = nullptr) {
  static control::Registry registry = makeRegistry();
  return dsl::readStack(writeFile("stack.xml", text), registry, options, warnings);
}

std::vector<std::string> errors(const std::string& text, dsl::ReadOptions options = readOptions()) {
  std::vector<std::string> found;
  try {
    read(text, options);
  } catch (const dsl::InvalidStack& invalid) {
    for (const auto& diagnostic : invalid.diagnostics)
      found.push_back(std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " +
                      diagnostic.code + " " + diagnostic.message +
                      (diagnostic.suggestion.empty() ? "" : " [" + diagnostic.suggestion + "]"));
  }
  return found;
}

const std::string level = "<level priority=\"1\"><test.pull name=\"p\"/></level>";

TEST(ReadStack, TheMainExampleIsValid) {
  control::Registry registry = makeRegistry();
  registry.addSignal(
      {.name = "bump-estimate",
       .kind = control::ElementKind::signal,
       .description = "Stands in for the plugin's.",
       .attributes = {{.name = "from", .type = control::ValueType::port, .port_type = "touched-points"}}},
      [](const control::BuildContext&) { return nullptr; });
  registry.addBackEnd({.name = "qp",
                       .kind = control::ElementKind::back_end,
                       .description = "Stands in for the plugin's.",
                       .attributes = {{.name = "metric", .type = control::ValueType::text}}},
                      [](const control::ElementValues&) { return nullptr; });
  registry.addBackEnd({.name = "hqp",
                       .kind = control::ElementKind::back_end,
                       .description = "Stands in for the plugin's.",
                       .attributes = {{.name = "metric", .type = control::ValueType::text},
                                      {.name = "contact-forces", .type = control::ValueType::text}}},
                      [](const control::ElementValues&) { return nullptr; });
  std::vector<dsl::Diagnostic> warnings;
  const std::string file = std::string(TACTUS_SOURCE_DIR) + "/examples/explore_table/stack.xml";
  const dsl::Stack stack = dsl::readStack(file, registry, readOptions(), &warnings);
  for (const auto& warning : warnings) ADD_FAILURE() << dsl::render(warning);
  EXPECT_EQ(stack.name, "explore-table");
  EXPECT_EQ(stack.start_q.size(), 23);
  ASSERT_GE(stack.objects.size(), 2u);
  EXPECT_EQ(stack.objects[1].on, "table");
  ASSERT_GE(stack.levels.size(), 3u);
  EXPECT_EQ(stack.levels[0].tasks[0].values.real("force"), 0.5);
}

TEST(ReadStack, TellsWhereEveryValueComesFrom) {
  const std::string inside =
      "<parameter name=\"k\" value=\"300\"/><parameter name=\"d\" value=\"1\"/>\n"
      "<defaults class=\"base\"><test.pull stiffness=\"1\" damping=\"2\" friction=\"3\"/></defaults>\n"
      "<defaults class=\"soft\" base=\"base\"><test.pull stiffness=\"4\" damping=\"5\"/></defaults>\n"
      "<level priority=\"1\"><test.pull name=\"p\" class=\"soft\" stiffness=\"6\" frame=\"flange\"/>\n"
      "<test.pull name=\"q\" stiffness=\"${k}\" damping=\"${d}\"/></level>";
  dsl::ReadOptions options = readOptions();
  options.set["d"] = "7";
  const dsl::Stack stack = read(smallStack(inside), options);
  const auto& p = stack.levels.at(0).tasks.at(0).values;
  const auto& q = stack.levels.at(0).tasks.at(1).values;
  EXPECT_EQ(p.real("stiffness"), 6);
  EXPECT_EQ(p.value("stiffness").origin.kind, Origin::Kind::attribute);
  EXPECT_EQ(p.value("stiffness").origin.place.line, 6);
  EXPECT_EQ(p.real("damping"), 5);
  EXPECT_EQ(p.value("damping").origin.kind, Origin::Kind::defaults_class);
  EXPECT_EQ(p.value("damping").origin.detail, "soft");
  EXPECT_EQ(p.value("damping").origin.place.line, 5);
  EXPECT_EQ(p.real("friction"), 3);
  EXPECT_EQ(p.value("friction").origin.detail, "base");
  EXPECT_EQ(q.real("stiffness"), 300);
  EXPECT_EQ(q.real("damping"), 7);
  EXPECT_EQ(q.value("damping").origin.kind, Origin::Kind::command_line);
  EXPECT_EQ(q.value("damping").origin.detail, "--set d=7");
  EXPECT_EQ(q.value("friction").origin.kind, Origin::Kind::table_default);
  EXPECT_EQ(stack.levels.at(0).tasks.at(0).path, "/stack/level[@priority=1]/test.pull[@name=p]");
}

TEST(ReadStack, ParametersStandInsideValues) {
  const dsl::Stack stack = read(smallStack(
      "<parameter name=\"x\" value=\"0.6\"/><parameter name=\"y\" value=\"0.1\"/>\n"
      "<level priority=\"1\"><test.pull name=\"p\" along=\"${x} ${y} 0; 0 ${y} ${x}\"/></level>"));
  EXPECT_THAT(stack.levels.at(0).tasks.at(0).values.numbers("along"), ElementsAre(0.6, 0.1, 0, 0, 0.1, 0.6));
}

TEST(ReadStack, WhatIsWrongWithParametersAndSettings) {
  dsl::ReadOptions options = readOptions();
  options.set["pres"] = "1";
  EXPECT_THAT(errors(smallStack("<parameter name=\"press\" value=\"1\"/>\n" + level), options),
              ElementsAre("1:1 E036 --set pres=1: the stack has no parameter 'pres' [press]"));
  options.set = {{"press", "${press}"}};
  EXPECT_THAT(
      errors(smallStack("<parameter name=\"press\" value=\"1\"/>\n" + level), options),
      ElementsAre(
          "1:1 E014 --set press=${press}: the value of a parameter is taken as written: '${' has no meaning in it"));
  EXPECT_THAT(errors(smallStack("<parameter name=\"a\" value=\"${a}\"/>\n" + level)),
              ElementsAre("3:28 E014 the value of a parameter is taken as written: '${' has no meaning in it"));
  EXPECT_THAT(errors(smallStack("<parameter name=\"a\" value=\"1\"/><parameter name=\"a\" value=\"2\"/>\n" + level)),
              ElementsAre("3:49 E020 the stack has a parameter 'a' already"));
  EXPECT_THAT(errors(smallStack("<level priority=\"1\"><test.pull name=\"p\" stiffness=\"${a\"/></level>")),
              ElementsAre("3:52 E014 '${' is not closed by '}'"));
}

TEST(ReadStack, AnIncludeStandsForWhatTheFileHolds) {
  writeFile("more.xml",
            "<stack format=\"1\"><parameter name=\"k\" value=\"5\"/>\n<include file=\"level.xml\"/></stack>");
  writeFile("level.xml", "<stack>\n <level priority=\"2\"><include file=\"tasks.xml\"/></level></stack>");
  writeFile("tasks.xml", "<level>\n\n  <test.pull name=\"q\" stiffness=\"${k}\"/></level>");
  const dsl::Stack stack = read(smallStack(level + "<include file=\"more.xml\"/>"));
  ASSERT_EQ(stack.levels.size(), 2u);
  const auto& task = stack.levels[1].tasks.at(0);
  EXPECT_EQ(task.values.real("stiffness"), 5);
  EXPECT_EQ(task.place.file.substr(task.place.file.rfind('/') + 1), "tasks.xml");
  EXPECT_EQ(task.place.line, 3);
  EXPECT_EQ(stack.included_from.at(task.place.file).size(), 3u);
  EXPECT_EQ(stack.files.size(), 5u);  // and the robot's
}

TEST(ReadStack, IncludesThatDoNotFitOrNeverEnd) {
  writeFile("scene.xml", "<scene/>");
  EXPECT_THAT(errors(smallStack(level + "<include file=\"scene.xml\"/>")),
              ElementsAre("1:1 E010 a file included into <stack> has <stack> outermost, not <scene>"));
  writeFile("a.xml", "<stack><include file=\"b.xml\"/></stack>");
  writeFile("b.xml", "<stack><include file=\"./a.xml\"/></stack>");
  EXPECT_THAT(errors(smallStack(level + "<include file=\"a.xml\"/>")),
              ElementsAre("1:23 E039 './a.xml' includes itself, directly or through others"));
  for (int i = 0; i < 12; ++i) {  // 2¹² files if nobody counted
    const std::string next = "<include file=\"twice" + std::to_string(i + 1) + ".xml\"/>";
    writeFile("twice" + std::to_string(i) + ".xml", "<stack>" + (i == 11 ? "" : next + next) + "</stack>");
  }
  EXPECT_THAT(errors(smallStack(level + "<include file=\"twice0.xml\"/>")),
              testing::Each(testing::HasSubstr("E039 a stack may have at most 200 includes")));
  writeFile("new.xml", "<stack format=\"2\" colour=\"red\"/>");
  EXPECT_THAT(errors(smallStack(level + "<include file=\"new.xml\"/>")),
              ElementsAre("1:16 E019 format '2' is not one that this version reads: expected '1'",
                          "1:19 E012 the outermost element of an included file has no attribute 'colour'"));
}

TEST(ReadStack, PosesOnACarrierStandOnTheMiddleOfItsTop) {
  const std::string scene =
      "<scene><object name=\"bump\" on=\"table\" pose=\"0.04 0.05 -0.015\"><sphere radius=\"0.03\"/></object>\n"
      "<object name=\"table\" pose=\"0.7 0 0.2 0 0 1.5707963267948966\"><box size=\"0.6 0.6 0.02\" pose=\"0 0 "
      "0.1\"/></object>\n"
      "<object name=\"hat\" on=\"bump\"><cylinder radius=\"0.1\" length=\"0.2\" pose=\"0 0 0.1\"/></object></scene>";
  const dsl::Stack stack = read(smallStack(scene + level));
  EXPECT_TRUE(stack.objects[0].object.pose.translation().isApprox(Eigen::Vector3d(0.65, 0.04, 0.295), 1e-12));
  EXPECT_TRUE(stack.objects[2].object.pose.translation().isApprox(Eigen::Vector3d(0.65, 0.04, 0.325), 1e-12));
  EXPECT_TRUE(stack.objects[0].object.pose.linear().isApprox(stack.objects[1].object.pose.linear()));
}

TEST(ReadStack, EveryShapeAndMaterialIsRead) {
  const dsl::Stack stack =
      read(smallStack("<scene gravity=\"0 0 -1.6\"><object name=\"o\" stiffness=\"1\" dissipation=\"3\" "
                      "friction=\"0.4\" jitter=\"1 2 3\">"
                      "<plane/><box size=\"1 2 3\"/><sphere radius=\"4\"/><cylinder radius=\"5\" length=\"6\"/>"
                      "<capsule radius=\"7\" length=\"8\" pose=\"1 2 3 0.1 0.2 0.3\"/></object></scene>" +
                      level));
  const auto& object = stack.objects.at(0).object;
  ASSERT_EQ(object.primitives.size(), 5u);
  EXPECT_EQ(dynamic_cast<const geometry::Box&>(*object.primitives[1].shape).size(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(dynamic_cast<const geometry::Cylinder&>(*object.primitives[3].shape).length(), 6);
  EXPECT_EQ(dynamic_cast<const geometry::Capsule&>(*object.primitives[4].shape).radius(), 7);
  EXPECT_EQ(object.primitives[4].pose.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(object.material.friction, 0.4);
  EXPECT_EQ(stack.objects[0].jitter, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(stack.gravity.z(), -1.6);
}

TEST(ReadStack, AStartThatIsNotGivenIsZeroOrTheNearestLimit) {
  const dsl::Stack stack = read("<stack format=\"1\"><robot model=\"allegro_right\"/>" + level +
                                "<controller backend=\"all\"/></stack>");
  EXPECT_EQ(stack.start_q[0], 0);
  EXPECT_EQ(stack.start_q[12], 0.263);
  EXPECT_EQ(stack.name, "stack");  // the file's
}

dsl::Stack startingAt(const std::string& attributes) {
  return read("<stack format=\"1\"><robot model=\"lwr_4plus\"><start q=\"0 0.5 0 -1.2 0 0.6 0\" " + attributes + "/></robot>" +
              level + "<controller backend=\"all\"/></stack>");
}

TEST(ReadStack, AStartIsDrawnFromTheSeedAndStaysWithinJitterAndLimits) {
  const dsl::Stack still = startingAt("");
  EXPECT_EQ(still.start(3), still.start_q) << "without jitter";
  const dsl::Stack stack = startingAt("jitter=\"0.1 0 0.2 0 0 0 9\"");
  EXPECT_EQ(stack.start(0), stack.start_q) << "seed 0 draws none";
  EXPECT_EQ(stack.start(5), stack.start(5));
  Eigen::VectorXd most = Eigen::VectorXd::Zero(7);
  for (std::uint64_t seed = 1; seed <= 200; ++seed)
    most = most.cwiseMax((stack.start(seed) - stack.start_q).cwiseAbs());
  EXPECT_GT(most[0], 0.09);
  EXPECT_LE(most[0], 0.1);
  EXPECT_GT(most[2], 0.18);
  EXPECT_EQ(most[1], 0);
  const auto moving = stack.robot.movingJoints();
  EXPECT_LE(most[6], stack.robot.joints[static_cast<std::size_t>(moving[6])].upper) << "kept within limits";
}

TEST(ReadStack, AFrameStartsOffItsPlaceByWhatTheSeedDraws) {
  const dsl::Stack stack = startingAt("frame=\"lwr_6\" frame-jitter=\"0.03 0.02 0.01 0 0 0.1\"");
  const dynamics::Model model(stack.robot);
  dynamics::Workspace workspace(model);
  const int link = stack.robot.linkIndex("lwr_6");
  const auto pose = [&](const Eigen::VectorXd& q) {
    dynamics::forwardKinematics(model, q, workspace);
    return dynamics::framePose(model, workspace, link);
  };
  const Eigen::Isometry3d from = pose(stack.start_q);
  Eigen::Vector3d most = Eigen::Vector3d::Zero();
  double most_turn = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Eigen::Isometry3d there = pose(stack.start(seed));
    most = most.cwiseMax((there.translation() - from.translation()).cwiseAbs());
    const Eigen::AngleAxisd turn(there.linear() * from.linear().transpose());
    if (std::abs(turn.angle()) > 1e-6) {
      EXPECT_NEAR(std::abs(turn.axis().z()), 1, 1e-4) << "about the vertical alone";
    }
    most_turn = std::max(most_turn, std::abs(turn.angle()));
  }
  EXPECT_TRUE((most.array() <= Eigen::Array3d(0.03, 0.02, 0.01) + 1e-6).all()) << most.transpose();
  EXPECT_TRUE((most.array() >= 0.9 * Eigen::Array3d(0.03, 0.02, 0.01)).all()) << most.transpose();
  EXPECT_NEAR(most_turn, 0.1, 0.01);
}

TEST(ReadStack, AJitterThatDoesNotFitIsRefused) {
  const auto messageOf = [](const std::string& attributes) -> std::string {
    try {
      startingAt(attributes);
    } catch (const dsl::InvalidStack& error) {
      return error.diagnostics.front().message;
    }
    return "none";
  };
  EXPECT_EQ(messageOf("jitter=\"0.1 0.1\""),
            "the robot has 7 moving joints, but jitter gives 2 values; one for all, or one for each");
  EXPECT_EQ(messageOf("jitter=\"-0.1\""), "jitter must not be negative");
  EXPECT_EQ(messageOf("frame=\"lwr_6\" frame-jitter=\"0 0 0 0 0 -1\""), "frame-jitter must not be negative");
  EXPECT_EQ(messageOf("frame-jitter=\"0 0 0.1 0 0 0\""), "frame-jitter needs a frame: the link that it moves");
}

TEST(ReadStack, TheCommandLineReplacesTheBackEnd) {
  dsl::ReadOptions options = readOptions();
  options.backend = "none";
  options.backend_options["tolerance"] = "0.5";
  const std::string controller =
      "<controller backend=\"all\" projection=\"successive\" tolerance=\"0.1\" rate=\"500\"/>";
  const dsl::Stack stack = read(smallStack(level, controller), options);
  EXPECT_EQ(stack.back_end.row().name, "none");
  EXPECT_EQ(stack.back_end.text("projection"), "augmented");  // what was written was meant for the other one
  EXPECT_EQ(stack.back_end.real("tolerance"), 0.5);
  EXPECT_EQ(stack.back_end.value("tolerance").origin.kind, Origin::Kind::command_line);
  EXPECT_EQ(stack.controller.values.text("backend"), "none");
  EXPECT_EQ(stack.controller.values.real("rate"), 500);

  options.backend = "all";
  options.backend_options = {{"projecton", "successive"}};
  EXPECT_THAT(errors(smallStack(level, controller), options),
              ElementsAre("4:1 E038 back end 'all' has no option 'projecton', which the command line gives [projection]"));
  options.backend_options = {{"tolerance", "-1"}};
  EXPECT_THAT(
      errors(smallStack(level, controller), options),
      ElementsAre("4:1 E014 option 'tolerance' of the command line: '-1' is out of range: expected a number ≥ 0"));
  options.backend = "al";
  EXPECT_THAT(errors(smallStack(level, controller), options),
              ElementsAre("4:1 E037 --backend al: there is no such back end [all]"));
}

TEST(ReadStack, AnAlternativeGivesItsOptionsWhereItIsChosen) {
  const std::string controller =
      "<controller backend=\"all\" tolerance=\"0.1\"><alternative backend=\"none\" projection=\"successive\"/></controller>";
  const dsl::Stack as_written = read(smallStack(level, controller));
  EXPECT_EQ(as_written.back_end.row().name, "all");
  EXPECT_EQ(as_written.back_end.text("projection"), "augmented");
  ASSERT_EQ(as_written.alternatives.size(), 1u);
  EXPECT_EQ(as_written.alternatives[0].row().name, "none");

  dsl::ReadOptions options = readOptions();
  options.backend = "none";
  const dsl::Stack replaced = read(smallStack(level, controller), options);
  EXPECT_EQ(replaced.back_end.row().name, "none");
  EXPECT_EQ(replaced.back_end.text("projection"), "successive");
  EXPECT_EQ(replaced.back_end.real("tolerance"), 1e-8);
  ASSERT_EQ(replaced.alternatives.size(), 1u);  // the controller as written
  EXPECT_EQ(replaced.alternatives[0].row().name, "all");
  EXPECT_EQ(replaced.alternatives[0].real("tolerance"), 0.1);
}

TEST(ReadStack, WhatIsWrongWithAlternatives) {
  EXPECT_THAT(errors(smallStack(level, "<controller backend=\"all\"><alternative backend=\"al\"/>\n"
                                       "<alternative backend=\"none\" projecton=\"successive\"/>\n"
                                       "<alternative backend=\"none\" rate=\"10\"/>\n"
                                       "<alternative/></controller>")),
              ElementsAre("4:49 E037 there is no back end 'al': there are null-space, all, none, first [all]",
                          "5:29 E012 back end 'none' has no option 'projecton' [projection]",
                          "6:23 E020 back end 'none' has its options already",
                          "6:29 E012 back end 'none' has no option 'rate'; it takes backend, projection, tolerance",
                          "7:1 E013 <alternative> needs the attribute 'backend'"));
}

TEST(ReadStack, PluginsAreLoadedFirst) {
  control::Registry registry = makeRegistry();
  dsl::ReadOptions options = readOptions();
  std::vector<std::string> loaded;
  options.load_plugin = [&](const std::string& name) {
    loaded.push_back(name);
    control::Registry with = registry;
    with.addTask({.name = "acme.wiggle", .description = "Comes with the plugin."},
                 [](const control::BuildContext&) { return nullptr; });
    registry = with;
  };
  const std::string file = writeFile(
      "stack.xml",
      smallStack(
          "<plugin name=\"acme\"/><plugin name=\"acme\"/><level priority=\"1\"><acme.wiggle name=\"w\"/></level>"));
  const dsl::Stack stack = dsl::readStack(file, registry, options);
  EXPECT_THAT(loaded, ElementsAre("acme"));
  EXPECT_THAT(stack.plugins, ElementsAre("acme"));
  EXPECT_EQ(stack.levels[0].tasks[0].values.row().name, "acme.wiggle");
  EXPECT_THAT(
      errors(smallStack("<level priority=\"1\"><acme.wiggle name=\"w\"/></level>")),
      ElementsAre(testing::StartsWith(
          "3:21 E011 there is no element <acme.wiggle> (is its plugin named by a <plugin>?); here may stand: ")));
}

TEST(ReadStack, WarnsOfASignalThatNothingReads) {
  std::vector<dsl::Diagnostic> warnings;
  const std::string signals =
      "<signals><test.probe name=\"a\"/><test.probe name=\"b\"/><test.probe name=\"c\" from=\"b.value\"/></signals>";
  read(smallStack(signals + level), readOptions(), &warnings);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].message, "nothing reads the signal 'a'");
  EXPECT_EQ(warnings[0].code, "W010");
}

TEST(ReadStack, WordsOfATaskStandAlone) {
  EXPECT_THAT(errors(smallStack("<level priority=\"1\"><test.pull name=\"p\" joints=\"free\"/></level>")),
              testing::IsEmpty());
  EXPECT_THAT(errors(smallStack("<level priority=\"1\"><test.pull name=\"p\" joints=\"a1 free\"/></level>")),
              ElementsAre("3:52 E014 'free' stands alone, with no other names"));
}

TEST(ReadStack, CountsAndClasses) {
  EXPECT_THAT(errors(smallStack(level + "<run/><run/>")), ElementsAre("3:56 E017 <stack> takes at most 1 <run>"));
  EXPECT_THAT(errors(smallStack("<level priority=\"1\"/>")), ElementsAre("3:1 E016 <level> needs a task, or a controller that owns it"));
  EXPECT_THAT(errors(smallStack("<defaults class=\"c\"><test.pull name=\"x\"/></defaults>" + level)),
              ElementsAre("3:32 E012 an element in <defaults> has no attribute 'name'"));
  EXPECT_THAT(errors(smallStack("<defaults class=\"c\" base=\"d\"/>" + level)),
              ElementsAre("3:27 E035 the stack has no class 'd'"));
  EXPECT_THAT(
      errors(smallStack("<scene><object name=\"o\" pose=\"1 2\"><plane/></object></scene>" + level)),
      ElementsAre("3:31 E014 attribute 'pose': expected 3 numbers (x y z) or 6 (x y z roll pitch yaw), found 2"));
}

TEST(ReadStack, TargetsHaveBounds) {
  const auto with = [](const std::string& targets) {
    return smallStack(level, "<controller backend=\"all\"/>\n<run>" + targets + "</run>");
  };
  const dsl::Stack stack = read(with("<target metric=\"a\" lower=\"1\"/><target metric=\"b\" lower=\"0\" upper=\"0\"/>"));
  ASSERT_EQ(stack.run.targets.size(), 2u);
  EXPECT_EQ(stack.run.targets[0].lower, 1);
  EXPECT_FALSE(stack.run.targets[0].upper);
  EXPECT_EQ(stack.run.targets[1].upper, 0);
  EXPECT_THAT(errors(with("<target metric=\"a\"/>")),
              ElementsAre("5:6 E013 <target> needs at least one of 'lower', 'upper'"));
  EXPECT_THAT(errors(with("<target metric=\"a\" lower=\"2\" upper=\"1\"/>")),
              ElementsAre("5:42 E014 attribute 'upper': it must not be below 'lower'"));
  EXPECT_THAT(errors(with("<target metric=\"a\" lower=\"2\"/><target metric=\"a\" upper=\"1\"/>")),
              ElementsAre("5:52 E020 'a' has its target already"));
}

TEST(ReadStack, ATickIsAWholeNumberOfThePlantsSteps) {
  const auto at = [](const std::string& rate) {
    return smallStack(level, "<controller backend=\"all\" rate=\"" + rate + "\"/>");
  };
  dsl::ReadOptions options = readOptions();
  EXPECT_THAT(errors(at("3000"), options), testing::IsEmpty()) << "without a plant every rate is right";
  options.plant_step = 0.25e-3;
  for (const char* rate : {"4000", "2000", "1000", "800", "1"}) EXPECT_THAT(errors(at(rate), options), testing::IsEmpty()) << rate;
  EXPECT_THAT(errors(at("3000"), options),
              ElementsAre("4:33 E055 at 3000 Hz a tick is not a whole number of the plant's steps of 0.00025 s: the nearest "
                          "rates are 2000 and 4000 Hz"));
  EXPECT_THAT(errors(at("5000"), options),
              ElementsAre("4:33 E055 at 5000 Hz a tick is not a whole number of the plant's steps of 0.00025 s: the highest "
                          "rate is 4000 Hz"));
}

TEST(ReadStack, ARunHasATickAndAnEnd) {
  const auto of = [](const std::string& duration) {
    return smallStack(level, "<controller backend=\"all\" rate=\"100\"/>\n<run duration=\"" + duration + "\"/>");
  };
  EXPECT_THAT(errors(of("0.01")), testing::IsEmpty());
  EXPECT_THAT(errors(of("0.004")),
              ElementsAre("5:16 E014 attribute 'duration': 0.004 s is shorter than one tick of 0.01 s"));
  EXPECT_THAT(errors(of("1e7")),
              ElementsAre("5:16 E014 attribute 'duration': '1e7' is out of range: expected a number > 0 and ≤ 1e+06 (s)"));
}

TEST(ReadStack, AnUnknownAttributeWithoutANearNameListsTheOthers) {
  EXPECT_THAT(errors(smallStack("<level priority=\"1\" zzzzzz=\"1\"><test.pull name=\"p\"/></level>")),
              ElementsAre("3:21 E012 <level> has no attribute 'zzzzzz'; it takes priority, weight, strict, active, active-from, "
                          "active-until, active-ramp"));
  EXPECT_THAT(errors(smallStack("<signals zzzzzz=\"1\"/>" + level)),
              ElementsAre("3:10 E012 <signals> has no attribute 'zzzzzz'; it takes none"));
}

TEST(ReadStack, AMissingFileIsSaidAtItsFirstCharacter) {
  control::Registry registry = makeRegistry();
  try {
    dsl::readStack("/nowhere/stack.xml", registry, readOptions());
    FAIL() << "a missing file was read";
  } catch (const dsl::InvalidStack& invalid) {
    EXPECT_EQ(dsl::render(invalid.diagnostics.at(0)),
              "/nowhere/stack.xml:1:1: error[E001]: the stack '/nowhere/stack.xml' cannot be read\n");
  }
}

TEST(ReadStack, AtMostFiftyErrorsAreTold) {
  std::string many = "<level priority=\"1\">";
  for (int i = 0; i < 200; ++i) many += "<test.pull name=\"p\"/>\n";
  EXPECT_EQ(errors(smallStack(many + "</level>")).size(), 50u);
}

TEST(ReadStack, IncludesStayInTheFoldersThatTheUserAllows) {
  const std::string inside = writeFile("part.xml", "<level><test.pull name=\"p\"/></level>");
  const std::string folder = inside.substr(0, inside.rfind('/'));
  const std::string outside = folder + "_outside";
  std::filesystem::create_directories(outside);
  std::filesystem::copy_file(inside, outside + "/part.xml", std::filesystem::copy_options::overwrite_existing);
  const auto with = [](const std::string& file) {
    return smallStack("<level priority=\"1\"><include file=\"" + file + "\"/></level>");
  };
  const std::string name = outside.substr(outside.rfind('/') + 1);
  EXPECT_THAT(errors(with("part.xml")), ElementsAre());
  EXPECT_THAT(errors(with("../" + folder.substr(folder.rfind('/') + 1) + "/part.xml")), ElementsAre()) << "out and in again";
  for (const std::string& file : {"../" + name + "/part.xml", outside + "/part.xml"}) {
    EXPECT_THAT(errors(with(file)),
                ElementsAre("3:36 E041 '" + file + "' lies outside of the stack's folder; when you trust it, allow its "
                            "folder in TACTUS_INCLUDE_PATH"));
    dsl::ReadOptions options = readOptions();
    options.include_folders = {outside};
    EXPECT_THAT(errors(with(file), options), ElementsAre());
  }
  std::filesystem::remove(folder + "/link.xml");
  std::filesystem::create_symlink(outside + "/part.xml", folder + "/link.xml");
  EXPECT_THAT(errors(with("link.xml")), ElementsAre(testing::HasSubstr("E041 'link.xml' lies outside")));
}

TEST(ReadStack, FilesHaveASizeThatNobodyWrites) {
  const std::string blanks(17 << 20, ' ');
  EXPECT_THAT(errors(smallStack(level) + blanks), ElementsAre("1:1 E006 the file has more than 16 MiB"));
  // Each of them would do.
  writeFile("part.xml", "<stack><!--" + std::string(15 << 20, 'x') + "--></stack>");
  std::string includes;
  for (int i = 0; i < 5; ++i) includes += "<include file=\"part.xml\"/>";
  EXPECT_THAT(errors(smallStack(includes + level)),
              ElementsAre("1:1 E006 the files of the stack have more than 64 MiB"));
}

}  // namespace
}  // namespace tactus::dsl_test
