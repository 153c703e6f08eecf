// Elements inside a signal: read, checked, referred to by ports that they name, written out again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "dsl/compile.h"
#include "dsl/stack_graph.h"
#include "tests/dsl/test_elements.h"

#include <nlohmann/json.hpp>

namespace tactus::dsl_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string machine =
    "<signals><test.probe name=\"p\"/>\n<phases name=\"do\">\n<phase name=\"approach\"><next to=\"sweep\" when=\"p.value\" "
    "above=\"2\"/></phase>\n<phase name=\"sweep\"/>\n</phases></signals>";

std::string stackWith(const std::string& signals, const std::string& active) {
  return smallStack(signals + "<level priority=\"1\"><test.pull name=\"t\" active=\"" + active + "\"/></level>");
}

std::vector<std::string> errors(const std::string& text) {
  std::vector<std::string> found;
  control::Registry registry = makeRegistry();
  try {
    dsl::compile(dsl::readStack(writeFile("stack.xml", text), registry, readOptions()), registry);
  } catch (const dsl::InvalidStack& invalid) {
    for (const auto& diagnostic : invalid.diagnostics)
      found.push_back(std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " +
                      diagnostic.code + " " + diagnostic.message +
                      (diagnostic.suggestion.empty() ? "" : " [" + diagnostic.suggestion + "]"));
  }
  return found;
}

TEST(PhasesInAStack, WhatIsNotTrueOrFalseSwitchesNothing) {
  EXPECT_THAT(errors(stackWith(machine, "do.time")),
              ElementsAre(HasSubstr("E040 'do.time' is in s, but 'active' takes a number without unit")));
  EXPECT_THAT(errors(stackWith(machine, "do.index")), IsEmpty());
}

TEST(PhasesInAStack, ATaskTakesPartInOnePhase) {
  control::Registry registry = makeRegistry();
  const dsl::Stack stack = dsl::readStack(writeFile("stack.xml", stackWith(machine, "do.sweep")), registry, readOptions());
  const auto controller = dsl::compile(stack, registry);
  control::Sensed sensed;
  sensed.q = sensed.qd = Eigen::VectorXd::Zero(7);
  const auto* sweep = static_cast<const double*>(controller->signals()[1].signal->port("sweep"));
  for (const auto& [time, wanted] : {std::pair(0.0, 0.0), {2.0, 0.0}, {2.001, 1.0}, {3.0, 1.0}}) {
    sensed.time = time;
    controller->tick(sensed);
    EXPECT_EQ(*sweep, wanted) << "t = " << time;
  }
}

TEST(PhasesInAStack, MistakesAreToldAtTheirPlaces) {
  EXPECT_THAT(errors(stackWith(machine, "do.sweep")), IsEmpty());
  EXPECT_THAT(errors(stackWith(machine, "do.sweeb")),
              ElementsAre(HasSubstr("E033 signal 'do' has no port 'sweeb': its ports are approach, sweep, time, index [do.sweep]")));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = machine;
    text.replace(text.find(from), from.size(), to);
    return errors(stackWith(text, "do.approach"));
  };
  EXPECT_THAT(with("to=\"sweep\"", "to=\"sweeb\""), ElementsAre("5:34 E061 there is no phase 'sweeb' [sweep]"));
  EXPECT_THAT(with("p.value", "q.value"), ElementsAre("5:47 E033 the stack has no signal 'q' [p.value]"));
  EXPECT_THAT(with(" when=\"p.value\"", ""), ElementsAre(HasSubstr("E013 <next> needs at least one of 'when', 'after'"),
                                                        HasSubstr("E022 'above' needs 'when', too")));
  EXPECT_THAT(with("<phase name=\"sweep\"/>", "<phase name=\"sweep\" far=\"1\"/>"),
              ElementsAre(HasSubstr("E012 <phase> has no attribute 'far'")));
  EXPECT_THAT(errors(stackWith("<signals><phases name=\"do\"/></signals>", "true")), ElementsAre(HasSubstr("E016 <phases> needs a <phase>")));
}

TEST(PhasesInAStack, AreWrittenOutAndReadBack) {
  control::Registry registry = makeRegistry();
  const dsl::Stack stack = dsl::readStack(writeFile("stack.xml", stackWith(machine, "do.sweep")), registry, readOptions());
  const std::string written = dsl::writeResolved(stack);
  EXPECT_THAT(written, HasSubstr("    <phases name=\"do\">\n      <phase name=\"approach\">\n        <next to=\"sweep\" "
                                 "when=\"p.value\" above=\"2\" for=\"0\"/>\n      </phase>\n"));
  EXPECT_EQ(dsl::writeResolved(dsl::readStack(writeFile("again.xml", written), registry, readOptions())), written);
}

TEST(StackGraph, HasEveryReaderWithItsPort) {
  control::Registry registry = makeRegistry();
  const std::string signals = machine.substr(0, machine.size() - 10) + "<test.probe name=\"idle\"/></signals>";
  const dsl::Stack stack = dsl::readStack(writeFile("stack.xml", stackWith(signals, "do.sweep")), registry, readOptions());
  const dsl::StackGraph graph = dsl::graphOf(stack);
  const nlohmann::json json = dsl::graphToJson(graph);
  std::vector<std::string> edges, idle;
  for (const auto& edge : json["edges"])
    edges.push_back(edge["from"].get<std::string>() + "." + edge["port"].get<std::string>() + " -> " +
                    edge["to"].get<std::string>() + " " + edge["attribute"].get<std::string>());
  EXPECT_THAT(edges, ElementsAre("signal/p.value -> signal/do when", "signal/do.sweep -> task/t active"));
  for (const auto& node : json["nodes"])
    if (node.value("used", true) == false) idle.push_back(node["name"]);
  EXPECT_THAT(idle, ElementsAre("idle"));
  EXPECT_THAT(dsl::graphToDot(graph), HasSubstr("\"signal/do\" -> \"task/t\" [label=\"sweep → active\"];\n"));
  EXPECT_THAT(dsl::graphToSvg(graph), HasSubstr("<title>do.sweep (scalar) → t active</title>"));
}

}  // namespace
}  // namespace tactus::dsl_test
