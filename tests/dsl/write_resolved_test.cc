// A resolved stack reads back to the same stack, and stands without its parameters, classes and includes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "dsl/read_stack.h"
#include "dsl/typed_attributes.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

dsl::Stack readFrom(const std::string& file, const dsl::ReadOptions& options = readOptions()) {
  static control::Registry registry = makeRegistry();
  return dsl::readStack(file, registry, options);
}

void expectSameValues(const control::ElementValues& a, const control::ElementValues& b) {
  EXPECT_EQ(&a.row(), &b.row());
  for (const control::AttributeRow& row : a.row().attributes) {
    if (row.name == "class") continue;  // its values are written out
    ASSERT_EQ(a.has(row.name), b.has(row.name)) << row.name;
    if (!a.has(row.name)) continue;
    EXPECT_EQ(a.numbers(row.name), b.numbers(row.name)) << row.name;
    if (a.numbers(row.name).empty()) {
      EXPECT_EQ(dsl::splitWords(a.text(row.name)), dsl::splitWords(b.text(row.name)));
    }
  }
}

void expectSameInstances(const std::vector<dsl::ElementInstance>& a, const std::vector<dsl::ElementInstance>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_EQ(a[i].path, b[i].path);
    expectSameValues(a[i].values, b[i].values);
  }
}

void expectSame(const dsl::Stack& a, const dsl::Stack& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.plugins, b.plugins);
  EXPECT_EQ(a.robot.name, b.robot.name);
  EXPECT_EQ(a.start_q, b.start_q);
  EXPECT_EQ(a.gravity, b.gravity);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].object.name, b.objects[i].object.name);
    EXPECT_EQ(a.objects[i].object.pose.matrix(), b.objects[i].object.pose.matrix());
    EXPECT_EQ(a.objects[i].jitter, b.objects[i].jitter);
    EXPECT_EQ(a.objects[i].on, b.objects[i].on);
    ASSERT_EQ(a.objects[i].object.primitives.size(), b.objects[i].object.primitives.size());
    for (std::size_t k = 0; k < a.objects[i].object.primitives.size(); ++k) {
      EXPECT_EQ(a.objects[i].object.primitives[k].pose.matrix(), b.objects[i].object.primitives[k].pose.matrix());
      const geometry::Shape &one = *a.objects[i].object.primitives[k].shape, &other = *b.objects[i].object.primitives[k].shape;
      EXPECT_EQ(typeid(one), typeid(other));
      expectSameValues(a.objects[i].shapes[k], b.objects[i].shapes[k]);
    }
  }
  expectSameInstances(a.fault_elements, b.fault_elements);
  expectSameInstances(a.signals, b.signals);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_EQ(a.levels[i].priority, b.levels[i].priority);
    EXPECT_EQ(a.levels[i].weight, b.levels[i].weight);
    EXPECT_EQ(a.levels[i].strict, b.levels[i].strict);
    expectSameInstances(a.levels[i].tasks, b.levels[i].tasks);
    expectSameValues(a.levels[i].element.values, b.levels[i].element.values);
  }
  expectSameValues(a.controller.values, b.controller.values);
  expectSameValues(a.back_end, b.back_end);
  ASSERT_EQ(a.alternatives.size(), b.alternatives.size());
  for (std::size_t i = 0; i < a.alternatives.size(); ++i) expectSameValues(a.alternatives[i], b.alternatives[i]);
  EXPECT_EQ(a.run.duration, b.run.duration);
  EXPECT_EQ(a.run.seed, b.run.seed);
  EXPECT_EQ(a.run.columns, b.run.columns);
  EXPECT_EQ(a.run.record_rate, b.run.record_rate);
  ASSERT_EQ(a.run.targets.size(), b.run.targets.size());
  for (std::size_t i = 0; i < a.run.targets.size(); ++i) {
    EXPECT_EQ(a.run.targets[i].metric, b.run.targets[i].metric);
    EXPECT_EQ(a.run.targets[i].lower, b.run.targets[i].lower);
    EXPECT_EQ(a.run.targets[i].upper, b.run.targets[i].upper);
  }
}

const std::string rich =
    "<stack format=\"1\">\n<plugin name=\"known\"/><parameter name=\"k\" value=\"0.1\"/>\n"
    "<defaults class=\"soft\"><test.pull stiffness=\"${k}\" along=\"0 0 ${k};\n 1 2 3\"/><object "
    "friction=\"0.7\"/></defaults>\n"
    "<robot model=\"lwr_4plus\"><start q=\"0.1 0.2 0.3 1e-3 0.5 0.30000000000000004 0.7\"/></robot>\n"
    "<scene gravity=\"0 0 -1.6\"><object name=\"table\" class=\"soft\" pose=\"0.7 0 0.2 0 0 0.1\" jitter=\"0 0 0.01\">"
    "<box size=\"0.6 0.6 0.02\"/><plane pose=\"0 0 -1 0.1 0.2 0.3\"/></object>"
    "<object name=\"bump\" on=\"table\" pose=\"0.04 0.04 -0.015\"><capsule radius=\"${k}\" "
    "length=\"0.2\"/></object></scene>\n"
    "<faults><torque-loss name=\"f1\" joints=\"a1\n a2\" factor=\"${k}\" until=\"2\"/>"
    "<shove name=\"f2\" link=\"flange\" impulse=\"0 0 ${k}\" until=\"0.5\"/></faults>\n"
    "<signals><test.probe name=\"t\"/></signals>\n"
    "<level priority=\"1\" strict=\"true\" active-from=\"${k}\"><test.pull name=\"p\" active=\"t.value\" active-ramp=\"0\" class=\"soft\" "
    "joints=\"a1\n  a2\" "
    "from=\"t.value\"/></level>\n"
    "<include file=\"low.xml\"/>\n"
    "<controller backend=\"all\" projection=\"successive\"><alternative backend=\"none\" tolerance=\"${k}\"/>"
    "</controller>\n"
    "<run duration=\"12.5\" seed=\"7\"><record columns=\"all\" rate=\"50\"/>"
    "<target metric=\"a_N\" lower=\"${k}\" upper=\"2\"/><target metric=\"b\" upper=\"-1\"/></run>\n</stack>\n";

