#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "framework/control/tick.h"

namespace tactus::app {

/// What a metric of an exploration should reach.
struct Target {
  std::string metric;
  std::optional<double> lower;
  std::optional<double> upper;

  bool metBy(double value) const;
  std::string text() const;                                        ///< "≤ 0.8", "0.45 – 0.55"
};

/// The bounds as run.json holds them, {lower?, upper?}, and back.
nlohmann::ordered_json toJson(const Target& target);
Target targetFromJson(const std::string& metric, const nlohmann::ordered_json& json);

/// The targets of tactile exploration for those of `metrics` that have one, in their order: contact forces scale
/// with the wanted force f (N) – mean within 10 % of f, largest of a tick on average ≤ 1.6 f, peaks ≤ 4 f –; two
/// thirds of the desired links touch; all keys but one are passed; features are found to 5 mm in position and
/// 2 mm in height.
std::vector<Target> explorationTargets(const std::vector<control::Metric>& metrics, double wanted_force,
                                       int desired_links);

}  // namespace tactus::app
