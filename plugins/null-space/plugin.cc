#include "framework/runtime/plugin_api.h"
#include "plugins/null-space/null_space.h"

namespace tactus::null_space {
namespace {

using control::ElementValues;
using control::ValueType;

std::unique_ptr<control::BackEnd> make(const ElementValues& values) {
  NullSpaceOptions options;
  const std::string& projection = values.text("projection");
  options.cascade = projection == "successive"   ? Cascade::successive
                    : projection == "consistent" ? Cascade::consistent
                                                 : Cascade::augmented;
  options.inequalities = values.text("inequalities") == "one-pass" ? Inequalities::one_pass : Inequalities::exact;
  if (options.cascade == Cascade::consistent) options.rank = control::dividing_rank;
  if (values.has("rank-tolerance")) options.rank.rank_tolerance = values.real("rank-tolerance");
  if (values.has("fade")) options.rank.fade = values.real("fade");
  options.objective = control::objectiveOptions(values);
  if (options.rank.fade < options.rank.rank_tolerance)
    throw control::ElementError("fade", "fade must not be below rank-tolerance");
  return std::make_unique<NullSpace>(options);
}

std::string withoutIt(double control::RankOptions::*number) {
  return "Without it " + control::formatNumber(NullSpaceOptions().rank.*number) + "; " +
         control::formatNumber(control::dividing_rank.*number) + " where the projection is consistent";
}

void registerElements(control::Registry& registry) {
  control::ElementRow row;
  row.name = "null-space";
  row.kind = control::ElementKind::back_end;
  row.description =
      "A cascade of task torques, each projected so that it does not disturb the levels above. Torque limits are met "
      "by scaling the whole torque.";
  row.source = "4.2.5-4.2.12, Algorithms 3 and 4";
  row.attributes = {
      {.name = "projection", .type = ValueType::choice, .default_text = "augmented",
       .description =
           "augmented: each level's torque is projected alone onto the rows of all levels above, strict for all levels. "
           "successive: Algorithm 4, from the lowest level up, strict for level 1 only. consistent: strict for all levels, "
           "and each level gets the acceleration that it asks for as far as the levels above leave it.",
       .choices = {"successive", "augmented", "consistent"}},
      {.name = "inequalities", .type = ValueType::choice, .default_text = "exact",
       .description =
           "exact: the nearest torque in the inverse-inertia metric that keeps every row. one-pass: Algorithm 3, which "
           "can leave rows violated that the unprojected torque kept.",
       .choices = {"one-pass", "exact"}},
      {.name = "rank-tolerance", .type = ValueType::real, .unit = "1",
       .description =
           "Singular value, of unit rows in the inverse-inertia metric projected into what higher levels left, up to "
           "which a direction is not held. " + withoutIt(&control::RankOptions::rank_tolerance) + ".",
       .lower = 0, .upper = 1, .lower_open = true},
      {.name = "fade", .type = ValueType::real, .unit = "1",
       .description =
           "Singular value from which a direction is held exactly; a smoothstep leads there from rank-tolerance. " +
           withoutIt(&control::RankOptions::fade) + ", which divides by singular values.",
       .lower = 0, .upper = 1, .lower_open = true},
  };
  for (control::AttributeRow& attribute : control::objectiveAttributes()) {
    attribute.description = "Where the projection is consistent. " + attribute.description;
    row.attributes.push_back(std::move(attribute));
  }
  registry.addBackEnd(std::move(row), make);
}

}  // namespace
}  // namespace tactus::null_space

TACTUS_PLUGIN("null-space", TACTUS_VERSION, "unspecified", tactus::null_space::registerElements)