TEST(WriteResolved, ReadsBackToTheSameStack) {
  writeFile("low.xml",
            "<stack><level priority=\"3\" weight=\"0.25\"><test.guard name=\"g\" object=\"bump\"/></level></stack>");
  const dsl::Stack stack = readFrom(writeFile("stack.xml", rich));
  const std::string written = dsl::writeResolved(stack);
  for (const char* gone : {"${", "<include", "<defaults", "<parameter", "class="})
    EXPECT_EQ(written.find(gone), std::string::npos) << gone;
  dsl::Stack again = readFrom(writeFile("stack.resolved.xml", written));
  EXPECT_EQ(again.name, "stack");
  expectSame(stack, again);
  EXPECT_EQ(dsl::writeResolved(again), written);
}

TEST(WriteResolved, KeepsWhatTheCommandLineSaid) {
  writeFile("low.xml", "<stack/>");
  dsl::ReadOptions options = readOptions();
  options.set["k"] = "0.5";
  options.backend = "all";
  options.backend_options["tolerance"] = "0.25";
  dsl::Stack stack = readFrom(writeFile("stack.xml", rich), options);
  stack.run.seed = 99;  // --seed
  const dsl::Stack again = readFrom(writeFile("stack.resolved.xml", dsl::writeResolved(stack)));
  expectSame(stack, again);
  EXPECT_EQ(again.back_end.real("tolerance"), 0.25);
  EXPECT_EQ(again.levels[0].tasks[0].values.real("stiffness"), 0.5);
  EXPECT_EQ(again.run.seed, 99u);
}

TEST(WriteResolved, LeavesOutDefaultsThatNameWhatTheStackDoesNotHave) {
  const std::string stack =
      "<stack format=\"1\"><robot model=\"lwr_allegro\"/>@<level priority=\"1\"><posture name=\"p\" joints=\"arm\"/></level>"
      "<controller backend=\"all\"/></stack>";
  const auto resolvedWith = [&](const std::string& signals) {
    std::string text = stack;
    const dsl::Stack first = readFrom(writeFile("stack.xml", text.replace(text.find('@'), 1, signals)));
    const std::string written = dsl::writeResolved(first);
    expectSame(first, readFrom(writeFile("again.xml", written)));
    return written;
  };
  EXPECT_THAT(resolvedWith(""), testing::Not(testing::HasSubstr("touch")));
  EXPECT_THAT(resolvedWith("<signals><test.probe name=\"touch\"/></signals>"), testing::Not(testing::HasSubstr("touch.")));
  EXPECT_THAT(resolvedWith("<signals><contacts name=\"touch\" desired=\"fingers\"/></signals>"),
              testing::HasSubstr("on=\"touch.all\" desired=\"touch.desired\""));
}

TEST(WriteResolved, AFilesNameBecomesOneThatAStackMayHave) {
  const std::string text = "<stack format=\"1\"><robot model=\"lwr_4plus\"/><level priority=\"1\"><test.pull name=\"p\"/></level>"
                           "<controller backend=\"all\"/></stack>";
  for (const auto& [file, name] : std::map<std::string, std::string>{
           {"reach.xml", "reach"}, {"my stack.v2.xml", "my-stack-v2"}, {"2_arms.xml", "stack-2_arms"}, {"ä.xml", "stack---"}}) {
    const dsl::Stack stack = readFrom(writeFile(file, text));
    EXPECT_EQ(stack.name, name);
    expectSame(stack, readFrom(writeFile("again.xml", dsl::writeResolved(stack))));
  }
}

TEST(WriteResolved, FindsAModelBesideTheStackAgain) {
  const std::string stack =
      "<stack format=\"1\"><robot model=\"no_mass\"/><level priority=\"1\"><test.pull name=\"p\"/></level>"
      "<controller backend=\"all\"/></stack>";
  writeFile("no_mass.urdf", dsl::readStack(testFile("broken/no_mass.xml"),
                                           *std::make_unique<control::Registry>(makeRegistry()), readOptions())
                                .files.at(testFile("broken/no_mass.urdf")));
  const std::string written = dsl::writeResolved(readFrom(writeFile("stack.xml", stack)));
  const dsl::Stack again = readFrom(writeFile("elsewhere.xml", written));
  EXPECT_EQ(again.robot.name, "no_mass");
  EXPECT_THAT(again.robot_model, testing::EndsWith("no_mass.urdf"));
}

TEST(WriteResolved, EscapesWhatXmlWouldTakeForItself) {
  const std::string stack =
      "<stack format=\"1\"><plugin name=\"a &lt; &quot;b&quot; &amp;&#9;c\"/><robot model=\"lwr_4plus\"/>" +
      std::string("<level priority=\"1\"><test.pull name=\"p\"/></level><controller backend=\"all\"/></stack>");
  dsl::ReadOptions options = readOptions();
  options.load_plugin = [](const std::string&) {};
  const dsl::Stack first = readFrom(writeFile("stack.xml", stack), options);
  const dsl::Stack again = readFrom(writeFile("again.xml", dsl::writeResolved(first)), options);
  EXPECT_THAT(again.plugins, testing::ElementsAre("a < \"b\" &\tc"));
}

}  // namespace
}  // namespace tactus::dsl_test
