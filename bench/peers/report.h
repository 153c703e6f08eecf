#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/peers/measure.h"

namespace tactus::bench {

/// "rnea", "mass matrix", …
std::string operationName(Operation operation);

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

void printTable(const std::vector<Figure>& figures);
void printJson(const std::vector<Figure>& figures);
/// How RNEA and forward dynamics of this engine grow with the length of a chain.
void printGrowth(const std::vector<Figure>& figures);

}  // namespace tactus::bench
