#include "apps/tactus/targets.h"

#include "apps/tactus/text.h"

namespace tactus::app {
namespace {

double valueOf(const std::vector<control::Metric>& metrics, const std::string& name, double otherwise) {
  for (const control::Metric& metric : metrics) {
    if (metric.name == name) return metric.value;
  }
  return otherwise;
}

}  // namespace

bool Target::metBy(double value) const { return (!lower || value >= *lower) && (!upper || value <= *upper); }

std::string Target::text() const {
  if (lower && upper) return rounded(*lower) + " – " + rounded(*upper);
  if (lower) return "≥ " + rounded(*lower);
  return upper ? "≤ " + rounded(*upper) : "";
}

nlohmann::ordered_json toJson(const Target& target) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  if (target.lower) json["lower"] = *target.lower;
  if (target.upper) json["upper"] = *target.upper;
  return json;
}

Target targetFromJson(const std::string& metric, const nlohmann::ordered_json& json) {
  Target target{metric, {}, {}};
  if (json.contains("lower")) target.lower = json["lower"].get<double>();
  if (json.contains("upper")) target.upper = json["upper"].get<double>();
  return target;
}

std::vector<Target> explorationTargets(const std::vector<control::Metric>& metrics, double f, int desired_links) {
  const std::vector<Target> known{
      {"contact_force_mean_N", 0.9 * f, 1.1 * f},
      {"contact_force_max_mean_N", {}, 1.6 * f},
      {"contact_force_peak_N", {}, 4 * f},
      {"undesired_force_peak_N", {}, 4 * f},
      {"links_in_contact_mean", 2.0 / 3 * desired_links, {}},
      {"contact_switches_per_s", {}, 3.0},
      {"keys_passed", valueOf(metrics, "keys_total", 1) - 1, {}},
  };
  std::vector<Target> targets;
  for (const control::Metric& metric : metrics) {
    for (const Target& target : known) {
      if (target.metric == metric.name) targets.push_back(target);
    }
    if (metric.name.ends_with("_position_error_m")) targets.push_back({metric.name, {}, 0.005});
    if (metric.name.ends_with("_height_error_m")) targets.push_back({metric.name, {}, 0.002});
  }
  return targets;
}

}  // namespace tactus::app
