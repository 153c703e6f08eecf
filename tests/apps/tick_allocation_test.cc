// A whole tick of the main example (dynamics, signals, tasks, null-space cascade) takes no memory.

#include <gtest/gtest.h>

#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "framework/runtime/plugin_loader.h"
#include "sim/simbody_plant.h"
#include "tasks/register_tasks.h"
#include "tests/dynamics/allocation_count.h"

namespace tactus::testing {
namespace {

TEST(Tick, OfTheMainExampleTakesNoMemory) {
  control::Registry registry;
  dsl::addStructureElements(registry);
  tasks::registerBuiltIns(registry);
  runtime::PluginLoader(registry, {}, SHIPPED_PLUGINS).loadFolder(SHIPPED_PLUGINS);
  dsl::ReadOptions options;
  options.model_path = {TACTUS_SOURCE_DIR "/models"};
  const dsl::Stack stack = dsl::readStack(TACTUS_SOURCE_DIR "/examples/explore_table/stack.xml", registry, options);
  const auto controller = dsl::compile(stack, registry);
  sim::SimbodyPlant plant(stack.robot, stack.scene(1), stack.start_q);

  long allocations = 0;
  std::size_t largest_contacts = 0;
  for (int k = 0; k < 9000; ++k) {
    const control::Sensed& sensed = plant.sense();
    largest_contacts = std::max(largest_contacts, sensed.contacts.size());
    const long before = dynamics::allocationCount();
    const Eigen::VectorXd& torque = controller->tick(sensed);
    allocations += dynamics::allocationCount() - before;
    plant.advance(torque, controller->period());
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_GE(largest_contacts, 5u) << "the hand hardly touched: the claim was tested on nothing";
}

}  // namespace
}  // namespace tactus::testing
