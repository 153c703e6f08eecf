#include "framework/control/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tactus::control {
namespace {

using testing::Contains;
using testing::ElementsAre;

class Nothing final : public Task {
 public:
  Nothing() : Task(Relation::equality, 0) {}

 private:
  void doUpdate(const Tick&, TickTask& rows) override { rows.rows = 0; }
};

/// base —j1→ upper —j2→ lower —(fixed)→ tip
description::Robot chain() {
  description::Robot robot;
  for (const char* name : {"base", "upper", "lower", "tip"}) {
    description::Link link;
    link.name = name;
    robot.links.push_back(link);
  }
  for (int i = 0; i < 3; ++i) {
    description::Joint joint;
    joint.name = "j" + std::to_string(i + 1);
    joint.type = i < 2 ? description::JointType::revolute : description::JointType::fixed;
    joint.parent = i;
    joint.child = i + 1;
    robot.joints.push_back(joint);
  }
  robot.link_groups.push_back({"outer", {"tip", "lower"}, {}});
  robot.joint_groups.push_back({"both", {"j2", "j1"}, {}});
  return robot;
}

class BuildContextTest : public testing::Test {
 protected:
  BuildContextTest() : robot(chain()), model(robot, dynamics::MassPolicy::kinematics_only) {
    row.name = "pull";
    row.attributes = {{.name = "frame", .type = ValueType::link},
                      {.name = "links", .type = ValueType::links},
                      {.name = "joints", .type = ValueType::joints, .choices = {"free"}},
                      {.name = "from", .type = ValueType::port, .port_type = "scalar"}};
  }

  BuildContext context(const std::string& attribute, const std::string& text) {
    values = makeValues(row, {{attribute, text}});
    return {values, robot, model, 0.001,
            [this](const std::string& asked, const std::string& reference, const std::string& type) -> const void* {
              lookup = asked + "|" + reference + "|" + type;
              return &number;
            }};
  }

  description::Robot robot;
  dynamics::Model model;
  ElementRow row;
  ElementValues values;
  std::string lookup;
  double number = 7;
};

TEST_F(BuildContextTest, FindsFramesOfLinksAndGroupsInLinkOrderEachOnce) {
  EXPECT_EQ(context("frame", "lower").frame("frame"), 2);
  EXPECT_THAT(context("links", "tip base lower tip").frames("links"), ElementsAre(0, 2, 3));
  EXPECT_THAT(context("links", "outer upper lower").frames("links"), ElementsAre(1, 2, 3));
}

TEST_F(BuildContextTest, FindsJointsAndGroupsRisingEachOnce) {
  EXPECT_THAT(context("joints", "j2").joints("joints"), ElementsAre(1));
  EXPECT_THAT(context("joints", "both j1").joints("joints"), ElementsAre(0, 1));
  EXPECT_THAT(context("joints", "free").joints("joints"), testing::IsEmpty());  // the task's own word
}

TEST_F(BuildContextTest, UnknownNamesComeWithTheValidOnes) {
  const auto refusal = [&](const std::string& attribute, const std::string& text, auto ask) {
    const BuildContext build = context(attribute, text);
    try {
      ask(build);
    } catch (const ElementError& error) {
      EXPECT_EQ(error.attribute, attribute);
      EXPECT_THAT(error.candidates, testing::Not(testing::IsEmpty()));
      return std::string(error.what());
    }
    return std::string("none");
  };
  EXPECT_EQ(refusal("frame", "outer", [](const auto& build) { build.frame("frame"); }),
            "the robot has no link 'outer'");
  EXPECT_EQ(refusal("links", "tip tpi", [](const auto& build) { build.frames("links"); }),
            "the robot has no link or group of links 'tpi'");
  EXPECT_EQ(refusal("joints", "j3", [](const auto& build) { build.joints("joints"); }),
            "the robot has no moving joint or group of joints 'j3'");
}

TEST_F(BuildContextTest, PortsAreLookedUpByAttributeReferenceAndType) {
  EXPECT_EQ(context("from", "a.b").port<double>("from"), 7);
  EXPECT_EQ(lookup, "from|a.b|scalar");
}

TEST(Registry, GivesTasksAndSignalsTheirBaseAttributes) {
  Registry registry;
  registry.addTask({.name = "pull"}, [](const BuildContext&) { return std::make_unique<Nothing>(); });
  registry.addSignal({.name = "probe", .ports = {{"value", "scalar", "", ""}}},
                     [](const BuildContext&) { return nullptr; });
  for (const char* name : {"pull", "probe"}) {
    const ElementRow& row = *registry.elements().find(name);
    ASSERT_TRUE(row.attribute("name"));
    EXPECT_TRUE(row.attribute("name")->required);
    EXPECT_EQ(row.attribute("class")->type, ValueType::element_class);
  }
  EXPECT_EQ(registry.elements().find("pull")->kind, ElementKind::task);
  EXPECT_THAT(registry.names(ElementKind::signal), ElementsAre("probe"));
}

TEST(Registry, MakesByTheNameOfTheRow) {
  Registry registry;
  registry.addTask({.name = "pull"}, [](const BuildContext&) { return std::make_unique<Nothing>(); });
  const description::Robot robot = chain();
  const dynamics::Model model(robot, dynamics::MassPolicy::kinematics_only);
  const ElementValues values = makeValues(*registry.elements().find("pull"), {{"name", "p"}});
  EXPECT_TRUE(registry.makeTask({values, robot, model, 0.001, {}}));
  EXPECT_THROW(registry.makeSignal({values, robot, model, 0.001, {}}), std::logic_error);
}

TEST(Registry, ARefusedRowLeavesNothingBehind) {
  Registry registry;
  registry.addTask({.name = "pull"}, [](const BuildContext&) { return std::make_unique<Nothing>(); });
  EXPECT_THROW(registry.addSignal({.name = "pull"}, [](const BuildContext&) { return nullptr; }),
               std::invalid_argument);
  EXPECT_THROW(registry.addTask({.name = "no name"}, {}), std::invalid_argument);
  EXPECT_THAT(registry.names(ElementKind::task), ElementsAre("pull"));
  EXPECT_THAT(registry.names(ElementKind::signal), testing::IsEmpty());
}

TEST(Registry, IsAPlainValue) {
  Registry registry;
  registry.addTask({.name = "pull"}, [](const BuildContext&) { return std::make_unique<Nothing>(); });
  Registry copy = registry;
  copy.addTask({.name = "push"}, [](const BuildContext&) { return std::make_unique<Nothing>(); });
  EXPECT_EQ(registry.elements().find("push"), nullptr);
  registry = copy;
  EXPECT_TRUE(registry.elements().find("push"));
}

}  // namespace
}  // namespace tactus::control
