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
           .choices = {"moving", "balanced"}}};
}

ObjectiveOptions objectiveOptions(const ElementValues& values) {
  return {values.text("metric") == "inertia" ? RowMetric::inertia : RowMetric::identity,
          values.text("contact-forces") == "balanced" ? ContactForces::balanced : ContactForces::moving};
}

}  // namespace tactus::control
