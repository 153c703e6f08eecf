// Capsules of ticks that fail right after something was switched: what they hold is what the back end then had.
#include "apps/tactus/capsule_keeper.h"

#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "framework/runtime/plugin_loader.h"
#include "tasks/register_tasks.h"
#include "tests/apps/program.h"

namespace tactus::app {
namespace {

using control::Controller;
using testing::TemporaryFolder;

/// Switches something between two ticks of a run, and takes the back end's time away so that it does not go well.
class Switch final : public control::Observer {
 public:
  static constexpr int after = 60;                                 // ticks

  Switch(Session& session, std::function<void(Controller&)> action) : session_(session), action_(std::move(action)) {}
  void observe(const control::ObservedTick&) override {
    if (++ticks_ != after) return;
    action_(session_.controller());
    session_.controller().backEnd().setDeadline({.iterations = 0});
  }

 private:
  Session& session_;
  std::function<void(Controller&)> action_;
  int ticks_ = 0;
};

/// The finger with motors that its posture is too stiff for: torque limits are active in every tick.
class CapsuleKeeperTest : public ::testing::TestWithParam<const char*> {
 protected:
  CapsuleKeeperTest() {
    dsl::addStructureElements(registry);
    tasks::registerBuiltIns(registry);
    runtime::PluginLoader(registry, {}, SHIPPED_PLUGINS).loadFolder(SHIPPED_PLUGINS);
    std::string robot = testing::contentOf(testing::data("finger.urdf"));
    robot.replace(robot.find("upper=\"1.5\""), 11, "upper=\"0.45\"");
    for (size_t at; (at = robot.find("effort=\"20\"")) != std::string::npos;) robot.replace(at, 11, "effort=\"0.6\"");
    folder.write("finger.urdf", robot);
    std::string stack = testing::contentOf(testing::data("press.xml"));
    const auto replace = [&](const std::string& from, const std::string& to) {
      stack.replace(stack.find(from), from.size(), to);
    };
    replace("stiffness=\"1\"", "stiffness=\"30\"");
    replace("<level priority=\"1\">",
            "<level priority=\"1\"><joint-limits name=\"limits\"/>"
            "<joint-limits name=\"more\" active=\"false\" margin=\"0.3\" stiffness=\"200\"/>");
    file = folder.write("stack.xml", stack);
  }

  std::unique_ptr<control::BackEnd> make(const std::string& name, const std::map<std::string, std::string>& options) {
    return registry.makeBackEnd(control::makeValues(*registry.elements().findBackEnd(name), options));
  }

  /// Runs with the switch; the first capsule must be that of the next tick, and all must be met again.
  void expectReproduced(const std::string& back_end, const std::function<void(Controller&)>& action) {
    dsl::ReadOptions options;
    options.backend = back_end;
    if (back_end == "qp") options.backend_options["solver"] = "active-set";
    std::vector<dsl::Diagnostic> warnings;
    dsl::Stack stack = dsl::readStack(file, registry, options, &warnings);
    stack.run.duration = 0.08;
    Session session(std::move(stack), registry);
    CapsuleKeeper keeper(session, folder.path());
    Switch switcher(session, action);
    const std::atomic<bool> stop{false};
    session.run({&keeper, &switcher}, stop);
    ASSERT_FALSE(keeper.files().empty());
    EXPECT_EQ(keeper.files().front(), "capsule-" + std::to_string(Switch::after) + ".json");
    for (const std::string& name : keeper.files()) {
      const testing::Outcome outcome = testing::tactus({"solve", folder.file(name), "--json"});
      EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
      const nlohmann::json json = outcome.json();
      const nlohmann::json capsule = nlohmann::json::parse(testing::contentOf(folder.file(name)));
      EXPECT_EQ(json["capsule"]["reproduced"], true) << name << ": " << outcome.err;
      EXPECT_EQ(json["iterations"], capsule["capsule"]["iterations"]) << name;
      EXPECT_EQ(capsule["capsule"]["backend"], session.controller().backEnd().recipe().back_end);
    }
  }

  control::Registry registry;
  TemporaryFolder folder;
  std::string file;
};

TEST_P(CapsuleKeeperTest, AfterSetBackEnd) {
  expectReproduced(GetParam(), [&](Controller& controller) { controller.setBackEnd(make("hqp", {{"fade", "2e-3"}})); });
  expectReproduced(GetParam(), [&](Controller& controller) {
    controller.setBackEnd(make("qp", {{"solver", "active-set"}, {"metric", "inertia"}}));
  });
}

TEST_P(CapsuleKeeperTest, AfterSetPriority) {
  expectReproduced(GetParam(), [](Controller& controller) { controller.setPriority("limits", 2); });
  expectReproduced(GetParam(), [](Controller& controller) { controller.setPriority("bow", 1); });
}

TEST_P(CapsuleKeeperTest, AfterASwitchOfATask) {
  expectReproduced(GetParam(), [](Controller& controller) { controller.setActive("more", true); });
}

INSTANTIATE_TEST_SUITE_P(BackEnds, CapsuleKeeperTest, ::testing::Values("hqp", "qp"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace tactus::app
