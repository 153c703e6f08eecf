#pragma once

#include <memory>
#include <vector>

#include "bench/peers/engine.h"

namespace tactus::bench {

struct Effort {
  int samples = 3000;
  int calls = 20;                                                  ///< in a sample, each of the next state
  double budget_s = 1;                                             ///< for one engine and operation; a slow engine gets
                                                                   ///< fewer samples, then fewer calls in a sample
};

/// Of one engine and one operation, microseconds a call.
struct Timing {
  double median_us = 0, p99_us = 0;
  int samples = 0, calls = 0;
};

/// Largest |a − b| over largest |a| of each result, the worst of all states; infinite for results of other sizes
/// and for numbers that are not finite.
double relativeDifference(Engine& reference, Engine& engine, Operation operation);

/// Times the engines side by side: in turn, blocks of samples each, until all are taken.  So load on the machine that
/// lasts longer than a block hits all alike, and within a block each engine has the caches for itself.
std::vector<Timing> measure(const std::vector<Engine*>& engines, Operation operation, const Effort& effort);

}  // namespace tactus::bench
