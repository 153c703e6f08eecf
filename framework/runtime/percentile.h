#pragma once

#include <vector>

namespace tactus::runtime {

/// The smallest value that at least `fraction` (in [0, 1]) of all values do not exceed (nearest rank); NaN for none.
double percentile(std::vector<double> values, double fraction);

}  // namespace tactus::runtime
