#include "apps/tactus/targets.h"

#include <cmath>

#include "apps/tactus/text.h"

namespace tactus::app {

bool Target::metBy(double value) const {
  return !std::isnan(value) && (!lower || value >= *lower) && (!upper || value <= *upper);
}

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

Target targetFromJson(const JsonPlace& place) { return {place.at("lower").number(), place.at("upper").number()}; }

}  // namespace tactus::app
