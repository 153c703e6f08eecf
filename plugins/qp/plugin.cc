#include "framework/runtime/plugin_api.h"
#include "plugins/qp/solvers.h"

namespace tactus::qp {
namespace {

using control::ElementValues;
using control::ValueType;

std::unique_ptr<control::BackEnd> make(const ElementValues& values) {
  WeightedQpOptions options;
  options.objective = values.text("objective") == "torque" ? Objective::torque : Objective::acceleration;
  options.metric = values.text("metric") == "inertia" ? Metric::inertia : Metric::identity;
  options.weight_ratio = values.real("weight-ratio");
  options.force_weight = values.real("force-weight");
  options.regularisation = values.real("regularisation");
  options.friction_edges = values.integer("friction-edges");
  const std::string& solver = values.text("solver");
  return std::make_unique<QpBackEnd>(
      options, solver == "active-set" ? makeActiveSetSolver()
                                      : makeReferenceSolver(solver == "nlopt" ? makeNloptSolver() : makeIpoptSolver()));
}

void registerElements(control::Registry& registry) {
  control::ElementRow row;
  row.name = "qp";
  row.kind = control::ElementKind::back_end;
  row.description =
      "One weighted quadratic programme a tick over task torques and contact forces. Levels become weights, so they "
      "are kept softly; torque limits, force bounds and friction are kept strictly.";
  row.source = "5.3.5-5.3.10";
  row.attributes = {
      {.name = "objective", .type = ValueType::choice, .default_text = "acceleration",
       .description =
           "acceleration: weighted distance from the accelerations that the levels ask for, which ranks them. torque: the "
           "thesis's distance from the summed torque, which cannot rank tasks.",
       .choices = {"torque", "acceleration"}},
      {.name = "metric", .type = ValueType::choice, .default_text = "identity",
       .description =
           "What distances are measured by. Torque objective: identity as in the thesis, or the inverse inertia. "
           "Acceleration objective: identity takes accelerations as they come, m/s² beside rad/s²; inertia takes each "
           "row times the root of the inertia that it meets, so that an arm's and a finger's errors weigh alike.",
       .choices = {"identity", "inertia"}},
      {.name = "solver", .type = ValueType::choice, .default_text = "ipopt",
       .description =
           "ipopt: primal-dual interior point. nlopt: sequential least squares (SLSQP). active-set: Tactus's own, for "
           "real time: a dual active set that starts from the rows at their bounds in the last tick.",
       .choices = {"ipopt", "nlopt", "active-set"}},
      {.name = "weight-ratio", .type = ValueType::real, .unit = "1",
       .default_text = control::formatNumber(WeightedQpOptions().weight_ratio),
       .description = "Weight of a level over that of the next; the first has 1. A level's own weight replaces it.",
       .lower = 0, .lower_open = true},
      {.name = "force-weight", .type = ValueType::real, .unit = "1",
       .default_text = control::formatNumber(WeightedQpOptions().force_weight),
       .description = "w_f, weight of the contact forces' distance from their references.", .lower = 0,
       .lower_open = true},
      {.name = "regularisation", .type = ValueType::real, .unit = "1",
       .default_text = control::formatNumber(WeightedQpOptions().regularisation),
       .description =
           "w_r over the least level weight: price of torque, in the inverse-inertia metric, that no task asks for. "
           "Acceleration objective only.",
       .lower = 0, .lower_open = true},
      {.name = "friction-edges", .type = ValueType::integer, .unit = "1",
       .default_text = std::to_string(WeightedQpOptions().friction_edges),
       .description = "Edges of the pyramid inside each friction cone.", .lower = 3, .upper = 64},
  };
  registry.addBackEnd(std::move(row), make);
}

}  // namespace
}  // namespace tactus::qp

TACTUS_PLUGIN("qp", TACTUS_VERSION, "unspecified", tactus::qp::registerElements)
