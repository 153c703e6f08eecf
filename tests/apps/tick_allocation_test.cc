// A whole tick of the main example (dynamics, signals, tasks, null-space cascade) takes no memory.

#include <gtest/gtest.h>

#include "dsl/compile.h"
#include "dsl/read_stack.h"
#include "plugins/bump-estimate/bump_estimate.h"
#include "plugins/null-space/null_space.h"
#include "sim/simbody_plant.h"
#include "tasks/register_tasks.h"
#include "tests/dynamics/allocation_count.h"

namespace tactus::testing {
namespace {

/// The back end as its plugin makes it, without loading the library.
void registerNullSpace(control::Registry& registry) {
  control::ElementRow row;
  row.name = "null-space";
  row.kind = control::ElementKind::back_end;
  row.attributes = {{.name = "projection", .type = control::ValueType::choice, .default_text = "augmented",
                     .choices = {"successive", "augmented"}}};
  registry.addBackEnd(row, [](const control::ElementValues& values) {
    null_space::NullSpaceOptions options;
    options.cascade = values.text("projection") == "successive" ? null_space::Cascade::successive
                                                                : null_space::Cascade::augmented;
    return std::make_unique<null_space::NullSpace>(options);
  });
}

TEST(Tick, OfTheMainExampleTakesNoMemory) {
  control::Registry registry;
  dsl::addStructureElements(registry);
  tasks::registerBuiltIns(registry);
  plugins::BumpEstimate::registerIn(registry);
  registerNullSpace(registry);
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
