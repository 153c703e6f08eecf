#pragma once

#include <vector>

namespace tactus::app {

/// Figures of a sample; what is not defined for so few values is NaN.
struct SampleFigures {
  long n = 0;
  double mean = 0;
  double sd = 0;                                                   ///< n − 1 in the denominator; from 2 values on
  double minimum = 0, lower_quartile = 0, median = 0, upper_quartile = 0, maximum = 0;
};

/// Of finite values, in any order: the order changes no bit of the answer.
SampleFigures figuresOf(std::vector<double> values);

/// The value below which a fraction of `sorted` lies, interpolated between neighbours: at (n − 1)·fraction, counted
/// from 0 (R's type 7: Hyndman & Fan, "Sample quantiles in statistical packages", Am. Stat. 50, 1996).  NaN for none.
double quantile(const std::vector<double>& sorted, double fraction);

}  // namespace tactus::app
