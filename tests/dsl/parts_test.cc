// Shapes, sensors, controllers of levels and recorders: what plugins add besides tasks, signals and back ends is read,
// built, written and drawn as these are, and refused at its place.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "dsl/stack_graph.h"
#include "framework/geometry/primitives.h"
#include "tests/dsl/test_elements.h"

namespace tactus::dsl_test {
namespace {

using control::BuildContext;
using control::ElementError;
using control::ElementRow;
using control::ElementValues;
using control::ValueType;
using testing::ElementsAre;
using testing::HasSubstr;

class Sense final : public control::Sensor {
 public:
  explicit Sense(double value) : value_(value) {}
  int count(const control::PortRow& port) const override { return port.name == "many" ? static_cast<int>(value_) : 1; }

 private:
  void doSense(const control::Sensed&, control::Sensed&, Eigen::Ref<Eigen::VectorXd> readings) override {
    readings.setConstant(value_);
  }
  double value_;
};

class Watch final : public control::Observer {
  void observe(const control::ObservedTick&) override {}
};

class Still final : public control::LevelController {
  void doUpdate(const control::Tick&) override {}
};

/// What the last recorder was told.
struct Told {
  std::string folder;
  const double* value = nullptr;
} told;

control::Registry registryWithParts() {
  control::Registry registry = makeRegistry();
  registry.addShape({.name = "test.blob",
                     .description = "A ball.",
                     .attributes = {{.name = "radius", .type = ValueType::real, .unit = "m", .required = true}}},
                    [](const ElementValues& values) -> std::shared_ptr<const geometry::Shape> {
                      if (values.real("radius") > 1) throw ElementError("radius", "no blob is that large");
                      return std::make_shared<geometry::Sphere>(values.real("radius"));
                    });
  registry.addSensor({.name = "test.sense",
                      .description = "A sensor.",
                      .attributes = {{.name = "value", .type = ValueType::real, .default_text = "3"}},
                      .ports = {{"one", "scalar", "1", "A number.", 1}, {"many", "vector", "1", "Numbers."}}},
                     [](const control::SensorContext& context) {
                       return std::make_unique<Sense>(context.values.real("value"));
                     });
  registry.addController(
      {.name = "test.owner",
       .description = "A controller.",
       .attributes = {{.name = "tasks", .type = ValueType::text, .default_text = "a b"},
                      {.name = "makes", .type = ValueType::text, .default_text = "test.pull"},
                      {.name = "stiffness", .type = ValueType::text, .default_text = "7"},
                      {.name = "from", .type = ValueType::port, .port_type = "scalar"}}},
      [](const BuildContext& context) {
        control::ControlledLevel level{std::make_unique<Still>(), {}};
        std::string name;
        for (const char c : context.values.text("tasks") + " ") {
          if (c != ' ') {
            name += c;
            continue;
          }
          level.tasks.push_back(
              {name, context.task(context.values.text("makes"), {{"stiffness", context.values.text("stiffness")}})});
          name.clear();
        }
        return level;
      });
  registry.addRecorder({.name = "test.watch",
                        .description = "A recorder.",
                        .attributes = {{.name = "from", .type = ValueType::port, .port_type = "scalar"}}},
                       [](const control::RecorderContext& context) {
                         told.folder = context.folder;
                         if (context.values.has("from")) told.value = &context.port<double>("from");
                         return std::make_unique<Watch>();
                       });
  return registry;
}

struct Built {
  control::Registry registry = registryWithParts();
  dsl::Stack stack;
  std::unique_ptr<control::Controller> controller;
  explicit Built(const std::string& text)
      : stack(dsl::readStack(writeFile("stack.xml", text), registry, readOptions())),
        controller(dsl::compile(stack, registry)) {}
};

std::vector<std::string> errors(const std::string& text) {
  std::vector<std::string> found;
  try {
    Built built(text);
    dsl::makeRecorders(built.stack, built.registry, *built.controller, "/somewhere");
  } catch (const dsl::InvalidStack& invalid) {
    for (const auto& diagnostic : invalid.diagnostics)
      found.push_back(std::to_string(diagnostic.place.line) + ":" + std::to_string(diagnostic.place.column) + " " +
                      diagnostic.code + " " + diagnostic.message);
  }
  return found;
}

const std::string pull = "<level priority=\"1\"><test.pull name=\"p\"/></level>";

TEST(Shapes, OfAPluginAreMadeByItsFactory) {
  const Built built(smallStack("<scene><object name=\"o\"><test.blob radius=\"0.5\" pose=\"0 0 1\"/></object></scene>" + pull));
  const description::Primitive& primitive = built.stack.objects[0].object.primitives[0];
  EXPECT_EQ(primitive.shape->boundingRadius(), 0.5);
  EXPECT_EQ(primitive.pose.translation(), Eigen::Vector3d(0, 0, 1));
}

TEST(Shapes, AreRefusedAtTheirAttribute) {
  EXPECT_THAT(errors(smallStack("<scene><object name=\"o\"><test.blob radius=\"5\"/></object></scene>" + pull)),
              ElementsAre("3:44 E061 no blob is that large"));
}

TEST(Sensors, StandBehindPorts) {
  const Built built(smallStack("<sensors><test.sense name=\"s\"/></sensors>"
                               "<level priority=\"1\"><test.pull name=\"p\" from=\"s.one\"/></level>"));
  EXPECT_EQ(built.controller->readings().size(), 4);
  const auto sensors = dsl::makeSensors(built.stack, built.registry, built.stack.scene(1), 1);
  ASSERT_EQ(sensors.size(), 1u);
  EXPECT_EQ(sensors[0].name, "s");
  control::Sensed sensed;
  sensed.q = sensed.qd = Eigen::VectorXd::Zero(7);
  sensed.readings.setConstant(4, 9);
  built.controller->tick(sensed);
  EXPECT_EQ(built.controller->levels()[0].tasks[0].task->error(), 9) << "the task reads what was sensed";
}

TEST(Sensors, HaveNumbersBehindEachPort) {
  EXPECT_THAT(errors(smallStack("<sensors><test.sense name=\"s\" value=\"0\"/></sensors>" + pull)),
              ElementsAre("3:10 E061 sensor 's' says that its port 'many', a vector, has 0 numbers"));
}

TEST(Sensors, AreNamedWhereAPortIsWrong) {
  const std::string sensor = "<sensors><test.sense name=\"s\"/></sensors>\n";
  EXPECT_THAT(errors(smallStack(sensor + "<level priority=\"1\"><test.pull name=\"p\" from=\"s.many\"/></level>")),
              ElementsAre("4:47 E034 's.many' is a vector, but 'from' takes a scalar"));
  EXPECT_THAT(errors(smallStack(sensor + "<level priority=\"1\"><test.pull name=\"s\"/></level>")),
              ElementsAre("4:38 E020 the name 's' is taken by the <test.sense> in line 3"));
}

TEST(Controllers, OwnTheTasksOfTheirLevel) {
  const Built built(smallStack("<level priority=\"1\"><test.owner name=\"o\"/></level>"));
  const control::Level& level = built.controller->levels()[0];
  EXPECT_EQ(level.owner.name, "o");
  ASSERT_EQ(level.tasks.size(), 2u);
  EXPECT_EQ(level.tasks[0].name, "o.a");
  EXPECT_EQ(level.tasks[1].name, "o.b");
}

TEST(Controllers, AreAloneInTheirLevel) {
  EXPECT_THAT(errors(smallStack("<level priority=\"1\"><test.owner name=\"o\"/>\n<test.pull name=\"p\"/></level>")),
              ElementsAre("4:1 E015 <test.owner> owns this level: 'o' has no tasks beside its own. Give this one a level of "
                          "its own"));
  EXPECT_THAT(errors(smallStack("<level priority=\"1\"><test.owner name=\"o\"/><test.owner name=\"p\"/></level>")),
              ElementsAre("3:43 E017 <level> takes at most 1 controller"));
}

TEST(Controllers, AreToldWhatTheirTasksRefuse) {
  const auto with = [](const std::string& attributes) {
    return smallStack("<level priority=\"1\"><test.owner name=\"o\" " + attributes + "/></level>");
  };
  EXPECT_THAT(errors(with("makes=\"test.push\"")),
              ElementsAre("3:21 E061 it wants a task <test.push>, and there is no such task"));
  EXPECT_THAT(errors(with("stiffness=\"2000\"")),
              ElementsAre("3:21 E061 its <test.pull>: attribute 'stiffness': no spring is that stiff"));
  EXPECT_THAT(errors(with("stiffness=\"much\"")), ElementsAre(HasSubstr("3:21 E061 its <test.pull>: ")));
  EXPECT_THAT(errors(with("tasks=\"a a\"")), ElementsAre("3:21 E061 it names two tasks 'a'"));
  EXPECT_THAT(errors(with("tasks=\"9\"")), ElementsAre(HasSubstr("3:21 E061 '9' is no name for a task: ")));
}

TEST(Recorders, AreToldTheFolderAndReadPorts) {
  const Built built(smallStack("<signals><test.probe name=\"a\"/></signals>" + pull,
                               "<controller backend=\"null-space\"/><run><test.watch name=\"w\" from=\"a.value\"/></run>"));
  const auto recorders = dsl::makeRecorders(built.stack, built.registry, *built.controller, "/a/folder");
  ASSERT_EQ(recorders.size(), 1u);
  EXPECT_EQ(recorders[0]->name(), "w");
  EXPECT_EQ(told.folder, "/a/folder");
  EXPECT_EQ(told.value, built.controller->signals()[0].signal->port("value"));
}

TEST(Recorders, ReferToWhatThereIs) {
  EXPECT_THAT(errors(smallStack(pull, "<controller backend=\"null-space\"/>\n<run><test.watch name=\"w\" from=\"b.value\"/></run>")),
              ElementsAre(HasSubstr("E033 the stack has no signal 'b'")));
}

const std::string all_parts =
    "<scene><object name=\"o\"><test.blob radius=\"0.5\"/></object></scene>"
    "<sensors><test.sense name=\"s\" value=\"2\"/></sensors>"
    "<level priority=\"1\"><test.owner name=\"owner\" from=\"s.one\"/></level>"
    "<controller backend=\"null-space\"/><run><test.watch name=\"w\" from=\"s.one\"/></run></stack>";

TEST(Parts, AreWrittenAndReadBack) {
  Built built("<stack format=\"1\" name=\"all\"><robot model=\"lwr_4plus\"/>" + all_parts);
  const std::string once = dsl::writeResolved(built.stack);
  EXPECT_THAT(once, HasSubstr("<test.sense name=\"s\" value=\"2\"/>"));
  Built again(once);
  EXPECT_EQ(dsl::writeResolved(again.stack), once);
  EXPECT_EQ(again.stack.run.recorders.size(), 1u);
  EXPECT_EQ(again.stack.levels[0].controller->name, "owner");
}

TEST(Parts, AreDrawn) {
  const Built built("<stack format=\"1\" name=\"all\"><robot model=\"lwr_4plus\"/>" + all_parts);
  const dsl::StackGraph graph = dsl::graphOf(built.stack);
  const nlohmann::ordered_json json = dsl::graphToJson(graph);
  std::vector<std::string> ids, edges;
  for (const auto& node : json["nodes"]) ids.push_back(node["id"]);
  for (const auto& edge : json["edges"])
    edges.push_back(edge["from"].get<std::string>() + " " + edge["port"].get<std::string>() + " " + edge["to"].get<std::string>());
  EXPECT_THAT(ids, ElementsAre("sensor/s", "level/1", "controller/owner", "recorder/w"));
  EXPECT_THAT(edges, ElementsAre("sensor/s one controller/owner", "sensor/s one recorder/w"));
  EXPECT_THAT(dsl::graphToSvg(graph), testing::AllOf(HasSubstr(">owner<"), HasSubstr(">w<")));
  EXPECT_THAT(dsl::graphToDot(graph), HasSubstr("\"sensor/s\" -> \"recorder/w\""));
}

}  // namespace
}  // namespace tactus::dsl_test
