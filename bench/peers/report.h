#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "bench/peers/measure.h"

namespace tactus::bench {

/// "rnea", "mass matrix", …
std::string operationName(Operation operation);

/// Results that differ by more than this, relative to the largest number, are not the same.
inline constexpr double agreement = 1e-6;

/// One line of the table.
struct Figure {
  std::string model, engine;
  Operation operation = Operation::rnea;
  Timing timing;
  double difference = 0;                                           ///< from this engine's numbers, relative
  std::optional<double> ratio;                                     ///< to MuJoCo's median
  std::optional<double> target;                                    ///< the ratio that this engine is to keep below
};

/// The ratio to MuJoCo that this engine is to keep below, where one is set.
std::optional<double> targetRatio(const std::string& model, Operation operation);

/// Why the figure counts for nothing, when the engine did not compute what this one did; empty otherwise.
std::string disagreement(const Figure& figure);

std::string table(const std::vector<Figure>& figures);
/// How RNEA and forward dynamics of this engine grow with the length of a chain; empty without chains.
std::string growth(const std::vector<Figure>& figures);
nlohmann::ordered_json toJson(const std::vector<Figure>& figures);

}  // namespace tactus::bench
