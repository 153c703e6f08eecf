#include "framework/control/objective_options.h"

namespace tactus::control {

std::vector<AttributeRow> objectiveAttributes() {
  return {{.name = "metric", .type = ValueType::choice, .default_text = "identity",
           .description =
               "How the errors of a level that cannot meet all its rows are weighed. identity: as they are. inertia: each "
               "by the root of the inertia that its row meets, so that an arm's and a finger's count alike.",
           .choices = {"identity", "inertia"}},
          {.name = "contact-forces", .type = ValueType::choice, .default_text = "moving",
           .description =
               "What the forces of contact tasks do in the eyes of the levels below. moving: they accelerate the robot like "
               "any other torque, and are made up for. balanced: the surface bears them, as in the weighted programme.",
           .choices = {"moving", "balanced"}},
          {.name = "damping", .type = ValueType::real, .unit = "1", .default_text = "0",
           .description =
               "λ, below the first level: price of torque in the inverse-inertia metric beside the level's errors, in shares "
               "of its heaviest row. Where the levels above leave it hardly any room, nothing is driven harder than 1/(2λ) of "
               "what is asked; without it, without bound.",
           .lower = 0, .upper = 1}};
}

ObjectiveOptions objectiveOptions(const ElementValues& values) {
  return {values.text("metric") == "inertia" ? RowMetric::inertia : RowMetric::identity,
          values.text("contact-forces") == "balanced" ? ContactForces::balanced : ContactForces::moving,
          values.real("damping")};
}

}  // namespace tactus::control
