#pragma once

#include <optional>
#include <string>

#include "apps/tactus/json_place.h"

namespace tactus::app {

/// What a figure of a run should reach, as a <target> of the stack asks for it.
struct Target {
  std::optional<double> lower;
  std::optional<double> upper;

  bool metBy(double value) const;
  std::string text() const;                                        ///< "≤ 0.8", "0.45 – 0.55"
};

/// The bounds as run.json holds them, {lower?, upper?}, and back.
nlohmann::ordered_json toJson(const Target& target);
Target targetFromJson(const JsonPlace& place);

}  // namespace tactus::app
