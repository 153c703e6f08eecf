#include "cascade.h"
#include "framework/runtime/plugin_api.h"

namespace {

using namespace tactus::control;

void registerElements(Registry& registry) {
  ElementRow row;
  row.name = "damped.cascade";
  row.description = "A cascade of damped pseudo-inverses: strict levels, bounded near singularities.";
  row.source = "Nakamura & Hanafusa 1986; Siciliano & Slotine 1991; Chiaverini 1997";
  row.attributes = {
      {.name = "damping", .type = ValueType::real, .unit = "1", .default_text = "0.01",
       .description = "λ: singular values below this share of the level's norm are followed less and less.", .lower = 0,
       .upper = 1, .lower_open = true},
      {.name = "rank-tolerance", .type = ValueType::real, .unit = "1", .default_text = "1e-6",
       .description = "τ: directions below this share of the level's norm are not held, and left to lower levels.",
       .lower = 1e-7, .upper = 1},
  };
  registry.addBackEnd(row, [](const ElementValues& values) {
    return std::make_unique<Cascade>(values.real("damping"), values.real("rank-tolerance"));
  });
}

}  // namespace

TACTUS_PLUGIN("damped", "1.0.0", "BSD-3-Clause", registerElements)
