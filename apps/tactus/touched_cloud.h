#pragma once

#include <vector>

#include "framework/runtime/csv_table.h"

namespace tactus::app {

/// Touched points with their height (mm) above the lowest plane: the second percentile of z, so that a few points
/// that press deeper do not move it.
struct TouchedCloud {
  std::vector<double> x, y, z;                                     ///< m
  std::vector<double> height_mm;
  double plane = 0;                                                ///< m
  double height_max = 1;                                           ///< mm, of the colour scale
};

/// Of touched_points.csv.
TouchedCloud touchedCloud(const runtime::CsvTable& touched);

}  // namespace tactus::app
