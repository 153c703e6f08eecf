#include "framework/runtime/plugin_api.h"
#include "plugins/hqp/hqp.h"

namespace tactus::hqp {
namespace {

using control::ElementValues;
using control::ValueType;

std::unique_ptr<control::BackEnd> make(const ElementValues& values) {
  HqpOptions options;
  options.rank = {values.real("rank-tolerance"), values.real("fade")};
  options.objective = control::objectiveOptions(values);
  if (options.rank.fade < options.rank.rank_tolerance)
    throw control::ElementError("fade", "fade must not be below rank-tolerance");
  return std::make_unique<Hqp>(options);
}

void registerElements(control::Registry& registry) {
  control::ElementRow row;
  row.name = "hqp";
  row.kind = control::ElementKind::back_end;
  row.description =
      "A strict hierarchy of quadratic programmes: every level comes as near to its accelerations as those above leave "
      "it, within inequality rows and torque limits.";
  row.source = "Escande, Mansard, Wieber (2014), Hierarchical quadratic programming";
  row.attributes = {
      {.name = "rank-tolerance", .type = ValueType::real, .unit = "1",
       .default_text = control::formatNumber(HqpOptions().rank.rank_tolerance),
       .description =
           "Singular value, of unit rows in the inverse-inertia metric projected into what higher levels left, up to "
           "which a direction is not held.",
       .lower = 0, .upper = 1, .lower_open = true},
      {.name = "fade", .type = ValueType::real, .unit = "1",
       .default_text = control::formatNumber(HqpOptions().rank.fade),
       .description =
           "Singular value from which a direction is held exactly; a smoothstep leads there from rank-tolerance.",
       .lower = 0, .upper = 1, .lower_open = true},
  };
  for (control::AttributeRow& attribute : control::objectiveAttributes()) row.attributes.push_back(std::move(attribute));
  registry.addBackEnd(std::move(row), make);
}

}  // namespace
}  // namespace tactus::hqp

TACTUS_PLUGIN("hqp", TACTUS_VERSION, "unspecified", tactus::hqp::registerElements)
