#include "apps/tactus/sample.h"

#include <algorithm>
#include <cmath>

namespace tactus::app {

double quantile(const std::vector<double>& sorted, double fraction) {
  if (sorted.empty()) return NAN;
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(at);
  if (below + 1 >= sorted.size()) return sorted.back();
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[below + 1] - sorted[below]);
}

SampleFigures figuresOf(std::vector<double> values) {
  SampleFigures figures;
  figures.n = static_cast<long>(values.size());
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  figures.mean = figures.sd = NAN;
  if (figures.n > 0) {
    double sum = 0, squares = 0;
    for (const double value : values) sum += value;
    // Of equal values the mean is that value, whatever the sum rounds to.
    figures.mean = values.front() == values.back() ? values.front() : sum / n;
    for (const double value : values) squares += (value - figures.mean) * (value - figures.mean);
    if (figures.n > 1) figures.sd = std::sqrt(squares / (n - 1));
  }
  figures.minimum = quantile(values, 0);
  figures.lower_quartile = quantile(values, 0.25);
  figures.median = quantile(values, 0.5);
  figures.upper_quartile = quantile(values, 0.75);
  figures.maximum = quantile(values, 1);
  return figures;
}

}  // namespace tactus::app
