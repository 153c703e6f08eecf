// A whole tick of the main example (dynamics, signals, tasks, null-space cascade) takes no memory, not even while tasks
// and levels are switched; and whatever is switched, its torque keeps the declared rate.

#include <gtest/gtest.h>

#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "framework/runtime/file_error.h"
#include "framework/runtime/plugin_loader.h"
#include "sim/simbody_plant.h"
#include "tasks/register_tasks.h"
#include "conformance/allocation_count.h"
#include "tests/runtime/temporary_folder.h"

namespace tactus::testing {
namespace {

const std::string kStack = TACTUS_SOURCE_DIR "/examples/explore_table/stack.xml";

class Tick : public ::testing::Test {
 protected:
  Tick() {
    dsl::addStructureElements(registry);
    tasks::registerBuiltIns(registry);
    runtime::PluginLoader(registry, {}, SHIPPED_PLUGINS).loadFolder(SHIPPED_PLUGINS);
  }

  /// Runs the stack in closed loop; `between` is called before every tick.
  template <class Between>
  void run(const std::string& file, int ticks, Between between) {
    dsl::ReadOptions options;
    options.model_path = {TACTUS_SOURCE_DIR "/models"};
    const dsl::Stack stack = dsl::readStack(file, registry, options);
    const auto controller = dsl::compile(stack, registry);
    sim::SimbodyPlant plant(stack.robot, stack.scene(1), stack.start_q);
    const Eigen::VectorXd& effort = controller->model().effort();
    Eigen::VectorXd last;
    for (int k = 0; k < ticks; ++k) {
      between(*controller, k);
      const control::Sensed& sensed = plant.sense();
      largest_contacts = std::max(largest_contacts, sensed.contacts.size());
      const long before = conformance::allocationCount();
      const Eigen::VectorXd& torque = controller->tick(sensed);
      allocations += conformance::allocationCount() - before;
      if (k > 0) largest_step = std::max(largest_step, ((torque - last).array() / effort.array()).abs().maxCoeff());
      last = torque;
      rate_limited += controller->record().rate_limited;
      plant.advance(torque, controller->period());
    }
  }

  control::Registry registry;
  long allocations = 0;
  std::size_t largest_contacts = 0;
  double largest_step = 0;                                         // of the effort limit, in a tick
  long rate_limited = 0;
};

TEST_F(Tick, OfTheMainExampleTakesNoMemory) {
  run(kStack, 9000, [](control::Controller&, int) {});
  EXPECT_EQ(allocations, 0);
  EXPECT_GE(largest_contacts, 5u) << "the hand hardly touched: the claim was tested on nothing";
}

TEST_F(Tick, TakesNoMemoryAndKeepsTheRateWhileEverythingIsSwitched) {
  std::string text = runtime::readFile(kStack);
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("<controller", "<controller torque-rate=\"10\" ramp=\"0.05\"");
  replace("<level priority=\"2\"", "<level priority=\"2\" active-from=\"1\" active-until=\"2\"");
  replace("<posture name=\"spread\"", "<posture name=\"spread\" active=\"touch.touching\" active-ramp=\"0.02\"");
  const TemporaryFolder folder;
  int share_between = 0;
  run(folder.write("stack.xml", text), 5000, [&](control::Controller& controller, int k) {
    const double share = controller.activationOf("sweep").share();
    share_between += share > 0 && share < 1;
    if (k > 1500 && k % 200 == 0) controller.setActive("sweep", k % 400 == 0);
    if (k > 1500 && k % 300 == 0) controller.setActive(1, k % 600 == 0);
    if (k == 4000) controller.setPriority("thumb", 4);
  });
  EXPECT_EQ(allocations, 0);
  EXPECT_GE(largest_contacts, 3u);
  EXPECT_GT(share_between, 100);
  EXPECT_GT(rate_limited, 0);
  EXPECT_LE(largest_step, 10 * 0.001 + 1e-12);
}

}  // namespace
}  // namespace tactus::testing
