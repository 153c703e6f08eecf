#include "framework/runtime/plugin_api.h"
#include "plugins/qp/qp_back_end.h"

namespace tactus::qp {
namespace {

using control::AttributeRow;
using control::ElementValues;
using control::ValueType;

AttributeRow choice(std::string name, std::string fallback, std::vector<std::string> choices, std::string text) {
  AttributeRow row;
  row.name = std::move(name);
  row.type = ValueType::choice;
  row.default_text = std::move(fallback);
  row.choices = std::move(choices);
  row.description = std::move(text);
  return row;
}

AttributeRow positive(std::string name, std::string fallback, std::string text) {
  AttributeRow row;
  row.name = std::move(name);
  row.type = ValueType::real;
  row.unit = std::string("1");
  row.default_text = std::move(fallback);
  row.lower = 0;
  row.lower_open = true;
  row.description = std::move(text);
  return row;
}

std::unique_ptr<control::BackEnd> make(const ElementValues& values) {
  WeightedQpOptions options;
  options.objective = values.text("objective") == "torque" ? Objective::torque : Objective::acceleration;
  options.metric = values.text("metric") == "inertia" ? Metric::inertia : Metric::identity;
  options.weight_ratio = values.real("weight-ratio");
  options.force_weight = values.real("force-weight");
  options.regularisation = values.real("regularisation");
  return std::make_unique<QpBackEnd>(options,
                                     values.text("solver") == "nlopt" ? makeNloptSolver() : makeIpoptSolver());
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
      choice("objective", "acceleration", {"torque", "acceleration"},
             "acceleration: weighted distance from the accelerations that the levels ask for, which ranks them. "
             "torque: the thesis's distance from the summed torque, which cannot rank tasks."),
      choice("metric", "identity", {"identity", "inertia"},
             "Metric of the torque objective: identity as in the thesis, or the inverse inertia."),
      choice("solver", "ipopt", {"ipopt", "nlopt"},
             "ipopt: primal-dual interior point. nlopt: sequential least squares (SLSQP)."),
      positive("weight-ratio", "100",
               "Weight of a level over that of the next; the first has 1. A level's own weight replaces it."),
      positive("force-weight", "1", "w_f, weight of the contact forces' distance from their references."),
      positive("regularisation", "0.01",
               "w_r over the least level weight: price of torque, in the inverse-inertia metric, that no task asks "
               "for. Acceleration objective only."),
  };
  registry.addBackEnd(std::move(row), make);
}

}  // namespace
}  // namespace tactus::qp

TACTUS_PLUGIN("qp", TACTUS_VERSION, "BSD-3-Clause", tactus::qp::registerElements)
